"""A saved state of the physics goes on bit for bit."""

import mujoco
import numpy as np
import pytest

from locomotion.body.person import build_person
from locomotion.body.physics import physics_size, restore_physics, save_physics
from locomotion.errors import LocomotionError


def test_a_restored_body_moves_on_bit_for_bit():
    model = build_person()
    data, twin = mujoco.MjData(model), mujoco.MjData(model)
    data.qvel[:] = np.random.default_rng(0).normal(size=model.nv)
    data.ctrl[:] = 0.1
    mujoco.mj_step(model, data, 60)  # in contact: the solver begins with the forces of the last step
    saved = save_physics(model, data)
    assert saved.shape == (physics_size(model),) and saved.dtype == np.float64
    mujoco.mj_step(model, data, 40)
    restore_physics(model, twin, saved)
    mujoco.mj_step(model, twin, 40)
    assert data.ncon > 0
    assert twin.qpos.tobytes() == data.qpos.tobytes() and twin.time == data.time


@pytest.mark.parametrize("cut", [0, 1])
def test_the_state_of_another_model_is_refused_and_changes_nothing(cut):
    model = build_person()
    data = mujoco.MjData(model)
    before = save_physics(model, data)
    other = before[cut:-1] if cut else np.append(before, 0.0)
    with pytest.raises(LocomotionError, match="belongs to another model"):
        restore_physics(model, data, other)
    assert np.array_equal(save_physics(model, data), before)
