"""Grounds share one process with each other, with planes and with height fields."""

import gc

import mujoco
import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.ground.ground import Ground
from tests.locomotion.ground.collider.shapes import CAPSULE, SPHERE, floor, scene


def test_several_grounds_and_planes_and_height_fields_in_one_process():
    low, high = Ground.from_arrays(*floor()), Ground.from_arrays(*floor(height=lambda x, y: 0 * x + 2.0))
    worlds = [scene(g, SPHERE, [0.1, 0, 0], [0, 0, 3.0]) for g in (low, high, None)]
    worlds.append(scene_with_height_field())
    for _ in range(1000):
        for model, data in worlds:
            mujoco.mj_step(model, data)
    np.testing.assert_allclose([d.qpos[2] for _, d in worlds], [0.1, 2.1, 0.1, 0.1], atol=0.003)
    low.check(worlds[0][0])
    with pytest.raises(LocomotionError, match="another ground"):
        low.check(worlds[1][0])
    with pytest.raises(LocomotionError, match="no geom called 'ground'"):
        low.check(worlds[2][0])


def scene_with_height_field():
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><option timestep='0.0025'/>"
        "<asset><hfield name='h' nrow='3' ncol='3' size='5 5 1 1'/></asset>"
        "<worldbody><geom type='hfield' hfield='h'/><body pos='0 0 3'><freejoint/><geom size='.1'/></body>"
        "</worldbody></mujoco>"
    )
    return model, mujoco.MjData(model)


def test_a_released_ground_touches_nothing_even_when_its_slot_is_used_again():
    ground = Ground.from_arrays(*floor())
    model, data = scene(ground, SPHERE, [0.1, 0, 0], [0, 0, 0.09])
    mujoco.mj_forward(model, data)
    assert data.ncon == 1
    del ground
    gc.collect()
    mujoco.mj_forward(model, data)
    assert data.ncon == 0
    again = Ground.from_arrays(*floor(height=lambda x, y: 0 * x + 1.0))
    mujoco.mj_forward(model, data)
    assert data.ncon == 0
    assert again.digest


def test_batch_of_two_threads_equals_single_runs():
    ground = Ground.from_arrays(*floor(5.0, 9, lambda x, y: 0.1 * np.sin(3 * x)))
    model, data = scene(ground, CAPSULE, [0.05, 0.15, 0], [0, 0, 0.4])
    starts = []
    for i in range(6):
        mujoco.mj_resetData(model, data)
        data.qvel[:] = np.sin(np.arange(6) + i)
        state = np.zeros(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_INTEGRATION))
        mujoco.mj_getState(model, data, state, mujoco.mjtState.mjSTATE_INTEGRATION)
        starts.append(state)
    single = []
    for state in starts:
        mujoco.mj_setState(model, data, state, mujoco.mjtState.mjSTATE_INTEGRATION)
        mujoco.mj_step(model, data, 300)
        single.append(data.qpos.copy())
    from mujoco import rollout

    pair = [mujoco.MjData(model), mujoco.MjData(model)]
    full = np.zeros((6, mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)))
    for i, state in enumerate(starts):
        mujoco.mj_setState(model, data, state, mujoco.mjtState.mjSTATE_INTEGRATION)
        mujoco.mj_getState(model, data, full[i], mujoco.mjtState.mjSTATE_FULLPHYSICS)
    states, _ = rollout.rollout(model, pair, full, nstep=300)
    np.testing.assert_array_equal(states[:, -1, 1:8], np.array(single))
