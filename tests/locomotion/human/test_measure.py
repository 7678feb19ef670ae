"""People of other sizes: what is theirs in the world, against a MuJoCo person that is made larger itself."""

from dataclasses import asdict, replace

import mujoco
import numpy as np
import pytest

from locomotion.avoidance.yielding import SPACING
from locomotion.body.person import JOINT_NAMES, build_person
from locomotion.body_events import Fell, GotUp, SetOff, StrayedFromPath, TookOff, TurnedAway
from locomotion.gaits.limits import run_limits
from locomotion.human.human import Human
from locomotion.human.measure import Measure, resized
from locomotion.paths.smoothing import ObstacleAhead

HERE = (0.0, 0.0, 0.0)


def enlarged(size: float) -> mujoco.MjModel:
    """The obvious way: the usual person with every length `size` times as long, and all else that goes with
    it for a body of the same density under the same gravity."""
    model, root = build_person(), np.sqrt(size)
    own = slice(1, None)
    model.body_pos[own] *= size
    model.body_ipos[own] *= size
    model.jnt_pos[:] *= size
    model.qpos0[:3] *= size
    figure = model.geom_bodyid > 0
    model.geom_pos[figure] *= size
    model.geom_size[figure] *= size
    model.geom_rbound[figure] *= size
    model.geom_margin[:] *= size
    model.body_mass[:] *= size**3
    model.body_inertia[:] *= size**5
    joints = slice(6, None)
    model.dof_armature[joints] *= size**5
    model.dof_damping[joints] *= size**4.5
    model.jnt_stiffness[:] *= size**4
    model.actuator_gainprm[:, 0] *= size**4
    model.actuator_biasprm[:, 1] *= size**4
    model.actuator_biasprm[:, 2] *= size**4.5
    model.actuator_forcerange[:] *= size**4
    for field in ("geom_solref", "jnt_solref", "dof_solref"):
        getattr(model, field)[..., 0] *= root
    model.geom_solimp[:, 2] *= size
    model.opt.timestep *= root
    mujoco.mj_setConst(model, mujoco.MjData(model))
    return model


@pytest.mark.parametrize("size", [0.88, 1.08])
def test_a_body_that_is_made_larger_moves_as_its_measure_says(size):
    """It drops onto the floor with bent knees, arms moving."""
    usual, large = build_person(), enlarged(size)
    one, other = mujoco.MjData(usual), mujoco.MjData(large)
    one.qpos[2], one.qvel[0] = 1.0, 1.5
    other.qpos[2], other.qvel[0] = size, np.sqrt(size) * 1.5
    targets = np.zeros(len(JOINT_NAMES))
    targets[[k for k, name in enumerate(JOINT_NAMES) if "knee" in name or "elbow" in name]] = 0.5
    touched = 0
    for _ in range(120):  # 0.3 s: later, contacts make small differences grow
        one.ctrl[:], other.ctrl[:] = targets, targets
        mujoco.mj_step(usual, one)
        mujoco.mj_step(large, other)
        touched = max(touched, one.ncon)
    assert touched > 0
    np.testing.assert_allclose(other.qpos[:3] / size, one.qpos[:3], atol=2e-3)
    np.testing.assert_allclose(other.qpos[3:], one.qpos[3:], atol=5e-3)
    np.testing.assert_allclose(other.time, Measure(size).root * one.time)


@pytest.mark.parametrize(
    ("own", "told"),
    [
        (SetOff(2.0, (1.0, 2.0, 3.0), (4.0, 5.0, 6.0), 10.0),
         SetOff(1.8, (0.81, 1.62, 2.43), (3.24, 4.05, 4.86), 8.1)),
        (TookOff(1.0, HERE, "vault", 1.0, 0.1, 0.2), TookOff(0.9, HERE, "vault", 0.81, 0.081, 0.18)),
        (Fell(1.0, HERE, 3.0, 0.2, 10.0), Fell(0.9, HERE, 2.7, 0.2, 8.1)),
        (GotUp(1.0, HERE, 5.0), GotUp(0.9, HERE, 4.5)),
        (StrayedFromPath(1.0, HERE, 2.0), StrayedFromPath(0.9, HERE, 1.62)),
        (TurnedAway(1.0, HERE, "gap", 1.0, 0.3), TurnedAway(0.9, HERE, "gap", 0.81, 0.3)),
    ],
)  # fmt: skip
def test_events_are_told_in_metres_and_seconds_of_the_world(own, told):
    for name, value in asdict(Measure(0.81).event(own)).items():
        assert value == (value if isinstance(value, str) else pytest.approx(getattr(told, name)))


def test_an_obstacle_keeps_its_kind_and_direction():
    wall = ObstacleAhead(5.0, "vault", 0.8, np.array([5.0, 1.0, 0.8]), np.array([-1.0, 0.0, 0.0]), 0.3)
    there = resized(wall, 1.25)
    assert (there.arc_length, there.height, there.depth) == (6.25, 1.0, 0.375)
    assert there.position.tolist() == [6.25, 1.25, 1.0] and there.normal.tolist() == [-1.0, 0.0, 0.0]
    assert there.affordance == "vault"


def test_limits_are_those_of_its_legs():
    usual = replace(run_limits(Human(rehearsals=0).on_feet.run_skill), sharpest=0.5)
    tall = Measure(1.21).limits(usual)
    np.testing.assert_allclose(tall.speeds, 1.1 * np.array(usual.speeds))
    assert tall.sharpest == pytest.approx(0.5 / 1.21)
    assert (tall.sideways, tall.acceleration) == (usual.sideways, usual.acceleration)
    # the sharpest bend that it can run is as far from its limit sideways as that of the usual person
    assert tall.speeds[1] ** 2 * tall.sharpest == pytest.approx(usual.speeds[1] ** 2 * 0.5)


@pytest.mark.parametrize("size", [0.88, 1.0, 1.08])
def test_a_course_keeps_its_shape_and_spacing(size):
    human = Human(rehearsals=0)
    human.reset((0.0, 0.0, 0.0), 0.0)
    human.follow(np.array([(0.0, 0.0, 0.0), (6.0, 0.0, 0.0), (12.0, 3.0, 0.0)]), 1.2)
    for _ in range(100):
        human.tick()
    own = human.course()
    assert own is not None
    measure = Measure(size)
    told = measure.course(own)
    steps = np.linalg.norm(np.diff(told.points[:, :2], axis=0), axis=1)
    np.testing.assert_allclose(steps, SPACING, atol=0.03 * SPACING)
    np.testing.assert_allclose(told.points[[0, -1]], size * own.points[[0, -1]])
    assert told.speed == pytest.approx(measure.root * own.speed)
    shift = np.column_stack([np.zeros(len(told.points)), np.sin(np.linspace(0.0, 3.1, len(told.points)))])
    back = measure.shift(shift)
    np.testing.assert_allclose(back[[0, -1]], shift[[0, -1]] / size)
    assert abs(len(back) - len(own.points)) <= 1
    assert back[:, 1].max() == pytest.approx(1.0 / size, rel=1e-2)
