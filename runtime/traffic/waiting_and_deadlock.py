"""Agents without progress: when they report it, and what they do about it.

`Headway` is an agent's record: after `PATIENCE` without progress it reports `runtime.Hindered`, whatever the
reason, and repeats that as long as nothing else happens to it. Deadlocks are resolved: one agent goes back to
let the others pass; if that does not help, they are stuck.
"""

from dataclasses import dataclass

import numpy as np

from locomotion.avoidance.goal_occupancy import ROOM
from locomotion.avoidance.yielding import SPACING
from navmesh import NodeGraph
from runtime.traffic.snapshot import Snapshot

__all__ = ["ANOTHER_WAY", "GIVEN_UP", "PATIENCE", "STANDSTILL", "Headway", "untangle"]

PATIENCE = 10.0
"""[s] without progress and without an event after which an agent reports it."""
ANOTHER_WAY = 25.0
"""[s] without progress after which an agent that does not wait for others tries something else."""
_STEP = 0.25  # [m] nearer to its goal that count as progress

STANDSTILL = 8.0
"""[s] without progress of all agents in a deadlock after which one goes back."""
GIVEN_UP = 30.0
"""[s] after which they are stuck."""
_FURTHER = 1.0  # [m] that it goes back farther if there is room, so that the others have room
_MOVES = 0.2  # [m/s] of an agent that follows no path


@dataclass(frozen=True)
class Headway:
    """``left``: [m] least length left of its path so far; ``since``: [s] world time of that; ``told``: time
    of the agent's last event; ``tried``: when it last tried something else."""

    left: float = np.inf
    since: float = 0.0
    told: float = 0.0
    tried: float = 0.0

    def seen(self, left: float, now: float) -> "Headway":
        """The record as of ``now``, with ``left`` [m] to go."""
        return Headway(left, now, self.told, self.tried) if left < self.left - _STEP else self

    def late(self, now: float) -> bool:
        """Whether to report that it makes no progress."""
        return now - max(self.since, self.told) >= PATIENCE - 1e-9

    def desperate(self, now: float) -> bool:
        """Whether to try something else."""
        return now - max(self.since, self.tried) >= ANOTHER_WAY - 1e-9


def untangle(snapshot: Snapshot, index: int, graph: NodeGraph) -> None:
    """Resolve the deadlock of a follower that has waited for `STANDSTILL`.

    It goes back if, of those in the deadlock, it has the least to go to a place where it lets the others
    pass; if nobody has such a place it is stuck. If it waits for somebody who moves, as in a queue, it keeps
    waiting.
    """
    knot, waited = _knot(snapshot, index)
    if waited < STANDSTILL:
        return
    ways = {each: far for each in knot if (far := _has_room(snapshot, each, knot, graph)) is not None}
    first = min(ways, key=lambda each: (ways[each], each), default=None)
    if first == index:
        snapshot.followers[index].make_room(ways[index])
        snapshot.forget(index)
    elif first is None and waited >= GIVEN_UP:
        snapshot.followers[index].give_up()
        snapshot.forget(index)


def _knot(snapshot: Snapshot, index: int) -> tuple[list[int], float]:
    """The followers that wait for each other, including ``index``, in order; and for how many seconds none of
    them has made progress."""
    knot, new, least = {index}, [index], np.inf
    while new:
        found = np.flatnonzero(snapshot.near(np.array(new)).any(axis=0)).tolist()
        new = []
        for each in found:
            if each >= len(snapshot.followers):
                if np.hypot(*snapshot.discs[each][0, 3:5]) > _MOVES:
                    return sorted(knot), 0.0
            elif each not in knot:
                waited = snapshot.followers[each].waited
                if waited is not None:
                    knot.add(each)
                    new.append(each)
        least = min([least, *(snapshot.followers[each].waited or 0.0 for each in knot)])
        if least < STANDSTILL:
            break
    return sorted(knot), float(least)


def _has_room(snapshot: Snapshot, index: int, knot: list[int], graph: NodeGraph) -> float | None:
    """[m] that a follower has to go back to let the others of a ``knot`` pass; None if it reaches no such
    place, or somebody is in its way."""
    follower = snapshot.followers[index]
    back = follower.way_back()
    if back is None:
        return None
    radius = float(snapshot.discs[index][0, 5])
    lets_by = _lets_by(snapshot, index, back, knot, graph)
    least, body = round(follower.backs / SPACING), round(follower.length / SPACING)
    # all of a long body has to be out of the way
    whole = np.array([lets_by[max(k - body, 0) : k + 1].all() for k in range(len(back))])
    places = np.flatnonzero(whole)
    if not len(places):
        return None
    enough = places[places >= min(least, places[-1])]
    further = enough[enough <= enough[0] + round(_FURTHER / SPACING)][-1]
    room = back[: further + 1]
    others = snapshot.others(index)
    away = np.linalg.norm(room[:, None, :2] - others[None, :, :2], axis=2)
    near = away < others[:, 5] + radius + ROOM
    return None if bool((near & (away < away[:1])).any()) else float(SPACING * further)


def _lets_by(
    snapshot: Snapshot, index: int, back: np.ndarray, knot: list[int], graph: NodeGraph
) -> np.ndarray:
    """(k,) bool: at which points of its way ``back`` (k, 3) a follower would let the others of a ``knot``
    pass: their paths do not lead there, or there is room beside it."""
    radius = float(snapshot.discs[index][0, 5])
    others = [each for each in knot if each != index]
    widest = max((float(snapshot.discs[each][0, 5]) for each in others), default=radius)
    beside = np.asarray(graph.clearance_at(back)) >= radius + 2.0 * (widest + ROOM)
    off = np.ones(len(back), dtype=bool)
    for each in others:
        course = snapshot.course(each)
        points = snapshot.discs[each][:, :2] if course is None else course.points[:, :2]
        away = np.linalg.norm(back[:, None, :2] - points[None], axis=2).min(axis=1)
        off &= away > radius + float(snapshot.discs[each][0, 5]) + ROOM
    return beside | off
