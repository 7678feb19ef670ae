"""Ways to goals: what an animal asks of a planner, and the trail made of the answer."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from locomotion.ground.ground import Ground
from locomotion.quadruped.body import Body
from locomotion.quadruped.body_on_path import wrap
from locomotion.quadruped.footprint import check_places, trail_arcs, trail_place
from locomotion.quadruped.script import Place
from locomotion.quadruped.trail import Trail, lay_trail

__all__ = ["Planner", "Way", "find_way", "first_heading", "last_free_arc", "turn_onto"]


class Way(Protocol):
    """A planner's path; the animal reads its points and keeps the rest for its users."""

    @property
    def points(self) -> NDArray[np.float64]:
        """(k, 3) [m] the smoothed path."""
        ...


class Planner(Protocol):
    """A planner: `way` for paths, `leads` for whether there is one, `room_to_turn` for places."""

    def way(
        self, start: NDArray[np.float64], goal: NDArray[np.float64], direction: NDArray[np.float64]
    ) -> Way:
        """The way from ``start`` to ``goal`` (3,) [m] for one that moves or faces in ``direction`` (2,).
        Raises ValueError if there is none."""
        ...

    def leads(self, start: NDArray[np.float64], goal: NDArray[np.float64]) -> bool:
        """Whether there is a `way` from ``start`` to ``goal`` (3,) [m]."""
        ...

    def room_to_turn(self, points: NDArray[np.float64], length: float) -> NDArray[np.bool_]:
        """(k,) whether a body of ``length`` [m] has room to turn round at ``points`` (k, 3)."""
        ...


def find_way(
    planner: Planner,
    body: Body,
    ground: Ground,
    goals: Sequence[tuple[float, float, float]],
    place: Place,
) -> tuple[Trail, tuple[Way, ...]]:
    """The trail for one that stands or moves at ``place``, through as many ``goals`` [m] as it can reach
    without turning back, and the ways that it is made of, one per goal. Raises ValueError if there is
    none.
    """
    here = np.array([place.x, place.y, place.z])
    ahead = np.array([math.cos(place.yaw), math.sin(place.yaw)])
    ways: list[Way] = []
    for goal in goals:
        try:
            way = planner.way(here, np.array(goal), ahead)
        except ValueError:
            if not ways:
                raise
            break
        if ways and _turn_between(ways[-1].points, way.points, body.spine.length) > body.spine_reach:
            break
        ways.append(way)
        here, ahead = way.points[-1], (way.points[-1] - way.points[-2])[:2]
    return lay_trail(np.concatenate([way.points for way in ways]), body, ground), tuple(ways)


def _turn_between(before: NDArray[np.float64], after: NDArray[np.float64], length: float) -> float:
    """[rad] from the end of one path to the beginning of the next, each over ``length`` [m]."""
    out, on = before[-1] - _along(before[::-1], length), _along(after, length) - after[0]
    return abs(float(wrap(math.atan2(on[1], on[0]) - math.atan2(out[1], out[0]))))


def _along(points: NDArray[np.float64], length: float) -> NDArray[np.float64]:
    """The first of ``points`` (k, 3) that is ``length`` [m] or more from their beginning, or the last."""
    arc = np.cumsum(np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1))
    return points[min(int(np.searchsorted(arc, length)) + 1, len(points) - 1)]


def turn_onto(trail: Trail, body: Body, place: Place) -> float:
    """[rad] from the direction that one at ``place`` faces to where its front belongs on the trail."""
    x, y = trail.point(body.spine.length)
    return float(wrap(math.atan2(y - place.y, x - place.x) - place.yaw))


def first_heading(trail: Trail, body: Body) -> float:
    """[rad] from a trail's first point to where the front will be."""
    x, y = trail.point(body.spine.length) - trail.point(0.0)
    return math.atan2(y, x)


def last_free_arc(trail: Trail, body: Body, ground: Ground, end: float) -> float:
    """[m] where the root stops: at ``end`` [m], or before it if head or shoulders have no room there."""
    for arc in trail_arcs(end, end - min(body.length, end)).tolist():
        if check_places(trail_place(trail, body, arc)[None], body, ground).free:
            return arc
    return end
