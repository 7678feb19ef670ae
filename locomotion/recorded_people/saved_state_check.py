"""Check saved states of recorded persons, beyond what is checked of their bodies."""

from __future__ import annotations

import math
from collections.abc import Collection

from locomotion.body.traits import TRAITS
from locomotion.errors import LocomotionError
from locomotion.postures.playback import Playback
from locomotion.postures.posture_graph import PostureGraph
from locomotion.recorded.skeletons import LEVELS
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.people import BODY_TICKS
from locomotion.recorded_people.person_state import Errand, PersonState
from locomotion.saved_arrays import COUNT, FLAG, Slots, check_array, check_number

__all__ = ["check_recorded"]


def check_recorded(state: PersonState, graph: PostureGraph, gaits: int, skills: Collection[str]) -> None:
    """Raise `LocomotionError` if no person with the postures of ``graph``, so many ``gaits``, and ``skills``
    can have this ``state``."""
    Slots(
        "the row of a recorded person",
        at.ROW,
        [
            (at.GAIT, (-1.0, gaits - 1.0)),
            (at.PHASE, (0.0, 1.0)),
            (at.SPEED, (-100.0, 100.0)),
            (at.LEVEL, (0.0, len(LEVELS) - 1.0)),
            (at.NODE, (0.0, len(graph.postures) - 1.0)),
            (at.BUSY, FLAG),
            (at.AGE, COUNT),
            (at.SINCE, (0.0, BODY_TICKS - 1.0)),
            (at.FADE_BEGUN, COUNT),
            (at.FADE_SECONDS, (0.0, 10.0)),
            (at.LAID, FLAG),
            (at.STILL, FLAG),
            (at.CROSSES, (at.NOTHING, at.CLEARS)),
            (at.HASTE, (0.1, 10.0)),
            (at.LATE, (0.0, 0.1)),
            *((at.TRAITS.start + k, limits[1:]) for k, limits in enumerate(TRAITS.values())),
        ],
        whole=(at.GAIT, at.LEVEL, at.NODE, at.BUSY, at.AGE, at.SINCE, at.LAID, at.STILL, at.CROSSES),
    ).check(state.row)
    if state.wanted and state.wanted not in graph.postures:
        raise LocomotionError(
            f"a recorded person wants {state.wanted!r}, which is no posture of {graph.name}"
        )
    check_number("the turn of a recorded person", state.turn, 0.0, 1.0)
    playing, errand = state.playback, state.errand
    if playing is not None:
        _check_playback(playing, graph)
    if (playing is not None or state.wanted != "") != (state.row[at.BUSY] > 0.0):
        raise LocomotionError("a recorded person is busy with its posture or not, but not both")
    _check_crossing(state, skills)
    if errand is not None and not _makes_sense(errand):
        raise LocomotionError("a recorded person has been told to go where nobody can")


def _check_playback(playing: Playback, graph: PostureGraph) -> None:
    count, arcs = len(graph.postures), len(graph.start)
    check_array("the place of a posture", playing.place, 3)
    if not (0 <= playing.posture < count and 0 <= playing.target < count and -1 <= playing.arc < arcs):
        raise LocomotionError(f"a recorded person plays an arc that {graph.name} does not have")
    if playing.arc >= 0 and graph.end[playing.arc] != playing.posture:
        raise LocomotionError("a recorded person is on an arc that does not lead to its posture")
    if not math.isfinite(playing.begun) or playing.last is not None:
        raise LocomotionError("a recorded person plays what began at no time")


def _check_crossing(state: PersonState, skills: Collection[str]) -> None:
    of, does = state.crossing, state.row[at.CROSSES]
    if (of is not None) != (does > at.NOTHING):
        raise LocomotionError("a recorded person crosses an obstacle or not, but not both")
    if of is None:
        return
    numbers = [
        of.size, of.depth, of.speed, of.facing or 0.0, of.beyond, of.waited, *of.start, *of.edge, *of.end,
        *of.origin, *(each for goal in of.goals for each in goal),
    ]  # fmt: skip
    if of.affordance not in skills or not all(map(math.isfinite, numbers)) or not of.size > 0.0 < of.speed:
        raise LocomotionError("a recorded person crosses an obstacle that nobody can")
    apart = math.dist(of.start[:2], of.edge[:2]), math.dist(of.start[:2], of.end[:2])
    if min(apart) < 1e-3 or math.isnan(of.last) or (does > at.APPROACHES) != of.under_way:
        raise LocomotionError("a recorded person crosses an obstacle in a way that nobody can")
    if of.begun < 0.0:
        raise LocomotionError("a recorded person crosses an obstacle at no time")


def _makes_sense(errand: Errand) -> bool:
    numbers = [*(each for goal in errand.goals for each in goal), errand.speed, errand.facing or 0.0]
    return bool(errand.goals) and all(map(math.isfinite, numbers)) and errand.speed > 0.0
