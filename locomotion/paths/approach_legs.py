"""Straight ways up to obstacles and on behind them, longer than the graph's links.

A link leads straight over its obstacle, from at most 3 m before the edge to 1.5 m behind it, which any body
needs. A runner needs more; where there is room, the walked legs before and behind the link are changed to
join its line farther away.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navmesh.graph.node_graph import NodeGraph
from navmesh.graph.spatial_queries import cast_ray
from navmesh.routes.route import Leg, Route, leg_of
from navmesh.routes.surface_projection import project_to_surface

__all__ = ["SetLeg", "set_legs", "straight_on"]

_LEAST = 0.25  # [m] least extension of a straight end that is worth making
_ENOUGH = 5.0  # [m] of run-up with which a standing person need not go back first
_BEND = 1.5  # [m] of run-up lost to each metre sideways at its beginning
_ALIKE = 0.7  # least cosine between two directions that need no turning round
_LEADS_ON = 0.5  # cosine of the greatest turn behind a straight end that is made in a bend
_ABREAST = 0.5  # [m] beside a line within which what lies ahead is reached along it
_OFF_WALL = 0.02  # [m] kept from what ends a straight way
_SAME = 1e-3  # [m] by which the ends of a way may differ from those asked for
_TURNS_IN = 0.4  # [m] kept from what is behind a place where it turns round, since it swings out
_DETOUR = 3.0  # [m] by which the way between two straight ends may be longer than the one it replaces


@dataclass(frozen=True, eq=False)
class SetLeg:
    """A walked leg between its straight ends. ``behind``: (a, 3) [m] on the surface, straight on from the
    obstacle behind; ``ahead``: (b, 3) straight up to the next one; both empty where the leg itself begins
    or ends there. ``before``, ``after``: (2,) its directions at its ends, None: any.
    """

    leg: Leg
    behind: NDArray[np.float64]
    ahead: NDArray[np.float64]
    before: NDArray[np.float64] | None
    after: NDArray[np.float64] | None


def set_legs(
    route: Route, run_up: float, landing: float, spacing: float, start_direction: NDArray[np.float64] | None
) -> Iterator[SetLeg]:
    """The legs of ``route``, each made when its turn comes, with straight ends of ``run_up`` and ``landing``
    [m] from the edges where there is room, their points at most ``spacing`` [m] apart. ``start_direction``:
    (2,) of the body's motion, or None.
    """
    walked = route.walked()
    over = [_unit(route.waypoints[use.last] - route.waypoints[use.first]) for use in route.links]
    before = [None if start_direction is None else _unit(start_direction), *over]
    for i, (points, after) in enumerate(zip(walked, [*over, None], strict=True)):
        first, last, onward = _ends(route, points, i, before[i], after, run_up, landing)
        yield _between(route, points, first, last, spacing, before[i], onward)


def _ends(
    route: Route,
    walked: NDArray[np.float64],
    index: int,
    before: NDArray[np.float64] | None,
    after: NDArray[np.float64] | None,
    run_up: float,
    landing: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64] | None]:
    """(3,) each: where a leg with the waypoints ``walked`` may first and last bend; and its direction at the
    end: ``after``, or None if a bend would lead too near to what ends the run-up, and the body turns on the
    spot."""
    first, last = walked[0], walked[-1]
    way = (last - first)[:2]
    follows = before is not None and after is not None and float(before @ after) > _ALIKE
    begin, end = first, last
    if index > 0 and before is not None:
        onward, forward = landing - _behind_edge(route, index - 1), float(before @ way)
        if follows:
            onward = min(onward, 0.25 * forward)
        elif forward > 0.0 and abs(before[0] * way[1] - before[1] * way[0]) < _ABREAST:
            onward = min(onward, forward)
        begin = straight_on(route.graph, first, before, onward, route.radius)
    if after is not None:
        lead, forward = float(route.graph.links.run_up[route.links[index].link]), float(after @ way)
        back = run_up - lead
        aside = abs(float(after[0] * way[1] - after[1] * way[0]))
        if follows or (before is None and forward + lead - _BEND * aside >= _ENOUGH):
            back = min(back, forward if index == 0 else 0.5 * forward)
        end = straight_on(route.graph, last, -after, back, route.radius)
        if float((end - begin)[:2] @ after) < 0.0:
            end = straight_on(route.graph, last, -after, back, route.radius, _TURNS_IN)
            cramped = float(np.linalg.norm((end - last)[:2])) < back - _OFF_WALL
            after = None if cramped else after
    return begin, end, after


def _between(
    route: Route,
    walked: NDArray[np.float64],
    first: NDArray[np.float64],
    last: NDArray[np.float64],
    spacing: float,
    before: NDArray[np.float64] | None,
    after: NDArray[np.float64] | None,
) -> SetLeg:
    """The leg with the waypoints ``walked``, bending only between ``first`` and ``last`` (3,); unchanged if
    no way leads there."""
    none, begin, end = np.empty((0, 3)), walked[0], walked[-1]

    def as_it_is() -> SetLeg:
        return SetLeg(leg_of(route, walked), none, none, before, after)

    longer = float(np.linalg.norm(first - begin) + np.linalg.norm(end - last))
    if longer == 0.0:
        return as_it_is()
    way = route.graph.find_path(first, last, radius=route.radius)
    gone = float(np.linalg.norm(np.diff(walked, axis=0), axis=1).sum())
    if way.status != "complete" or len(way.waypoints) < 2 or way.length > gone + longer + _DETOUR:
        return as_it_is()
    if np.abs(way.waypoints[[0, -1]] - np.stack([first, last])).max() > _SAME:
        return as_it_is()
    onward = (way.waypoints[1] - way.waypoints[0])[:2]
    turns = before is not None and float(before @ onward) < _LEADS_ON * np.linalg.norm(onward)
    if first is not begin and turns:
        before = None  # it stops and turns there: a bend would lead farther out
    behind = (
        project_to_surface(route.graph, np.stack([begin, first]), spacing)[:-1]
        if first is not begin
        else none
    )
    ahead = project_to_surface(route.graph, np.stack([last, end]), spacing)[1:] if last is not end else none
    return SetLeg(leg_of(route, way.waypoints), behind, ahead, before, after)


def straight_on(
    graph: NodeGraph,
    start: NDArray[np.float64],
    direction: NDArray[np.float64],
    length: float,
    radius: float,
    room: float = 0.0,
) -> NDArray[np.float64]:
    """The farthest place (3,), up to ``length`` [m] straight on from ``start``, to which a body of ``radius``
    [m] can walk with ``room`` [m] left behind it; ``start`` itself if that is hardly any distance."""
    if length < _LEAST:
        return start
    far = length + room
    ray = cast_ray(graph, start[None], start[None] + np.array([*(far * direction), 0.0]), radius)
    free = length if ray.clear[0] else min(length, float(ray.share[0]) * far - max(room, _OFF_WALL))
    if free < _LEAST:
        return start
    return project_to_surface(graph, np.stack([start, start + np.array([*(free * direction), 0.0])]), free)[
        -1
    ]


def _unit(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """(2,) of length 1."""
    return direction[:2] / np.linalg.norm(direction[:2])


def _behind_edge(route: Route, index: int) -> float:
    """[m] that a link leads straight behind its obstacle."""
    use, links = route.links[index], route.graph.links
    length = float(np.linalg.norm((links.end[use.link] - links.edge[use.link])[:2]))
    return length - float(route.graph.obstacles.depth[use.obstacle])
