"""The person's model: size, mass, freedom, limits."""

import mujoco
import numpy as np
import pytest

from locomotion.body.person import (
    HEIGHT,
    JOINT_NAMES,
    MASS,
    STANDING_HEIGHT,
    PersonIndex,
    build_person,
    person_digest,
)
from locomotion.errors import LocomotionError


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    return build_person()


def test_is_170_cm_tall(model: mujoco.MjModel) -> None:
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    low, high = np.inf, -np.inf
    for geom in range(model.ngeom):
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_CAPSULE:
            reach = abs(data.geom_xmat[geom, 8]) * model.geom_size[geom, 1] + model.geom_size[geom, 0]
            low = min(low, data.geom_xpos[geom, 2] - reach)
            high = max(high, data.geom_xpos[geom, 2] + reach)
    assert low == pytest.approx(0.0, abs=0.002)
    assert high == pytest.approx(HEIGHT, abs=0.01)
    assert data.xpos[PersonIndex.of(model).root, 2] == STANDING_HEIGHT


def test_mass_and_its_place(model: mujoco.MjModel) -> None:
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert model.body_mass.sum() == pytest.approx(MASS, rel=1e-3)
    # standing men have their centre of mass at 55 to 57 % of their height
    assert 0.54 < data.subtree_com[0, 2] / HEIGHT < 0.58


def test_freedom_and_layout(model: mujoco.MjModel) -> None:
    assert (model.nq, model.nv, model.nu) == (46, 45, 39)
    assert tuple(model.joint(i + 1).name for i in range(39)) == JOINT_NAMES
    assert tuple(model.actuator(i).name for i in range(39)) == JOINT_NAMES


def test_limits_hold_torque_and_angle(model: mujoco.MjModel) -> None:
    knee = model.joint("left_knee_flexion")
    assert np.rad2deg(knee.range[1]) == pytest.approx(150.0)
    assert model.jnt_limited[1:].all() and model.actuator_forcelimited.all()
    assert model.actuator_forcerange[:, 1].max() <= 350.0
    data = mujoco.MjData(model)
    data.ctrl[:] = 3.0
    mujoco.mj_step(model, data, 20)
    assert (np.abs(data.actuator_force) <= model.actuator_forcerange[:, 1] + 1e-9).all()


def test_left_mirrors_right(model: mujoco.MjModel) -> None:
    """The same anatomical angles on both sides give a pose that is symmetric about the x-z plane."""
    data = mujoco.MjData(model)
    rng = np.random.default_rng(0)
    for name in JOINT_NAMES:
        if name.startswith("right_"):
            angle = rng.uniform(-0.4, 0.4)
            data.joint(name).qpos = angle
            data.joint("left_" + name[6:]).qpos = angle
    mujoco.mj_kinematics(model, data)
    for part in ("hand", "foot", "toes"):
        right, left = data.body(f"right_{part}").xipos, data.body(f"left_{part}").xipos
        np.testing.assert_allclose(left, right * [1, -1, 1], atol=1e-12)


def test_parts_do_not_touch_each_other(model: mujoco.MjModel) -> None:
    data = mujoco.MjData(model)
    data.qpos[2] = 3.0
    mujoco.mj_forward(model, data)
    assert data.ncon == 0


def test_model_without_a_person_is_refused() -> None:
    with pytest.raises(LocomotionError, match="pelvis"):
        PersonIndex.of(mujoco.MjModel.from_xml_string("<mujoco/>"))


def test_digest_is_stable() -> None:
    assert person_digest.__wrapped__() == person_digest()
