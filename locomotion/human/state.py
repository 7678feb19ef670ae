"""What a simulated person is made of at one moment, to be kept, restored and compared."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from typing import Literal, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.errors import LocomotionError
from locomotion.events import Event
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.paths.table import PathTable

__all__ = [
    "CLEARING",
    "MOVING",
    "Gait",
    "HumanState",
    "Status",
    "hash_of",
    "restore_physics",
    "same",
    "save_physics",
]

Status = Literal[
    "standing", "walking", "running", "jumping", "vaulting", "dropping", "leaping", "scrambling",
    "getting up", "fallen", "arrived", "lost", "stuck",
]  # fmt: skip
Gait = Literal["walk", "run", "slow run", "scramble"]
CLEARING: dict[str, Status] = {
    "jump": "jumping", "vault": "vaulting", "drop": "dropping", "gap": "leaping",
}  # fmt: skip
"""What a person does that clears an obstacle of an affordance."""
MOVING: tuple[Status, ...] = (
    "walking", "running", *dict.fromkeys(CLEARING.values()), "scrambling", "getting up",
)  # fmt: skip
"""What a person that is on its way does."""

_STATE = mujoco.mjtState.mjSTATE_INTEGRATION


class HumanState(NamedTuple):
    """Everything that a `Human` remembers; restoring it continues the run bit for bit on the same ground.
    ``numbers``: what its parts remember (`MovingPerson.memories`), and behind that what `save_physics` gives;
    in one array, since one is kept and compared in every foreseen tick."""

    numbers: NDArray[np.float64]
    slowing: float
    brakes: bool
    hurries: bool
    on_all_fours: tuple[float, float, float]
    path: PathTable | None
    interrupted: PathTable | None
    back_to: float
    obstacles: tuple[ObstacleAhead, ...]
    skill: NDArray[np.float64] | None
    status: Status
    ticks: int
    ended_at: int
    events: tuple[Event, ...]


def same(one: HumanState, other: HumanState) -> bool:
    """Whether two states go on in the same way; what has happened before does not matter."""

    def rest(state: HumanState) -> tuple:
        way = state.interrupted is None, state.back_to, id(state.obstacles)
        skill = None if state.skill is None else state.skill.tobytes()
        mood = state.slowing, state.brakes, state.hurries, state.on_all_fours
        return state.status, state.ticks, state.ended_at, *mood, *way, skill

    if rest(one) != rest(other) or one.numbers.tobytes() != other.numbers.tobytes():
        return False
    paths = (one.path, other.path), (one.interrupted, other.interrupted)
    return all(a is b or (a and b and np.array_equal(a.table, b.table)) for a, b in paths)


def save_physics(model: mujoco.MjModel, data: mujoco.MjData) -> NDArray[np.float64]:
    """All that the next physics step depends on, (k,) float64."""
    state = np.empty(mujoco.mj_stateSize(model, _STATE))
    mujoco.mj_getState(model, data, state, _STATE)
    return state


def restore_physics(model: mujoco.MjModel, data: mujoco.MjData, physics: NDArray[np.float64]) -> None:
    """Go back to what `save_physics` gave; raises `LocomotionError` when it was of another model."""
    if len(physics) != mujoco.mj_stateSize(model, _STATE):
        raise LocomotionError("the saved state belongs to another model")
    mujoco.mj_setState(model, data, physics, _STATE)


def hash_of(status: Status, parts: Iterable[NDArray[np.float64]]) -> str:
    """Hex digest of a status and arrays; equal for equal ones."""
    hasher = hashlib.sha256(status.encode())
    for part in parts:
        hasher.update(part.tobytes())
    return hasher.hexdigest()[:16]
