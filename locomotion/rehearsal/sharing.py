"""What several people may rehearse in one tick."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from locomotion.rehearsal.lookahead import PER_TICK

__all__ = ["REHEARSAL_TICKS", "allot"]

REHEARSAL_TICKS = 20
"""Default for the ticks that all people of a world rehearse in each of its own."""


class _Rehearses(Protocol):
    ticks: int

    @property
    def foresees(self) -> int | None: ...
    @property
    def needs(self) -> int: ...


def allot(people: Sequence[_Rehearses], ticks: int) -> list[int]:
    """How many of ``ticks`` each of ``people`` may rehearse: those first who have to decide soonest,
    `PER_TICK` each at most. Who cannot have its answer in time beside them rehearses nothing. Among equals
    the first is another one in each tick, so nobody goes short."""
    turn = people[0].ticks if people else 0
    waiting = [
        (ahead, (number - turn) % len(people), number)
        for number, each in enumerate(people)
        if (ahead := each.foresees) is not None
    ]
    allotted, left, promised = [0] * len(people), ticks, 0
    for ahead, _, number in sorted(waiting):
        needs = people[number].needs
        if needs > min(PER_TICK * ahead, ticks * ahead - promised):
            continue
        promised += needs
        allotted[number] = min(left, PER_TICK)
        left -= allotted[number]
    return allotted
