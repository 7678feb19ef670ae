"""Whether a way that was found on one graph can still be gone on another, after the level has changed."""

from typing import TYPE_CHECKING

import numpy as np

from navmesh.graph.spatial_queries import cast_ray, project
from navmesh.zones.leaps import link_room

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph
    from navmesh.routes.route import Route

__all__ = ["line_holds", "route_holds"]

_SLACK = 2e-3  # [m] by which a body may be wider than the way: routes touch corners to rounding
_SAME = 1e-3  # [m] by which a link's ends and height may differ


def line_holds(graph: "NodeGraph", points: np.ndarray, radius: float) -> bool:
    """Whether a body of ``radius`` [m] can walk straight from each of ``points`` (k, 3) [m] to the next on
    ``graph``, each on a floor at its height to within a step."""
    points = np.asarray(points, dtype=np.float64)
    if len(points) == 0:
        return False
    step = graph.rules.max_step
    cell, floor = project(graph, points)
    if (cell < 0).any() or (np.abs(floor - points[:, 2]) > step).any():
        return False
    if len(points) == 1:
        return True
    ray = cast_ray(graph, points[:-1], points[1:], max(radius - _SLACK, 0.0))
    return bool(ray.clear.all() and (np.abs(ray.end[:, 2] - points[1:, 2]) <= step).all())


def route_holds(route: "Route", graph: "NodeGraph") -> bool:
    """Whether ``route`` can be gone on ``graph``: its walked parts, and the links between them, which must
    lead from the same place to the same place over the same height."""
    bounds = [0]
    for use in route.links:
        bounds += [use.first, use.last]
    bounds.append(len(route.waypoints) - 1)
    if any(
        not line_holds(graph, route.waypoints[first : last + 1], route.radius)
        for first, last in zip(bounds[::2], bounds[1::2], strict=True)
    ):
        return False
    old, new = route.graph.links, graph.links
    room = link_room(graph)
    for use in route.links:
        k = use.link
        alike = (new.affordance == old.affordance[k]) & (room >= route.radius - _SLACK)
        alike &= np.abs(new.height - old.height[k]) <= _SAME
        alike &= (np.abs(new.start - old.start[k]) <= _SAME).all(axis=1)
        alike &= (np.abs(new.end - old.end[k]) <= _SAME).all(axis=1)
        if not alike.any():
            return False
    return True
