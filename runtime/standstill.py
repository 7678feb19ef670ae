"""Bodies that wait for each other for ever: one goes back to let the others by, and if that does not help
either, they are stuck."""

import numpy as np

from locomotion.gathering import ROOM
from runtime.moment import Moment

__all__ = ["GIVEN_UP", "STANDSTILL", "untangle"]

STANDSTILL = 8.0
"""[s] for which all who wait for each other have made no headway when one of them goes back."""
GIVEN_UP = 30.0
"""[s] after which they are stuck."""
_MOVES = 0.2  # [m/s] of one that does not follow a path


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
