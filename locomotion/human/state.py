"""The memory of a person: one list of fields, from which it is saved, restored, compared and hashed."""

from __future__ import annotations

import hashlib
import operator
from collections.abc import Callable, Collection, Iterator
from typing import Any, Literal, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from locomotion.body.physics import restore_physics, write_physics
from locomotion.body_events import Event
from locomotion.human.simulation import Simulation
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.paths.table import PathTable
from locomotion.skills.registry import BUSY, CLEARING

__all__ = ["BUSY", "CLEARING", "MOVING", "Gait", "HumanState", "Status", "hash_of", "restore", "same", "save"]

Status = str
"""One of `BUSY`, or of the statuses in `CLEARING`."""
Gait = Literal["walk", "run", "slow run", "scramble"]


class _Moving(Collection[Status]):
    """What a person that is on its way does; more of it after `register_skill`."""

    def __contains__(self, status: object) -> bool:
        return status in _ON_ITS_WAY or status in CLEARING.values()

    def __iter__(self) -> Iterator[Status]:
        return iter((*_ON_ITS_WAY, *CLEARING.values()))

    def __len__(self) -> int:
        return len(_ON_ITS_WAY) + len(CLEARING)

    def __repr__(self) -> str:
        return f"<{', '.join(self)}>"


_ON_ITS_WAY = ("walking", "running", "scrambling", "getting up")
MOVING: Collection[Status] = _Moving()
"""What a person that is on its way does: what `CLEARING` lists, too."""


class HumanState(NamedTuple):
    """The complete memory of a `Human`; restoring it continues the run bit-identically on the same ground.
    Its `bravery` is a setting, and no part of it.

    ``numbers``: the arrays of its parts, then those of `save_physics`; a single array, since one is kept and
    compared in every predicted tick. ``events``: reported but not yet polled. ``foresight``: see
    `locomotion.rehearsal.lookahead.Lookahead.memory`.
    """

    numbers: NDArray[np.float64]
    slowing: float
    speed: float
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
    pushed_until: int
    habit: float
    events: tuple[Event, ...]
    foresight: tuple[int, int] = (0, 0)


def _same_path(one: PathTable | None, other: PathTable | None) -> bool:
    return one is other or (one is not None and other is not None and np.array_equal(one.table, other.table))


def _same_memory(one: NDArray | None, other: NDArray | None) -> bool:
    return one is other or (one is not None and other is not None and one.tobytes() == other.tobytes())


class _Field(NamedTuple):
    """A field of `HumanState` apart from numbers, events and foresight: the part of the person and its
    attribute ("": of the person itself), and whether two values continue in the same way."""

    name: str
    part: str
    attribute: str
    same: Callable[[Any, Any], bool] = operator.eq


_ARRAYS = operator.attrgetter(
    "simulation.control",
    "command",
    "on_feet.walk",
    "on_feet.learned_memory",
    "on_feet.residual.memory",
    "on_feet.landing.memory",
    "follower.memory",
    "fours.memory",
    "run_up.plan",
)
# memory arrays of the person's parts
_FIELDS = (
    _Field("slowing", "on_feet", "slowing"),
    _Field("speed", "on_feet", "speed"),
    _Field("brakes", "on_feet", "brakes"),
    _Field("hurries", "on_feet", "hurries"),
    _Field("on_all_fours", "fours", "mood"),
    _Field("path", "follower", "path", _same_path),
    _Field("interrupted", "follower", "interrupted", _same_path),
    _Field("back_to", "follower", "back_to"),
    _Field("obstacles", "run_up", "obstacles", operator.is_),
    _Field("skill", "run_up", "at_work", _same_memory),
    _Field("status", "", "status"),
    _Field("ticks", "", "ticks"),
    _Field("ended_at", "", "ended_at"),
    _Field("pushed_until", "", "pushed_until"),
    _Field("habit", "", "habit"),
)
_SKILL = [field.name for field in _FIELDS].index("skill")  # the only one that changes in place
_VALUES = operator.attrgetter(
    *(f"{field.part}.{field.attribute}" if field.part else field.attribute for field in _FIELDS)
)


class _Person(Protocol):
    simulation: Simulation
    events: list[Event]


def save(person: _Person) -> HumanState:
    """Everything that ``person`` needs to continue from here."""
    body, arrays = person.simulation, _ARRAYS(person)
    end = sum(map(len, arrays))
    numbers = np.empty(end + body.physics_size)
    np.concatenate(arrays, out=numbers[:end])
    write_physics(body.model, body.data, numbers[end:])
    values = list(_VALUES(person))
    if values[_SKILL] is not None:
        values[_SKILL] = values[_SKILL].copy()
    return HumanState._make((numbers, *values, tuple(person.events), (0, 0)))


def restore(person: _Person, state: HumanState) -> None:
    """Restore ``person`` to ``state``. Raises `LocomotionError`, and changes nothing, if it belongs to
    another model."""
    body, arrays, end = person.simulation, _ARRAYS(person), 0
    restore_physics(body.model, body.data, state.numbers[sum(map(len, arrays)) :])
    for array in arrays:
        begin, end = end, end + len(array)
        array[:] = state.numbers[begin:end]
    for field in _FIELDS:
        value = getattr(state, field.name)
        part = getattr(person, field.part) if field.part else person
        setattr(part, field.attribute, value.copy() if isinstance(value, np.ndarray) else value)
    person.events[:] = state.events


def same(one: HumanState, other: HumanState) -> bool:
    """Whether two states continue in the same way; past events and foresight do not matter."""
    for field, its, others in zip(_FIELDS, one[1:], other[1:], strict=False):  # events and foresight are last
        if not field.same(its, others):
            return False
    return one.numbers.tobytes() == other.numbers.tobytes()


def hash_of(state: HumanState) -> str:
    """Hex digest of a state; equal states, equal digests."""
    hasher = hashlib.sha256(state.numbers.tobytes())
    for field in _FIELDS:
        value = getattr(state, field.name)
        if isinstance(value, PathTable):
            value = value.table
        hasher.update(value.tobytes() if isinstance(value, np.ndarray) else repr(value).encode())
    return hasher.hexdigest()[:16]
