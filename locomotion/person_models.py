"""The compiled person on a ground, made once for all persons there."""

from __future__ import annotations

import threading
import weakref

import mujoco

from locomotion.ground import Ground
from locomotion.person import PersonIndex, build_person

__all__ = ["person_on"]

_models: weakref.WeakKeyDictionary[Ground, tuple[mujoco.MjModel, PersonIndex]] = weakref.WeakKeyDictionary()
_plane: list[tuple[mujoco.MjModel, PersonIndex]] = []
_lock = threading.Lock()


def person_on(ground: Ground | None) -> tuple[mujoco.MjModel, PersonIndex]:
    """The compiled person on ``ground``, None: on the endless plane z = 0."""
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
