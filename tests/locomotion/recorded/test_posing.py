"""Posing many figures: as MuJoCo does it, at every level."""

import mujoco
import numpy as np
import pytest

from locomotion.body.models import figure
from locomotion.body.person import BODY_NAMES
from locomotion.recorded.posing import posed, posed_slowly, whole_figures
from locomotion.recorded.skeletons import LEVELS, Skeleton, skeleton


def random_poses(level: Skeleton, count: int, seed: int):
    rng = np.random.default_rng(seed)
    channels = rng.uniform(-np.pi, np.pi, (count, len(level.channels)))
    roots = rng.normal(size=(count, 7))
    roots[:, 3:] /= np.linalg.norm(roots[:, 3:], axis=1, keepdims=True)
    return channels, roots


def apart(a, b):
    """Largest difference of two sets of places; a quaternion and its negative are the same."""
    turned = 1.0 - np.abs((a[..., 3:] * b[..., 3:]).sum(axis=-1))
    return max(np.abs(a[..., :3] - b[..., :3]).max(), turned.max())


@pytest.mark.parametrize("level", LEVELS)
def test_the_kernel_does_what_the_slow_version_does(level):
    own = skeleton(level)
    channels, roots = random_poses(own, 30, seed=3)
    assert apart(posed(own, channels, roots), posed_slowly(own, channels, roots)) < 1e-10


@pytest.mark.parametrize("level", LEVELS)
def test_a_pose_of_any_level_is_a_pose_of_the_person(level):
    own, model = skeleton(level), figure()
    channels, roots = random_poses(own, 10, seed=4)
    places, data = whole_figures(own, posed(own, channels, roots)), mujoco.MjData(model)
    ids = [model.body(name).id for name in BODY_NAMES]
    for qpos, found in zip(own.as_qpos(channels, roots), places, strict=True):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        assert apart(found, np.hstack([data.xpos[ids], data.xquat[ids]])) < 1e-10
