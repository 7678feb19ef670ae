"""The compiled person, on a ground or alone, built once and shared."""

from __future__ import annotations

import copy
import threading
import weakref
from functools import cache

import mujoco
import numpy as np

from locomotion.body.person import PersonIndex, build_person, person_spec
from locomotion.ground.ground import FRICTION, Ground

__all__ = ["figure", "gentler", "harder", "person_on"]

_SUDDEN = 0.01  # [s] time constant of contacts with a falling body, half of MuJoCo's default
_models: weakref.WeakKeyDictionary[Ground, tuple[mujoco.MjModel, PersonIndex]] = weakref.WeakKeyDictionary()
_plane: list[tuple[mujoco.MjModel, PersonIndex]] = []
_hard: weakref.WeakKeyDictionary[mujoco.MjModel, mujoco.MjModel] = weakref.WeakKeyDictionary()
_gentle: weakref.WeakKeyDictionary[mujoco.MjModel, mujoco.MjModel] = weakref.WeakKeyDictionary()
_lock = threading.Lock()


@cache
def figure() -> mujoco.MjModel:
    """The compiled person without a ground, for kinematics; not to be changed."""
    return person_spec().compile()


def person_on(ground: Ground | None) -> tuple[mujoco.MjModel, PersonIndex]:
    """The compiled person on ``ground``; None is the endless plane z = 0."""
    with _lock:
        found = _models.get(ground) if ground is not None else (_plane[0] if _plane else None)
        if found is None:
            model = build_person(ground)
            if ground is not None:
                ground.check(model)
            found = (model, PersonIndex.of(model))
            if ground is None:
                _plane.append(found)
            else:
                _models[ground] = found
        return found


def harder(model: mujoco.MjModel) -> mujoco.MjModel:
    """A person's ``model`` with stiffer contacts, for the same `MjData`. In the usual ones, the hands of a
    falling person, 3 cm thick, would sink in by 5 cm."""
    with _lock:
        found = _hard.get(model)
        if found is None:
            found = _hard[model] = copy.copy(model)
            found.geom_solref[:, 0] = _SUDDEN
        return found


def gentler(model: mujoco.MjModel) -> mujoco.MjModel:
    """Like `harder`, but the ground has at most the usual friction. With the higher friction of steep ground,
    hands and feet would stick to it and nobody could stand up."""
    hard = harder(model)
    with _lock:
        found = _gentle.get(model)
        if found is None:
            found = _gentle[model] = copy.copy(hard)
            ground = np.flatnonzero(found.geom_bodyid == 0)
            found.geom_friction[ground, 0] = np.minimum(found.geom_friction[ground, 0], FRICTION)
        return found
