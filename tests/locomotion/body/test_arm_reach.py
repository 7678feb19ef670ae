"""Hands: where they are and reach (against MuJoCo's kinematics), and holding on."""

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from locomotion.body.arm_reach import ARM_START, hand_place, reach, shoulder_frame
from locomotion.body.hand_hold import HAND_POINT, hold, holding, let_go, let_go_both
from locomotion.body.person import JOINT_NAMES, build_person

SIDES = ((-1.0, "right"), (1.0, "left"))
MODEL = build_person()
DATA = mujoco.MjData(MODEL)


def pose(seed, spread=0.6):
    rng = np.random.default_rng(seed)
    turn = rng.normal(size=4)
    return np.concatenate([rng.normal(size=3), turn / np.linalg.norm(turn), rng.uniform(-spread, spread, 39)])


def simulated_hand(qpos, name):
    DATA.qpos[:] = qpos
    mujoco.mj_kinematics(MODEL, DATA)
    body = MODEL.body(f"{name}_hand").id
    return DATA.xpos[body] + DATA.xmat[body].reshape(3, 3) @ np.array(HAND_POINT)


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_hand_and_shoulder_are_where_the_model_has_them(seed):
    qpos = pose(seed)
    for side, name in SIDES:
        np.testing.assert_allclose(hand_place(qpos, side), simulated_hand(qpos, name), atol=1e-12)
        shoulder, frame = shoulder_frame(qpos, side)
        np.testing.assert_allclose(shoulder, DATA.xpos[MODEL.body(f"{name}_upper_arm").id], atol=1e-12)
        clavicle = DATA.xmat[MODEL.body(f"{name}_clavicle").id].reshape(3, 3)
        np.testing.assert_allclose(frame, clavicle, atol=1e-12)


@settings(max_examples=100, deadline=None)
@given(
    st.integers(0, 2**32 - 1), st.floats(0.45, 0.62), st.floats(-0.5, 1.2), st.floats(-0.1, 0.6),
    st.floats(-0.2, 0.4),
)  # fmt: skip
def test_reaches_a_point_before_the_body(seed, away, up, out, rotation):
    for side, name in SIDES:
        qpos = pose(seed)
        shoulder, frame = shoulder_frame(qpos, side)
        ahead = np.array([np.cos(up), 0.0, np.sin(up) - 0.6])
        target = shoulder + frame @ (away * ahead / np.linalg.norm(ahead) + [0.0, side * out * 0.2, 0.0])
        angles = np.empty(4)
        share = reach(qpos, side, target, rotation, angles)
        arm = 7 + ARM_START[side > 0]
        qpos[arm : arm + 7] = [*angles, 0.0, 0.0, 0.0]
        missed = float(np.linalg.norm(simulated_hand(qpos, name) - target))
        if share < 0.99:
            # the hand's point is that far off its axis
            assert missed == pytest.approx(HAND_POINT[0], abs=1e-9)


def test_a_point_out_of_reach_is_pointed_at():
    qpos = pose(3, 0.2)
    shoulder, _ = shoulder_frame(qpos, 1.0)
    angles = np.empty(4)
    target = shoulder + shoulder_frame(qpos, 1.0)[1] @ np.array([2.0, 0.3, -1.0])
    assert reach(qpos, 1.0, target, 0.2, angles) > 2.0
    arm = 7 + ARM_START[1]
    qpos[arm : arm + 7] = [*angles, 0.0, 0.0, 0.0]
    hand = simulated_hand(qpos, "left")
    towards = (target - shoulder) / np.linalg.norm(target - shoulder)
    assert (hand - shoulder) @ towards > 0.63


@pytest.mark.parametrize("side, name", SIDES)
def test_a_held_hand_stays_and_lets_go(side, name):
    data = mujoco.MjData(MODEL)
    data.qpos[2] = 2.0
    mujoco.mj_forward(MODEL, data)
    assert not holding(data, side) and data.ne == 0
    point = hand_place(data.qpos, side)
    hold(data, side, point)
    mujoco.mj_step(MODEL, data, 120)  # the person falls and hangs on its hand
    assert holding(data, side) and not holding(data, -side)
    assert np.linalg.norm(hand_place(data.qpos, side) - point) < 0.02
    assert data.qpos[2] < 1.9
    let_go(data, side)
    mujoco.mj_step(MODEL, data, 40)
    assert np.linalg.norm(hand_place(data.qpos, side) - point) > 0.1
    hold(data, side, point)
    let_go_both(data)
    assert not holding(data, side)


def test_what_a_hand_holds_is_saved_with_the_state():
    kind = mujoco.mjtState.mjSTATE_INTEGRATION
    first, second = mujoco.MjData(MODEL), mujoco.MjData(MODEL)
    mujoco.mj_forward(MODEL, first)
    hold(first, -1.0, hand_place(first.qpos, -1.0))
    state = np.empty(mujoco.mj_stateSize(MODEL, kind))
    mujoco.mj_getState(MODEL, first, state, kind)
    mujoco.mj_setState(MODEL, second, state, kind)
    for data in (first, second):
        mujoco.mj_step(MODEL, data, 30)
    np.testing.assert_array_equal(first.qpos, second.qpos)
    assert holding(second, -1.0)


def test_the_reaching_joints_are_named_as_expected():
    for start, (_, name) in zip(ARM_START, SIDES, strict=True):
        parts = ("shoulder_flexion", "shoulder_abduction", "shoulder_rotation", "elbow_flexion")
        assert JOINT_NAMES[start : start + 4] == tuple(f"{name}_{part}" for part in parts)
