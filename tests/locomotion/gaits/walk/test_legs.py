"""What the legs of a walking person do, against MuJoCo: a stance leg pushes, a swing leg is led."""

import mujoco
import numpy as np
import pytest

from locomotion.body.anatomy import ANKLE, MASS
from locomotion.body.person import JOINT_NAMES, PersonIndex, build_person
from locomotion.gaits.run.controller import COM, OBSERVED, new_state
from locomotion.gaits.walk.controller import walk_tick
from locomotion.gaits.walk.footholds import SOLE
from locomotion.gaits.walk.layout import (
    CLOCK,
    FOOTHOLD,
    FOOTHOLD_NORMAL,
    GAINS,
    LIFT,
    LIFT_NORMAL,
    SWING_ANGLES,
    SWING_TIME,
    first_gains,
    new_walk,
)
from locomotion.gaits.walk.legs import swing_leg
from locomotion.gaits.walk.skill import load_walk_skill, plant
from locomotion.ground.ground import plane_lookup

HIPS = [JOINT_NAMES.index(f"{side}_hip_flexion") for side in ("right", "left")]


@pytest.fixture(scope="module")
def person():
    model = build_person()
    return model, mujoco.MjData(model), PersonIndex.of(model)


def test_stance_legs_push_as_the_full_jacobian_says(person):
    """The torques asked for balance the ground's force: compared with MuJoCo's Jacobian of the foot."""
    model, data, index = person
    state, walk = new_state(), new_walk()
    plant(model, data, index, plane_lookup(), state, walk, np.zeros(3), 0.3)
    ctrl = np.zeros(len(JOINT_NAMES))
    tables = load_walk_skill().tables.copy()
    tables[:, list(GAINS).index("leg_damping")] = 0.0
    tables[:, list(GAINS).index("height")] = state[COM][2]  # neither up nor down
    tables[:, list(GAINS).index("pressure_gain")] = 1.0  # and hardly forwards or back
    walk_tick(
        tables, plane_lookup(), walk, state[OBSERVED], np.array([0.3, 0, 0, 0]), data.qpos, data.qvel, ctrl
    )
    total = np.zeros(3)
    for k, hip in enumerate(HIPS):
        torque = (ctrl - data.qpos[7:])[hip : hip + 6] * -model.actuator_biasprm[hip : hip + 6, 1]
        jacobian, dofs = np.zeros((3, model.nv)), slice(6 + hip, 12 + hip)
        # the force at the sole that these torques balance: least squares over points of the sole
        best = np.inf
        for along in np.linspace(-0.1, 0.14, 121):
            foot = data.xmat[index.feet[k]].reshape(3, 3)
            point = data.xpos[index.feet[k]] + (along + 0.045) * foot[:, 0] - 0.064 * foot[:, 2]
            mujoco.mj_jac(model, data, jacobian, None, point, index.feet[k])
            force, rest, *_ = np.linalg.lstsq(-jacobian[:, dofs].T, torque, rcond=None)
            if rest.size and rest[0] < best:
                best, found = rest[0], force
        assert best < 40.0  # [Nm]^2: the rest is the moment about the vertical
        total += found
    assert total[2] == pytest.approx(MASS * 9.81, rel=0.2)
    assert np.abs(total[:2]).max() < 60.0


def sole_when(clock, walk, person):
    """Place of the left sole and its upward axis where its leg is led to at ``clock`` [s]."""
    model, data, index = person
    mujoco.mj_resetData(model, data)
    data.qpos[2] -= 0.1  # so low that its feet are in reach
    mujoco.mj_kinematics(model, data)
    ctrl, hip = np.zeros(len(JOINT_NAMES)), HIPS[1]
    walk[CLOCK] = clock
    pelvis, at = data.xmat[index.root].copy(), data.xanchor[hip + 1].copy()
    swing_leg(first_gains(), walk, pelvis, at, np.zeros(2), hip, 1.0, ctrl)
    data.qpos[7 + hip : 13 + hip] = walk[SWING_ANGLES]
    mujoco.mj_kinematics(model, data)
    foot = data.xmat[index.feet[1]].reshape(3, 3)
    return data.xpos[index.feet[1]] + SOLE * foot[:, 0] - ANKLE * foot[:, 2], foot[:, 2]


def test_a_swing_leg_leads_its_foot_from_where_it_left_the_ground_to_its_foothold(person):
    walk = new_walk()
    lift, spot = np.array([-0.25, 0.1, 0.0]), np.array([0.3, 0.12, 0.08])
    slope = np.array([-0.2, 0.0, 1.0]) / np.hypot(0.2, 1.0)
    walk[LIFT], walk[LIFT_NORMAL] = lift, (0.0, 0.0, 1.0)
    walk[FOOTHOLD], walk[FOOTHOLD_NORMAL] = spot, slope
    walk[SWING_TIME] = 0.4
    place, up = sole_when(0.0, walk, person)
    assert place == pytest.approx(lift, abs=1e-6) and up == pytest.approx([0.0, 0.0, 1.0], abs=1e-6)
    place, up = sole_when(0.4, walk, person)
    assert place == pytest.approx(spot, abs=1e-6) and up == pytest.approx(slope, abs=1e-6)
    middle, _ = sole_when(0.2, walk, person)
    assert lift[0] < middle[0] < spot[0] and middle[2] > spot[2] + 0.02  # it clears the ground between
    walk[FOOTHOLD] = walk[LIFT] = lift
    late, _ = sole_when(0.5, walk, person)  # there was no ground: it reaches for it
    assert late[2] < -0.02
