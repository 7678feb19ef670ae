"""What MuJoCo's own steps of simulated people take, from the states they are in."""

import time

import mujoco
import numpy as np

from locomotion import Human
from locomotion.body.models import person_on
from locomotion.body.person import STEPS_PER_TICK

__all__ = ["tick_alone", "tick_on_a_plane_instead"]

_LEVEL = 0.02  # of slope up to which a level's floor is as a plane
_scratch: dict[int, mujoco.MjData] = {}


def tick_alone(human: Human) -> float:
    """[s] of processor time of the `mj_step` of its next tick, on a copy."""
    copy = _copy_for(human.model)
    mujoco.mj_copyData(copy, human.model, human.data)
    return _timed(human.physics, copy)


def tick_on_a_plane_instead(human: Human) -> tuple[float, float] | None:
    """[s] of a tick like `tick_alone` where a running person is, and with a plane in the place of the floor
    under it; None if it does not run, or on no level floor."""
    if human.status != "running" or human.held or human.slope_here > _LEVEL:
        return None
    plane = person_on(None)[0]
    kind = mujoco.mjtState.mjSTATE_INTEGRATION
    seconds = []
    for model, lower in ((human.model, 0.0), (plane, float(human.position[2]))):
        copy, state = _copy_for(model), np.empty(mujoco.mj_stateSize(human.model, kind))
        mujoco.mj_getState(human.model, human.data, state, kind)
        mujoco.mj_setState(model, copy, state, kind)
        copy.qpos[2] -= lower
        seconds.append(_timed(model, copy))
    return seconds[0], seconds[1]


def _copy_for(model: mujoco.MjModel) -> mujoco.MjData:
    if id(model) not in _scratch:
        _scratch[id(model)] = mujoco.MjData(model)
    return _scratch[id(model)]


def _timed(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    begun = time.thread_time()
    mujoco.mj_step(model, data, STEPS_PER_TICK)
    return time.thread_time() - begun
