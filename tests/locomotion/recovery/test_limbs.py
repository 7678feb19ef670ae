"""Arms and legs of a person on hands and feet, against MuJoCo."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from locomotion.body.anatomy import MASS
from locomotion.body.person import PersonIndex, build_person
from locomotion.human.human import Human
from locomotion.recovery.layout import BIAS, LOADS, SEEN_COM, SEEN_FORCES, SEEN_LIMBS
from locomotion.recovery.limbs import (
    BALL,
    HIGHEST,
    LEGS,
    LOWEST,
    STIFFNESS,
    attitude,
    bear,
    leg_angles,
    turned,
)
from locomotion.recovery.senses import observe_scramble, parts_of
from tests.locomotion.recovery.falling import plane

WEIGHT = 9.81 * MASS


@pytest.fixture(scope="module")
def model():
    return build_person()


def test_servos_and_ranges_are_those_of_the_model(model):
    assert STIFFNESS == pytest.approx(model.actuator_gainprm[:, 0])
    assert LOWEST == pytest.approx(model.jnt_range[1:, 0]) and HIGHEST == pytest.approx(
        model.jnt_range[1:, 1]
    )


def test_the_pelvis_turns_leans_and_rolls_in_this_order():
    qref, frame = np.zeros(46), np.empty((3, 3))
    attitude(0.7, 0.5, -0.3, qref)
    turned(qref[3:7], frame)
    assert frame == pytest.approx(Rotation.from_euler("ZYX", [0.7, 0.5, -0.3]).as_matrix())


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("pitch", [0.0, -0.4])
def test_a_foot_is_put_on_its_ball(model, side, pitch):
    """On level ground and on a slope, with the heel as high as the ankle needs it."""
    data, index = mujoco.MjData(model), PersonIndex.of(model)
    qref, frame, angles = np.zeros(46), np.empty((3, 3)), np.empty(7)
    qref[:3] = 0.2, 0.1, 0.5
    attitude(0.3, 0.8, 0.1, qref)
    turned(qref[3:7], frame)
    ball = qref[:3] + Rotation.from_euler("z", 0.3).apply([-0.15, 0.15 * side, -0.45])
    leg_angles(qref, frame, ball, 0.3, pitch, side, angles)
    data.qpos[:] = qref
    leg = LEGS[side > 0]
    data.qpos[7 + leg : 14 + leg] = angles
    mujoco.mj_kinematics(model, data)
    foot = index.feet[int(side > 0)]
    found = data.xpos[foot] + data.xmat[foot].reshape(3, 3) @ BALL
    assert np.linalg.norm(found - ball) < 0.03  # sideways the ankle bends by no more than it can
    assert angles[4] <= 0.42 + 1e-9 and 0.0 <= angles[6] <= 1.0


def test_limbs_that_are_down_carry_the_weight_so_that_it_passes_through_the_centre_of_mass():
    human = Human(plane(0.6), clearing=())
    human.reset((0, 0, 0), 0.0)
    model, data, parts = human.model, human.data, parts_of(human.index, human.model)
    memory, toes = human.fours.memory, [human.index.bodies[f"{side}_toes"] for side in ("right", "left")]
    for loads in ([1.0, 1.0, 1.0, 1.0], [0.0, 1.0, 1.0, 1.0]):
        observe_scramble(parts, data, memory)
        memory[LOADS], memory[SEEN_FORCES] = loads, 400.0
        limbs, torques = memory[SEEN_LIMBS].reshape(4, 3).copy(), np.empty(39)
        bear(memory, limbs, np.zeros(2), torques)
        lever = np.empty((39, 4))
        for k, body in enumerate([*parts.ends[:2], *toes]):
            jacobian = np.zeros((3, model.nv))
            mujoco.mj_jac(model, data, jacobian, None, limbs[k], body)
            lever[:, k] = jacobian[2, 6:]
        lever[6:9] = 0.0
        forces, rest, *_ = np.linalg.lstsq(-lever, torques - memory[BIAS], rcond=None)
        assert rest[0] < 1e-6 and forces.sum() == pytest.approx(WEIGHT, rel=1e-3)
        assert forces[np.array(loads) == 0.0] == pytest.approx(0.0, abs=1e-6)
        assert (forces > -1e-6).all()
        if all(loads):
            assert forces @ limbs[:, :2] / forces.sum() == pytest.approx(memory[SEEN_COM][:2], abs=0.03)


def test_a_limb_that_bears_nothing_yet_presses_only_lightly():
    human = Human(plane(0.6), clearing=())
    human.reset((0, 0, 0), 0.0)
    memory = human.fours.memory
    observe_scramble(parts_of(human.index, human.model), human.data, memory)
    limbs, light, firm = memory[SEEN_LIMBS].reshape(4, 3).copy(), np.empty(39), np.empty(39)
    for forces, torques in ((0.0, light), (400.0, firm)):
        memory[SEEN_FORCES] = forces
        bear(memory, limbs, np.zeros(2), torques)
    assert np.abs(light - memory[BIAS]).max() < 0.5 * np.abs(firm - memory[BIAS]).max()


def test_limbs_push_a_body_so_that_it_does_not_turn():
    human = Human(plane(0.0), clearing=())
    human.reset((0, 0, 0), 0.0)
    model, data, parts = human.model, human.data, parts_of(human.index, human.model)
    observe_scramble(parts, data, human.fours.memory)
    memory, toes = human.fours.memory, [human.index.bodies[f"{side}_toes"] for side in ("right", "left")]
    memory[SEEN_FORCES] = 400.0
    limbs, torques, push = memory[SEEN_LIMBS].reshape(4, 3).copy(), np.empty(39), np.array([-0.5, 0.0])
    limbs[:2, 0] += 0.4  # hands ahead of the body, feet below it
    limbs[:2, 2] = limbs[2, 2]
    bear(memory, limbs, push, torques)
    lever = np.empty((39, 12))
    for k, body in enumerate([*parts.ends[:2], *toes]):
        jacobian = np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, jacobian, None, limbs[k], body)
        lever[:, 3 * k : 3 * k + 3] = jacobian[:, 6:].T
    lever[6:9] = 0.0
    forces = np.linalg.lstsq(-lever, torques - memory[BIAS], rcond=None)[0].reshape(4, 3)
    assert forces.sum(axis=0) == pytest.approx([-0.5 * MASS, 0.0, WEIGHT], rel=0.01, abs=0.5)
    turning = np.cross(limbs - memory[SEEN_COM], forces).sum(axis=0)
    assert np.abs(turning).max() < 0.05 * WEIGHT
