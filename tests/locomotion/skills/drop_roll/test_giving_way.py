"""Legs that give way: their force and torques against the slow versions and MuJoCo, and how they let go."""

import mujoco
import numpy as np
import pytest

from locomotion.body.person import CONTROL_DT, JOINT_NAMES, build_person
from locomotion.gaits.run import controller, layout
from locomotion.skills.drop_roll import giving_way as law
from locomotion.skills.drop_roll.reference import giving_leg, point_of_sole, sole_force

N = len(JOINT_NAMES)
GIVE = np.array([0.04, 8.0, 0.45, -0.3, 6.0, 60.0, 0.08, 2.0, 0.05])
LEGS = [np.array(law.LEG) + hip for hip in law.HIPS]


def landing(seed, contacts=(300.0, 300.0)):
    rng = np.random.default_rng(seed)
    state = controller.new_state()
    state[controller.COM] = 0.3, -0.1, 0.8
    state[controller.COM_VELOCITY] = 3.0, 0.0, -4.0
    state[controller.FEET] = 0.5, -0.2, 0.1, 0.4, 0.1, 0.12
    state[layout.RIGHT_CONTACT], state[layout.LEFT_CONTACT] = contacts
    qpos, qvel = np.zeros(7 + N), np.zeros(6 + N)
    qpos[7:], qvel[6:] = rng.uniform(0.0, 1.2, N), rng.normal(0.0, 3.0, N)
    return state, qpos, qvel


def force_of(state, give=GIVE, rate=2.0):
    return law.sole_force(give, state, 1.0, 0.0, 0.0, rate)


@pytest.mark.parametrize(("contacts", "ahead"), [((300.0, 300.0), 0.15), ((300.0, 0.0), 0.2 - 0.1 / 11.0)])
@pytest.mark.parametrize("speed", [-6.0, -4.0, -0.2, 1.0])
def test_the_force_agrees_with_the_slow_version(speed, contacts, ahead):
    state, _, _ = landing(1, contacts)
    state[layout.VELOCITY_Z] = speed
    lowest = 0.11 if contacts[1] else 0.1 + 0.02 / 11.0
    feet = np.array([ahead + GIVE[law.BALL], lowest - 0.064 - 0.8])
    np.testing.assert_allclose(force_of(state), sole_force(GIVE, 0.8, speed, feet, 2.0), rtol=1e-12)


def test_the_force_slows_a_fall_down_evenly():
    state, height, speed, forces = landing(1)[0], 0.9, -5.0, []
    while height > GIVE[law.END_HEIGHT] + 0.05:
        state[layout.COM_Z], state[layout.VELOCITY_Z] = height, speed
        forces.append(force_of(state)[1] / 65.0)
        speed += (forces[-1] - 9.81) * 1e-5
        height += speed * 1e-5
    even = 9.81 + (5.0**2 - 0.3**2) / (2.0 * 0.45)
    np.testing.assert_allclose(forces, even, rtol=2e-3)
    assert speed**2 == pytest.approx(0.3**2 + 2.0 * (even - 9.81) * 0.05, rel=0.02)


@pytest.mark.parametrize("ticks", [0.0, 3.0])
def test_targets_agree_with_the_slow_version(ticks):
    state, qpos, qvel = landing(2)
    giving = np.r_[1.0, np.random.default_rng(5).normal(size=6)]
    before, ctrl = giving.copy(), np.zeros(N)
    force = force_of(state)
    law.give_way(GIVE, giving, ticks, 0.6, force, state, qpos, qvel, ctrl)
    for number, leg in enumerate(LEGS):
        last = before[1 + 3 * number : 4 + 3 * number] if ticks else None
        rates, half = qvel[6 + leg], 0.5 * np.array(force)
        wanted = giving_leg(0.6, qpos[7 + leg], rates, last, half, GIVE[law.BALL])
        np.testing.assert_allclose(ctrl[leg], wanted, atol=1e-7)
        np.testing.assert_array_equal(giving[1 + 3 * number : 4 + 3 * number], rates)
    assert np.count_nonzero(ctrl) == 6


def test_the_slow_version_knows_the_person():
    """Its sole, and the torques that bear a force there, are those of MuJoCo's model."""
    model, joints, pitch = build_person(), np.array([0.9, 1.1, 0.2]), 0.4
    data, foot = mujoco.MjData(model), model.body("left_foot").id
    data.qpos[3:7] = np.cos(pitch / 2), 0.0, np.sin(pitch / 2), 0.0
    data.qpos[7 + LEGS[1]] = joints
    mujoco.mj_forward(model, data)
    point = data.xpos[foot] + data.xmat[foot].reshape(3, 3) @ [0.08, 0.0, -0.064]
    hip = data.xanchor[model.joint("left_hip_flexion").id]
    np.testing.assert_allclose((point - hip)[[0, 2]], point_of_sole(pitch, joints, 0.08), atol=1e-9)
    jacobian = np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, jacobian, None, point, foot)
    torques = -jacobian[:, 6 + LEGS[1]].T @ [60.0, 0.0, 200.0]
    targets = giving_leg(pitch, joints, np.zeros(3), None, np.array([60.0, 200.0]), 0.08)
    np.testing.assert_allclose((targets - joints) * [600.0, 500.0, 400.0], torques, atol=1e-5)


def test_a_foot_in_the_air_bears_little():
    state, qpos, qvel = landing(3, (300.0, 0.0))
    qpos[7 + LEGS[1]], qvel[6:] = qpos[7 + LEGS[0]], 0.0
    ctrl = np.zeros(N)
    law.give_way(GIVE, np.r_[1.0, np.zeros(6)], 0.0, 0.6, (0.0, 300.0), state, qpos, qvel, ctrl)
    right, left = (ctrl[leg] - qpos[7 + leg] for leg in LEGS)
    np.testing.assert_allclose(left, 0.1 * right)


def test_past_the_angle_the_pose_takes_over():
    state, qpos, qvel = landing(4)
    giving, holds = np.r_[1.0, np.zeros(6)], []
    for tick in range(8):
        law.give_way(GIVE, giving, float(tick), 2.1, force_of(state), state, qpos, qvel, np.zeros(N))
        holds.append(giving[law.HOLDS])
    np.testing.assert_allclose(holds[:5], 1.0 - CONTROL_DT / GIVE[law.BLEND] * np.arange(1, 6), atol=1e-12)
    assert holds[-1] == 0.0
    ctrl = np.zeros(N)
    law.give_way(GIVE, giving, 9.0, 2.1, force_of(state), state, qpos, qvel, ctrl)
    assert not ctrl.any()


def test_folding_targets_lead_the_joints():
    _, qpos, _ = landing(5)
    ctrl = np.zeros(N)
    law.fold_legs(GIVE, qpos, ctrl)
    hips, knees = np.array(law.HIPS), np.array(law.HIPS) + 3
    np.testing.assert_allclose(ctrl[knees] - qpos[7 + knees], 0.12 * 8.0)
    np.testing.assert_allclose(ctrl[hips] - qpos[7 + hips], 0.06 * 8.0)
