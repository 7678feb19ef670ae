"""What the laws of skills have in common, against plain NumPy."""

import math

import numpy as np
import pytest

from locomotion.body.person import CONTROL_DT, JOINT_NAMES
from locomotion.gaits.run import layout
from locomotion.skills import kernel
from locomotion.skills.kernel_reference import clip_offset, placed_actions

N = len(JOINT_NAMES)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_actions_go_to_the_joints_that_they_are_called_after(side):
    rng = np.random.default_rng(3)
    action, side_action = rng.normal(size=6), rng.normal(size=6)
    wanted = np.zeros(N)
    kernel.add_actions(side, action, side_action, wanted)
    assert wanted == pytest.approx(placed_actions(side > 0.0, action, side_action))
    kernel.add_actions(side, action, side_action, wanted)
    assert wanted == pytest.approx(2.0 * placed_actions(side > 0.0, action, side_action))


@pytest.mark.parametrize("step", [1, 2])
@pytest.mark.parametrize("left", [False, True])
def test_a_clip_is_followed_ahead_of_the_servos(step, left):
    rng = np.random.default_rng(5)
    difference, rate = rng.normal(size=(2, 65, N))
    for phase, pace in ((0.0, 3.2), (0.37, 3.2), (1.0, 3.2)):
        wanted = np.zeros(N)
        flip = left == (step == 1)
        cycle_rate = 0.5 * pace if phase < 1.0 else 0.0
        share = 0.5 * (phase + step - 1)
        kernel.add_clip(
            share, 1.0, cycle_rate, difference, rate, flip, kernel.MIRROR, kernel.MIRROR_SIGN, wanted
        )
        assert wanted == pytest.approx(clip_offset(difference, rate, step, phase, pace, left))


def test_the_mirror_image_of_the_mirror_image_is_the_pose():
    poses = np.random.default_rng(1).normal(size=(4, N))
    seen = kernel.mirror(poses)
    assert np.array_equal(kernel.mirror(seen), poses)
    for name, sign in (("knee_flexion", 1.0), ("hip_abduction", 1.0)):
        right, left = (JOINT_NAMES.index(f"{side}_{name}") for side in ("right", "left"))
        assert np.array_equal(seen[:, right], sign * poses[:, left])
    for name, sign in (("chest_pitch", 1.0), ("chest_yaw", -1.0), ("neck_roll", -1.0)):
        assert np.array_equal(seen[:, JOINT_NAMES.index(name)], sign * poses[:, JOINT_NAMES.index(name)])


def test_errors_are_measured_along_the_approach_and_limited():
    state, memory = np.zeros(layout.STATE_SIZE), np.zeros(kernel.SHARED_MEMORY)
    angle = 0.6
    ahead = np.array([math.cos(angle), math.sin(angle)])
    memory[[kernel.EDGE_X, kernel.EDGE_Y]] = 3.0, -1.0
    memory[[kernel.AHEAD_X, kernel.AHEAD_Y]], memory[kernel.ENTRY] = ahead, 3.0
    state[layout.STANCE] = 1.0
    foot = np.array([3.0, -1.0]) - 1.7 * ahead + 0.2 * np.array([-ahead[1], ahead[0]])
    state[layout.LEFT_PLANTED : layout.LEFT_PLANTED + 2] = foot
    state[[layout.VELOCITY_X, layout.VELOCITY_Y]] = 3.3 * ahead
    kernel.measure_errors(1.5, memory, state)
    assert memory[kernel.ERROR_DISTANCE] == pytest.approx(0.2)
    assert memory[kernel.ERROR_SPEED] == pytest.approx(0.3)
    kernel.measure_errors(0.1, memory, state)
    assert memory[kernel.ERROR_DISTANCE] == 0.5
    state[layout.STANCE] = -1.0  # the other foot stands at the origin
    kernel.measure_errors(1.5, memory, state)
    assert memory[kernel.ERROR_DISTANCE] == pytest.approx(min(np.array([3.0, -1.0]) @ ahead - 1.5, 0.5))


def test_the_run_under_a_skill_goes_straight_at_the_obstacle():
    state, memory = np.random.default_rng(2).normal(size=layout.STATE_SIZE), np.zeros(kernel.SHARED_MEMORY)
    memory[[kernel.AHEAD_X, kernel.AHEAD_Y, kernel.TRIM]] = 0.0, 1.0, 0.12
    kernel.hold_course(memory, state)
    assert state[layout.HEADING] == pytest.approx(0.5 * math.pi) and state[layout.TRIM] == 0.12
    assert state[layout.SLOPE] == state[layout.TURN_RATE] == 0.0


def test_feedback_is_of_low_rank_and_limited():
    rng = np.random.default_rng(4)
    sensors, bins = 15, 5
    m_sp, m_ap = rng.normal(size=kernel.RANK * sensors), rng.normal(size=9 * kernel.RANK)
    reference = rng.normal(size=(bins, sensors))
    for scale in (0.05, 10.0):
        sensed = reference[2] + scale * rng.normal(size=sensors)
        action, side_action = np.zeros(6), np.zeros(6)
        kernel.add_feedback(m_sp, m_ap, sensed, reference, 0.5, action, side_action)
        latent = np.clip(m_sp.reshape(kernel.RANK, sensors) @ (sensed - reference[2]), -1.0, 1.0)
        hip, abduction, rotation, *_ = m_ap.reshape(9, kernel.RANK) @ latent
        assert action[0] == pytest.approx(hip) and side_action[:2] == pytest.approx([abduction, rotation])
        assert action[[1, 3, 4]] == pytest.approx(0.0)  # knees and ankle are not fed back


def test_the_pace_changes_how_fast_the_phase_goes_on():
    state, knots, timing = np.zeros(layout.STATE_SIZE), np.array([2.0, 4.0]), np.array([0.4, 0.3])
    state[[layout.PHASE, layout.SPEED]] = 0.5, 3.0
    assert kernel.advance_pace(1.2, knots, timing, state) == pytest.approx(0.35)
    assert state[layout.PHASE] == pytest.approx(0.5 + 0.2 * CONTROL_DT / 0.35)
    state[layout.SPEED] = 9.0
    assert kernel.advance_pace(1.0, knots, timing, state) == pytest.approx(0.3)
    state[layout.PHASE] = 1.0
    kernel.advance_pace(2.0, knots, timing, state)
    assert state[layout.PHASE] == 1.0


def test_offsets_come_in_softly():
    wanted, offset, ctrl = np.full(N, 0.4), np.zeros(N), np.full(N, 1.0)
    kernel.apply_offset(wanted, offset, ctrl)
    assert ctrl == pytest.approx(1.0 + 0.4 * (1.0 - math.exp(-CONTROL_DT / 0.02)))
    for _ in range(30):
        kernel.apply_offset(wanted, offset, np.zeros(N))
    assert offset == pytest.approx(0.4, abs=1e-6)
