"""Save and restore everything that the next physics step depends on."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.errors import LocomotionError

__all__ = ["PHYSICS", "physics_size", "restore_physics", "save_physics", "write_physics"]

PHYSICS = mujoco.mjtState.mjSTATE_INTEGRATION
"""The parts of MuJoCo's state to save."""


def physics_size(model: mujoco.MjModel) -> int:
    """Count of numbers in a saved state."""
    return mujoco.mj_stateSize(model, PHYSICS)


def save_physics(model: mujoco.MjModel, data: mujoco.MjData) -> NDArray[np.float64]:
    """The state of ``data``, (k,) float64."""
    state = np.empty(physics_size(model))
    write_physics(model, data, state)
    return state


def write_physics(model: mujoco.MjModel, data: mujoco.MjData, state: NDArray[np.float64]) -> None:
    """Write the state of ``data`` into ``state`` (k,)."""
    mujoco.mj_getState(model, data, state, PHYSICS)


def restore_physics(model: mujoco.MjModel, data: mujoco.MjData, physics: NDArray[np.float64]) -> None:
    """Restore a state of `save_physics`. Raises `LocomotionError` if it belongs to another model."""
    if len(physics) != physics_size(model):
        raise LocomotionError("the saved state belongs to another model")
    mujoco.mj_setState(model, data, physics, PHYSICS)
