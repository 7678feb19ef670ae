"""What is added to the targets of a walk, and nothing in stands and runs."""

import math

import numpy as np
import pytest

from locomotion.body.person import JOINT_NAMES
from locomotion.gaits.policy.corrections import KEEPS_OFF, correct_one, corrections, kept_off
from locomotion.gaits.policy.layout import ANKLES, ARMS_ASIDE, FAST, JOINTS, RUNNING, SPREADING, STATE_SIZE


def walking(count: int = 1) -> np.ndarray:
    memory = np.zeros((count, STATE_SIZE))
    memory[:, RUNNING] = 1.0
    return memory


def added(speed: float, phase: float) -> np.ndarray:
    return corrections(walking(), np.array([speed]), np.array([phase]))[0]


def test_the_kernel_adds_the_same():
    rng = np.random.default_rng(5)
    memory, speed, phase = walking(40), rng.uniform(-0.3, 2.6, 40), rng.uniform(0.0, 1.4, 40)
    memory[::4, RUNNING], memory[1::4, FAST] = 0.0, 1.0
    both = corrections(memory, speed, phase)
    both[:, ARMS_ASIDE] += kept_off(memory)
    for k in range(40):
        ctrl = np.zeros(len(JOINT_NAMES))
        correct_one(memory[k], speed[k], phase[k], ctrl)
        np.testing.assert_allclose(ctrl[[JOINT_NAMES.index(name) for name in JOINTS]], both[k], atol=1e-12)
        assert both[k].any() == (k % 4 > 1)


def test_arms_are_held_aside_in_a_walk_alone():
    memory = walking(3)
    memory[1, RUNNING], memory[2, FAST] = 0.0, 1.0
    assert kept_off(memory)[:, 0].tolist() == [KEEPS_OFF, 0.0, 0.0]


@pytest.mark.parametrize(("speed", "degrees"), [(0.8, 0.0), (1.25, 0.0), (2.25, math.degrees(0.05))])
def test_legs_are_spread_in_fast_walks(speed, degrees):
    assert np.degrees(added(speed, 0.3)[SPREADING]) == pytest.approx(degrees)


@pytest.mark.parametrize("speed", [0.0, 0.5, 0.85, 1.2])
def test_toes_are_raised_before_the_heel_strikes_in_slow_steps(speed):
    share = {0.0: 0.0, 0.5: 1.0, 0.85: 0.5, 1.2: 0.0}[speed]
    right, left = added(speed, 0.95)[ANKLES]
    assert right == pytest.approx(0.12 * share) and left == 0.0
    right, left = added(speed, 1.34)[ANKLES]  # the left foot is halfway to where its toes are up
    assert right == 0.0 and left == pytest.approx(0.06 * share)
    assert not added(speed, 0.02)[ANKLES].any(), "a foot that has struck is as decided"
