"""Axes of a capture that stands upright in no frame, measured on its limbs."""

from functools import partial

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from locomotion.clips.measured_axes import measured_axes
from tests.locomotion.clips.moving import JOINTS, PARENTS, PLACES, assert_same, motion, resting, retargeted
from tests.locomotion.clips.tpose import posed


@pytest.fixture
def clip(tmp_path):
    return partial(retargeted, tmp_path)


@pytest.mark.parametrize("seed", [21, 22, 23])
def test_one_that_stands_in_no_frame_is_measured_on_its_limbs(clip, seed):
    """Always the same, whatever axes its joints have; legs as they were, the rest to some degrees."""
    times = np.arange(150) / 30.0
    turns, way = motion(times, seed, begins_upright=False)
    turns = Rotation.from_euler("y", 70, degrees=True).as_matrix() @ turns  # on all fours
    found = clip(turns, way, resting("any", seed))
    for kind in ("bones along one axis", "any"):
        assert_same(clip(turns, way, resting(kind, seed + 1)), found)
    standing = clip(turns, way, resting("T"))
    for frame in range(0, 150, 25):
        (world, _), (rested, _) = (posed(each.qpos[frame]) for each in (found, standing))
        for part in ("pelvis", "right_thigh", "left_thigh", "right_shank", "left_shank"):
            assert np.allclose(world[part], turns[frame, JOINTS.index(part)], atol=1e-3), (part, frame)
        for part in ("chest", "head", "right_foot", "left_foot"):
            off = Rotation.from_matrix(world[part].T @ rested[part]).magnitude()
            assert np.degrees(off) < 20.0, (part, frame, np.degrees(off))


def test_a_skeleton_of_few_joints_has_axes_for_each_part():
    """Parts that no joint shows the axes of align with the part before."""
    parts = [name for name in JOINTS if not name.endswith(("clavicle", "hand", "toes", "waist"))]
    turns, way = motion(np.arange(120) / 60.0, 31, begins_upright=False)
    places = np.empty((*turns.shape[:2], 3))
    places[:, 0] = way
    for j, parent in enumerate(PARENTS[1:], start=1):
        places[:, j] = places[:, parent] + turns[:, parent] @ (PLACES[j] - PLACES[parent])
    axes = measured_axes(places, turns, {part: JOINTS.index(part) for part in parts})
    assert set(axes) == set(parts)
    for part, found in axes.items():
        assert np.allclose(found @ found.T, np.eye(3), atol=1e-9) and np.linalg.det(found) > 0.0, part
    for side in ("right", "left"):
        assert np.allclose(axes[f"{side}_thigh"], np.eye(3), atol=1e-9)
        assert np.allclose(axes[f"{side}_shank"], np.eye(3), atol=1e-9)
        # a foot without toes goes with the shank on average
        foot, shank = (JOINTS.index(f"{side}_{name}") for name in ("foot", "shank"))
        off = Rotation.from_matrix(np.swapaxes(turns[:, foot] @ axes[f"{side}_foot"], 1, 2) @ turns[:, shank])
        assert np.degrees(off.mean().magnitude()) < 1.0
