"""Ways with more room at their sides than the body's radius.

A pulled path touches every corner that it goes round. Its points are led away from the nearest place where
walking ends, as far as they come nearer to nothing else.
"""

import numpy as np
from numpy.typing import NDArray

from navmesh.graph.node_graph import NodeGraph
from navmesh.routes.route import Leg, Route, leg_of
from navmesh.routes.surface_projection import project_to_surface

__all__ = ["with_room"]

_SPACING = 0.4  # [m] between the points that are led away
_SHARES = (1.0, 0.5, 0.25)  # of what is missing, tried in turn
_GAINED = 0.6  # share of such a step that has to be gained as room
_ROUNDING = 1e-6  # [m] by which the body may touch
_REPAIRS = 4  # times that points are put back where no straight way leads from one to the next


def with_room(route: Route, leg: Leg, room: float) -> Leg:
    """A walked ``leg`` of ``route`` that keeps ``room`` [m] > 0 more from where walking ends than its body
    needs, where there is room; its ends stay."""
    graph, wanted = route.graph, route.radius + room
    points = project_to_surface(graph, leg.waypoints, _SPACING)
    led = points.copy()
    near = graph.nearest_edge(points)
    missing = wanted - near.distance
    missing[[0, -1]] = 0.0
    away = points[:, :2] - near.place
    for share in _SHARES:
        tight = np.flatnonzero((missing > _ROUNDING) & (near.distance > _ROUNDING))
        if not len(tight):
            break
        step = share * missing[tight]
        tried = points[tight]
        tried[:, :2] += (step / near.distance[tight])[:, None] * away[tight]
        gains = graph.clearance_at(tried) >= near.distance[tight] + _GAINED * step
        led[tight[gains]] = tried[gains]
        missing[tight[gains]] = 0.0
    return leg_of(route, _walkable(graph, led, points, route.radius))


def _walkable(
    graph: NodeGraph, led: NDArray[np.float64], points: NDArray[np.float64], radius: float
) -> NDArray[np.float64]:
    """``led`` (n, 3) [m], changed in place: where a body of ``radius`` [m] cannot walk straight from one of
    them to the next, both are put back to those of ``points`` (n, 3)."""
    for _ in range(_REPAIRS):
        moved = (led != points).any(axis=1)
        legs = np.flatnonzero(moved[:-1] | moved[1:])
        stuck = legs[~graph.cast_ray(led[legs], led[legs + 1], radius - _ROUNDING).clear]
        if not len(stuck):
            return led
        led[stuck], led[stuck + 1] = points[stuck], points[stuck + 1]
    return points
