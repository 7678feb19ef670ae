"""Captures of the same motion in files that differ in what says nothing about it: the pose in which the
skeleton rests, units, axes, frame rates and names."""

from functools import partial

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from locomotion.clips.bvh import read_bvh
from locomotion.errors import LocomotionError
from tests.locomotion.clips.moving import (
    JOINTS,
    RESTS,
    TIMES,
    assert_same,
    bvh_text,
    motion,
    resting,
    retargeted,
)
from tests.locomotion.clips.tpose import posed


@pytest.fixture
def clip(tmp_path):
    return partial(retargeted, tmp_path)


@pytest.mark.parametrize("seed", [11, 12, 13])
@pytest.mark.parametrize("kind", RESTS)
def test_what_the_skeleton_rests_in_does_not_matter(clip, kind, seed):
    turns, way = motion(TIMES, seed)
    assert_same(clip(turns, way, resting(kind, seed)), clip(turns, way, resting("T")))


@pytest.mark.parametrize("kind", RESTS[:4])
def test_a_rest_pose_that_stands_along_any_axis_needs_no_frame_that_does(clip, kind):
    turns, way = motion(TIMES, 5, begins_upright=False)
    assert_same(clip(turns, way, resting(kind)), clip(turns, way, resting("T")))


@pytest.mark.parametrize("kind", ["T", *RESTS])
def test_one_that_lies_first_and_then_gets_up(clip, kind):
    turns, way = motion(TIMES, 3)
    risen = np.clip(1.2 - TIMES[::-1], 0.0, 1.0)  # 0 at the beginning, upright from the middle on
    lies = Rotation.from_rotvec(np.outer(0.5 * np.pi * (risen - 1.0), [0.0, 1.0, 0.0])).as_matrix()
    turns = lies[:, None] @ turns[::-1]
    way = way.copy()
    way[:, 2] = 0.15 + 0.8 * risen
    found = clip(turns, way, resting(kind, 4))
    assert_same(found, clip(turns, way, resting("T")))
    pelvis = Rotation.from_quat(found.qpos[:, 3:7], scalar_first=True).as_matrix()
    assert abs(pelvis[0, 2, 2]) < 0.7 < 0.9 < pelvis[-1, 2, 2]


@pytest.mark.parametrize("up", ["y", "z"])
@pytest.mark.parametrize("units", ["m", "cm", "mm", "in", "ft"])
def test_units_axes_and_names_do_not_matter(clip, units, up):
    turns, way = motion(TIMES, 6)
    wanted = clip(turns, way, resting("T"))
    for kind in ("lying", "any"):
        assert_same(clip(turns, way, resting(kind), units=units, up=up, prefix="rig:"), wanted)


@pytest.mark.parametrize("rate", [24.0, 30.0, 120.0, 240.0])
def test_the_frame_rate_does_not_matter(clip, rate):
    times = np.arange(round(1.5 * rate)) / rate
    one, other = (clip(*motion(t, 7), resting("any"), rate=r) for t, r in ((times, rate), (TIMES, 60.0)))
    assert one.rate == pytest.approx(rate, rel=1e-5)
    both = np.arange(9) / 6.0
    one, other = (m.qpos[np.round(both * m.rate).astype(int)] for m in (one, other))
    one[:, 2] -= one[0, 2] - other[0, 2]  # where the ground is, is chosen among the frames
    assert np.abs(one - other).max() < 1e-4


def test_the_motion_is_the_one_that_was_captured(clip):
    """Pelvis, thighs and shanks turn in the world as in the motion."""
    turns, way = motion(TIMES, 8)
    found = clip(turns, way, resting("any", 2))
    for frame in (0, 30, 60, 89):
        world, _ = posed(found.qpos[frame])
        for part in ("pelvis", "right_thigh", "left_thigh", "right_shank", "left_shank"):
            assert np.allclose(world[part], turns[frame, JOINTS.index(part)], atol=1e-4), (part, frame)
    assert found.qpos[:, :2] == pytest.approx((way - way[0])[:, :2] * found.qpos[0, 2] / way[0, 2], abs=0.02)


def test_who_stands_along_another_axis_or_is_too_large_is_refused_with_what_helps(clip, tmp_path):
    turns, way = motion(TIMES, 5)
    turned = Rotation.from_euler("x", 90, degrees=True).as_matrix()
    with pytest.raises(LocomotionError, match="another axis than the one that is said to point up"):
        clip(turned @ turns, way @ turned.T, turned.T @ resting("T"))
    path = tmp_path / "long.bvh"
    path.write_text(bvh_text(turns, way, resting("lying")))
    for units in ("m", "mm"):
        with pytest.raises(
            LocomotionError, match=r"would be (1\d\d|0\.1\d*) m tall by the lengths of its bones"
        ):
            read_bvh(path, units)
