"""Angles of a leg against MuJoCo's forward kinematics."""

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from locomotion.body.leg_kinematics import solve_leg, solve_plain_leg
from locomotion.body.person import JOINT_NAMES, PersonIndex, build_person

HIPS = [JOINT_NAMES.index(f"{side}_hip_flexion") for side in ("right", "left")]


@pytest.fixture(scope="module")
def person():
    model = build_person()
    return model, mujoco.MjData(model), PersonIndex.of(model)


@given(seed=st.integers(0, 10_000))
@settings(max_examples=60, deadline=None)
def test_leg_angles_put_the_foot_where_forward_kinematics_had_it(person, seed):
    model, data, index = person
    rng = np.random.default_rng(seed)
    data.qpos[3:7] = rng.normal(size=4)
    data.qpos[3:7] /= np.linalg.norm(data.qpos[3:7])
    for hip in HIPS:
        low, high = model.jnt_range[hip + 1 : hip + 7].T
        data.qpos[7 + hip : 13 + hip] = rng.uniform(0.8 * low, 0.8 * high)
        data.qpos[10 + hip] = rng.uniform(0.2, 1.8)
    mujoco.mj_kinematics(model, data)
    wanted = data.xpos[index.feet].copy(), data.xmat[index.feet].copy()
    for k, hip in enumerate(HIPS):
        foot, angles = data.xmat[index.feet[k]].reshape(3, 3).copy(), np.empty(6)
        pelvis = data.xmat[index.root].reshape(3, 3).copy()
        at = data.xanchor[hip + 1].copy()
        assert solve_leg(pelvis, at, foot, data.xpos[index.feet[k]].copy(), 2.0 * k - 1.0, angles)
        data.qpos[7 + hip : 13 + hip] = angles
    mujoco.mj_kinematics(model, data)
    assert np.abs(data.xpos[index.feet] - wanted[0]).max() < 1e-9
    assert np.abs(data.xmat[index.feet] - wanted[1]).max() < 1e-9


def test_ankle_out_of_reach_is_approached_on_the_line_to_it(person):
    model, data, index = person
    mujoco.mj_resetData(model, data)
    mujoco.mj_kinematics(model, data)
    hip, angles = HIPS[1], np.empty(6)
    at, far = data.xanchor[hip + 1].copy(), data.xanchor[hip + 1] + np.array([0.6, 0.1, -0.9])
    assert not solve_leg(np.eye(3), at, np.eye(3), far, 1.0, angles)
    data.qpos[7 + hip : 13 + hip] = angles
    mujoco.mj_kinematics(model, data)
    way = data.xpos[index.feet[1]] - at
    assert np.dot(way, far - at) / np.linalg.norm(way) / np.linalg.norm(far - at) > 0.999
    assert 0.82 < np.linalg.norm(way) < 0.84


@given(seed=st.integers(0, 10_000))
@settings(max_examples=60, deadline=None)
def test_a_plain_leg_puts_the_ankle_where_forward_kinematics_had_it(person, seed):
    model, data, index = person
    rng = np.random.default_rng(seed)
    data.qpos[3:7] = [1.0, *rng.uniform(-0.2, 0.2, 3)]
    data.qpos[3:7] /= np.linalg.norm(data.qpos[3:7])
    wanted = {}
    for hip in HIPS:
        flexion, abduction = rng.uniform(-0.2, 0.9), rng.uniform(-0.3, 0.3)
        data.qpos[7 + hip : 13 + hip] = flexion, abduction, 0.0, rng.uniform(0.2, 0.8), 0.0, 0.0
        data.qpos[11 + hip] = rng.uniform(-0.2, 0.2)
    mujoco.mj_kinematics(model, data)
    for k, hip in enumerate(HIPS):
        feet, angles = data.xmat[index.feet[k]].reshape(3, 3).copy(), np.empty(6)
        wanted[hip] = data.qpos[7 + hip : 13 + hip].copy()
        pelvis, at = data.xmat[index.root].reshape(3, 3).copy(), data.xanchor[hip + 1].copy()
        turned = feet @ [[0.9, -0.3, 0.3], [0.3, 0.95, 0.0], [0.0, 0.0, 1.0]]  # only its rise counts
        turned[2, 0] = feet[2, 0]
        assert solve_plain_leg(pelvis, at, turned, data.xpos[index.feet[k]].copy(), 2.0 * k - 1.0, angles)
        np.testing.assert_allclose(angles, wanted[hip], atol=1e-8)
        np.testing.assert_allclose(turned, feet, atol=1e-8)
