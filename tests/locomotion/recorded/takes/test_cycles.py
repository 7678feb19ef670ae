"""Cycles averaged over strides."""

import numpy as np
import pytest

from locomotion.body.person import JOINT_NAMES
from locomotion.errors import LocomotionError
from locomotion.recorded.takes.cycles import averaged
from locomotion.recorded.takes.take import mirrored

PERIOD = 80  # ticks


def steady(count=800, noise=0.0):
    """A gait of 1.6 m/s that swings its hips, and a limp in the right one."""
    time = np.arange(count) / PERIOD
    qpos = np.zeros((count, 46))
    qpos[:, 0], qpos[:, 2], qpos[:, 3] = 1.28 * time, 0.9, 1.0
    swing = 0.4 * np.cos(2 * np.pi * time)
    qpos[:, 7 + JOINT_NAMES.index("right_hip_flexion")] = swing + 0.1
    qpos[:, 7 + JOINT_NAMES.index("left_hip_flexion")] = -swing
    qpos[:, 7:] += noise * np.random.default_rng(2).normal(size=(count, 39))
    bears = 600.0 * np.array([(time % 1.0) < 0.6, ((time + 0.5) % 1.0) < 0.6]).T
    return qpos, bears, time


def test_a_cycle_is_symmetric_and_of_the_speed_at_which_it_was_gone():
    take = averaged("walk", *steady(noise=0.01), "test")
    assert take.clip.speed == pytest.approx(1.6, abs=0.01)
    assert take.clip.seconds == pytest.approx(0.8, abs=0.01)
    assert len(take.qpos) == 48
    assert np.allclose(take.qpos, np.roll(mirrored(take.qpos), 24, axis=0), atol=1e-6)
    hip = take.qpos[:, 7 + JOINT_NAMES.index("right_hip_flexion")]
    assert hip.max() == pytest.approx(0.45, abs=0.02)
    assert np.ptp(take.qpos[:, 0]) < 0.01


def test_stance_is_told_from_the_forces():
    take = averaged("walk", *steady(), "test")
    assert take.stance[:, 0].mean() == pytest.approx(0.6, abs=0.05)
    assert take.clip.bears == pytest.approx(0.6, abs=0.025)  # forces are known each 1/80
    assert take.stance[0, 0] and not take.stance[35, 0]
    assert (take.stance[:, 1] == np.roll(take.stance[:, 0], 24)).mean() > 0.9


def test_too_few_strides_are_refused():
    with pytest.raises(LocomotionError, match="2 strides, expected at least 3"):
        averaged("walk", *steady(200), "test")
