"""Frames of the full figure on their way into a set."""

import numpy as np

from locomotion.body.person import JOINT_NAMES
from locomotion.recorded.takes.take import mirrored, spread


def frames(count, seed=0):
    rng = np.random.default_rng(seed)
    qpos = rng.normal(0.0, 0.3, (count, 46))
    qpos[:, 3] = 1.0
    qpos[:, 3:7] /= np.linalg.norm(qpos[:, 3:7], axis=1, keepdims=True)
    return qpos


def test_the_mirror_image_of_the_mirror_image_is_the_pose():
    qpos = frames(5)
    assert np.allclose(mirrored(mirrored(qpos)), qpos)
    knees = [7 + JOINT_NAMES.index(f"{side}_knee_flexion") for side in ("right", "left")]
    assert np.allclose(mirrored(qpos)[:, knees], qpos[:, knees[::-1]])


def test_spread_frames_go_through_those_that_were_given():
    qpos = frames(5)
    once = spread(qpos, np.linspace(0.0, 1.0, 9), cyclic=False)
    assert np.allclose(once[::2], qpos)
    round_ = spread(qpos, np.arange(10) / 10, cyclic=True)
    assert np.allclose(round_[::2], qpos)
    assert np.allclose(round_[9, 7:], 0.5 * (qpos[4, 7:] + qpos[0, 7:]))
