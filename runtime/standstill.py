"""Agents that get nowhere: when they say so, and what they do about it.

`Headway` is what an agent remembers of it: whoever has made none for `PATIENCE` says so (`runtime.Hindered`),
whatever the reason, and again as long as nothing else happens to it. Those that wait for each other for ever
are untangled: one goes back to let the others by, and if that does not help either, they are stuck.
"""

from dataclasses import dataclass, replace

import numpy as np

from locomotion.gathering import ROOM
from runtime.moment import Moment

__all__ = ["ANOTHER_WAY", "GIVEN_UP", "PATIENCE", "STANDSTILL", "Headway", "untangle"]

PATIENCE = 10.0
"""[s] without headway, and without an event, after which an agent says so."""
ANOTHER_WAY = 25.0
"""[s] without headway after which an agent that does not wait for others does something else."""
_STEP = 0.25  # [m] nearer to its goal that count as headway

STANDSTILL = 8.0
"""[s] for which all who wait for each other have made no headway when one of them goes back."""
GIVEN_UP = 30.0
"""[s] after which they are stuck."""
_MOVES = 0.2  # [m/s] of one that does not follow a path


@dataclass(frozen=True)
class Headway:
    """``left``: [m] the least that was left of its way; ``since``: [s] of the world, when that was; ``told``:
    when something was last told of the agent; ``tried``: when it last did something else."""

    left: float = np.inf
    since: float = 0.0
    told: float = 0.0
    tried: float = 0.0

    def seen(self, left: float, now: float) -> "Headway":
        """As it is ``now``, with so much ``left``."""
        return replace(self, left=left, since=now) if left < self.left - _STEP else self

    def late(self, now: float) -> bool:
        """Whether it is time to say that it gets nowhere."""
        return now - max(self.since, self.told) >= PATIENCE - 1e-9

    def desperate(self, now: float) -> bool:
        """Whether it is time to do something else."""
        return now - max(self.since, self.tried) >= ANOTHER_WAY - 1e-9


def untangle(moment: Moment, index: int) -> None:
    """Let a follower that has waited for `STANDSTILL` do something about it: go back if it is the first that
    can of those who wait for each other, and be stuck if nobody can. One that waits for somebody who gets on,
    as in a queue, goes on waiting."""
    knot, waited = _knot(moment, index)
    if waited < STANDSTILL:
        return
    first = next((each for each in knot if _has_room(moment, each)), None)
    if first == index:
        moment.followers[index].make_room()
        moment.forget(index)
    elif first is None and waited >= GIVEN_UP:
        moment.followers[index].give_up()
        moment.forget(index)


def _knot(moment: Moment, index: int) -> tuple[list[int], float]:
    """The followers that wait for each other, of whom ``index`` is one, in order; and for how many seconds
    nobody among them has got on."""
    knot, new, least = {index}, [index], np.inf
    while new:
        found = np.flatnonzero(moment.near(np.array(new)).any(axis=0)).tolist()
        new = []
        for each in found:
            if each >= len(moment.followers):
                if np.hypot(*moment.discs[each][0, 3:5]) > _MOVES:
                    return sorted(knot), 0.0
            elif each not in knot:
                waited = moment.followers[each].waited
                if waited is not None:
                    knot.add(each)
                    new.append(each)
        least = min([least, *(moment.followers[each].waited or 0.0 for each in knot)])
        if least < STANDSTILL:
            break
    return sorted(knot), float(least)


def _has_room(moment: Moment, index: int) -> bool:
    """Whether a follower can go back, and nobody is in its way there."""
    room = moment.followers[index].room()
    if room is None:
        return False
    others, radius = moment.others(index), float(moment.discs[index][0, 5])
    away = np.linalg.norm(room[:, None, :2] - others[None, :, :2], axis=2)
    near = away < others[:, 5] + radius + ROOM
    return not bool((near & (away < away[:1])).any())
