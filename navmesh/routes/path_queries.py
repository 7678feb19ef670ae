"""Queries for paths: from a start and a goal to a route, one at a time, in slices, or in batches.

The stages: the ends are snapped to places where the body fits (`navmesh.graph.snapping`), A* chooses the
chain of discs (`navmesh.routes.graph_search`), string pulling turns it into the line to walk
(`navmesh.routes.string_pulling`).
"""

from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache
from math import inf, isfinite
from numbers import Integral
from typing import TYPE_CHECKING, Any

import numpy as np
from numba import float64

from navmesh.areas.areas import checked_costs
from navmesh.areas.cheap_routes import AreaSearch, are_plain, priced_route
from navmesh.areas.pricing import Priced, priced_of
from navmesh.errors import NavmeshError
from navmesh.graph.kernel_arrays import DOORS, SCRATCH, make_scratch, net_of
from navmesh.graph.open_to_body import checked_radius, doors_of
from navmesh.routes.graph_search import RUNNING, advance
from navmesh.routes.query_kernels import SEARCHING, answer, answer_all, answer_search, start_search
from navmesh.routes.route import STATUSES, Route, Routes, gathered, link_uses
from navmesh.surface.net import NET
from navmesh.zones.plain import plain_graph

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["PathSearch", "find_path", "find_paths", "keep_scratch"]

_STATUSES = np.array(STATUSES)


def _changes_of(graph: "NodeGraph") -> int:
    """How often zones of the graph have been blocked or opened."""
    return 0 if graph.zone_state is None else graph.zone_state.changes


def _scratch_for(graph: "NodeGraph") -> Any:
    """Memory for one search, taken from the graph's stock; give it back with
    ``graph.cache["scratch"].append``."""
    slots = 0 if graph.zone_state is None else graph.zone_state.slots
    stock = graph.cache.setdefault("scratch", [])
    while True:
        try:
            scratch = stock.pop()
        except IndexError:  # it is empty, or another thread has just taken the last
            return make_scratch(graph)
        if scratch.slots == slots:
            return scratch


def keep_scratch(graph: "NodeGraph") -> None:
    """Have memory for a search in stock."""
    scratch = _scratch_for(graph)
    graph.cache["scratch"].append(scratch)


@cache
def _compiled_answer() -> Callable:
    """`answer` without Numba's choice by the types of the arguments, which takes longer than passing them."""
    return answer.compile((NET, DOORS, SCRATCH, float64[::1], *[float64] * 9))


def _limits(graph: "NodeGraph", radius: float, extent: Any) -> tuple[float, float, float]:
    """How far [m] an end may be moved sideways, and up or down, and how much of the latter does not count."""
    rules = graph.rules
    if extent is None:
        return 2.0 * radius + 2.0 * graph.surface.resolution, 1.5 * rules.headroom, rules.max_step
    try:
        reach, rise = map(float, extent)
    except (TypeError, ValueError):
        raise NavmeshError(f"extent: expected (horizontal, vertical) [m], not {extent!r}") from None
    if not (0.0 <= reach < inf and 0.0 <= rise < inf):
        raise NavmeshError(f"extent: expected (horizontal, vertical) [m], 0 or more, not {extent!r}")
    return reach, rise, rules.max_step


def _point(name: str, value: Any) -> tuple[float, float, float]:
    try:
        x, y, z = map(float, value.tolist() if type(value) is np.ndarray else value)
    except (TypeError, ValueError):
        raise NavmeshError(f"{name}: expected three numbers x, y, z [m], not {value!r}") from None
    if not isfinite(x + y + z):
        raise NavmeshError(f"{name}: expected finite coordinates [m], not ({x}, {y}, {z})")
    return x, y, z


def find_path(
    graph: "NodeGraph",
    start: Any,
    goal: Any,
    radius: float = 0.3,
    skills: Mapping[str, tuple[float, float]] | None = None,
    node_costs: np.ndarray | None = None,
    link_costs: np.ndarray | None = None,
    extent: tuple[float, float] | None = None,
    costs: Mapping[str, float] | None = None,
) -> Route:
    """See `NodeGraph.find_path`."""
    if costs is not None and graph.zone_state is not None:
        return find_path(
            plain_graph(graph), start, goal, radius, skills, node_costs, link_costs, extent, costs
        )
    sx, sy, sz = _point("start", start)
    gx, gy, gz = _point("goal", goal)
    radius = checked_radius(radius)
    doors = doors_of(graph, radius, skills, node_costs, link_costs)
    reach, rise, step = _limits(graph, radius, extent)
    if costs is not None:
        priced = _priced(graph, doors, costs, node_costs)
        ends = (sx, sy, sz), (gx, gy, gz)
        return _cheap_path(graph, *ends, doors, priced, (reach, rise, step), (skills, link_costs, extent))
    scratch = _scratch_for(graph)
    status, length, expanded, nodes, waypoints, leaps = _compiled_answer()(
        net_of(graph), doors, scratch, graph.surface.origin, sx, sy, sz, gx, gy, gz, reach, rise, step
    )
    graph.cache["scratch"].append(scratch)
    return Route(STATUSES[status], radius, nodes, waypoints, length, link_uses(graph, leaps), expanded, graph)


def _priced(graph: "NodeGraph", doors: Any, costs: Any, node_costs: Any) -> float | Priced:
    """The roadmap that ``costs`` price; or the cost of a metre, where that is the same everywhere."""
    if node_costs is not None:
        raise NavmeshError("costs and node_costs: expected one of them, not both")
    factor = checked_costs(graph, costs)
    return float(factor[0]) if are_plain(factor, doors) else priced_of(graph, doors, factor)


def _cheap_path(
    graph: "NodeGraph", start: Any, goal: Any, doors: Any, priced: float | Priced, limits: Any, offer: Any
) -> Route:
    """`find_path` with costs. ``offer``: skills, costs of links and extent."""
    if not isinstance(priced, Priced):
        route = find_path(graph, start, goal, doors.radius, offer[0], None, *offer[1:])
        return replace(route, _cost=priced * route.length)
    scratch = _scratch_for(graph)
    search = AreaSearch(graph, doors, scratch, priced)
    route = search.answer(start, goal, limits)
    search.give_back()
    graph.cache["scratch"].append(scratch)
    if route is None:
        route = find_path(graph, start, goal, doors.radius, offer[0], None, *offer[1:])
        return priced_route(graph, route, priced, offer[1])
    return route


def _points(name: str, values: Any) -> np.ndarray:
    try:
        points = np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise NavmeshError(f"{name}: expected coordinates (q, 3) [m]: {error}") from None
    if points.ndim != 2 or points.shape[1] != 3:
        raise NavmeshError(f"{name}: expected shape (q, 3), not {points.shape}")
    finite = np.isfinite(points)
    if not finite.all():
        bad = np.flatnonzero(~finite.all(axis=1))[0]
        raise NavmeshError(f"{name}[{bad}]: expected finite coordinates [m], not {points[bad]}")
    return points


def find_paths(
    graph: "NodeGraph",
    starts: Any,
    goals: Any,
    radius: float = 0.3,
    skills: Mapping[str, tuple[float, float]] | None = None,
    node_costs: np.ndarray | None = None,
    workers: int = 1,
    extent: tuple[float, float] | None = None,
    costs: Mapping[str, float] | None = None,
) -> Routes:
    """See `NodeGraph.find_paths`."""
    if costs is not None and graph.zone_state is not None:
        plain = plain_graph(graph)
        return find_paths(plain, starts, goals, radius, skills, node_costs, workers, extent, costs)
    first, second = _points("starts", starts), _points("goals", goals)
    if len(first) != len(second):
        raise NavmeshError(f"{len(first)} starts but {len(second)} goals: expected as many of each")
    if not isinstance(workers, Integral) or workers < 1:
        raise NavmeshError(f"workers = {workers!r}: expected a whole number of at least 1")
    radius = checked_radius(radius)
    doors = doors_of(graph, radius, skills, node_costs)
    net = net_of(graph)
    reach, rise, step = _limits(graph, radius, extent)
    if costs is not None:
        priced = _priced(graph, doors, costs, node_costs)  # before there are threads

        def one(start: np.ndarray, goal: np.ndarray) -> Route:
            ends = tuple(start.tolist()), tuple(goal.tolist())
            return _cheap_path(graph, *ends, doors, priced, (reach, rise, step), (skills, None, extent))

        with ThreadPoolExecutor(int(workers)) as pool:
            return gathered(graph, radius, list(pool.map(one, first, second)))

    def run(low: int, high: int) -> tuple:
        scratch = _scratch_for(graph)
        try:
            ends = first[low:high], second[low:high]
            return answer_all(net, doors, scratch, graph.surface.origin, *ends, reach, rise, step)
        finally:
            graph.cache["scratch"].append(scratch)

    workers = min(workers, len(first))
    if workers <= 1:
        arrays = run(0, len(first))
    else:
        bounds = [len(first) * part // workers for part in range(workers + 1)]
        with ThreadPoolExecutor(workers) as pool:
            arrays = _joined(list(pool.map(run, bounds[:-1], bounds[1:])))
    status, length, expanded, waypoints, waypoint_start, nodes, node_start, leaps, leap_start = arrays
    return Routes(
        status=_STATUSES[status],
        length=length,
        cost=length,
        radius=radius,
        expanded=expanded,
        waypoints=waypoints,
        waypoint_start=waypoint_start,
        nodes=nodes,
        node_start=node_start,
        leaps=leaps,
        leap_start=leap_start,
        graph=graph,
    )


def _joined(parts: list[tuple]) -> list[np.ndarray]:
    """The arrays of `answer_all` for all queries from those for consecutive parts of them."""
    arrays = [np.concatenate(column) for column in zip(*parts, strict=True)]
    for at in (4, 6, 8):  # starts of groups: each part's begin at 0
        sizes = [np.diff(part[at]) for part in parts]
        arrays[at] = np.concatenate([[0], np.cumsum(np.concatenate(sizes))])
    return arrays


class PathSearch:
    """A search that is spread over frames: `advance` it until it is done, then `finish` it.

    The result is that of `find_path`, bit for bit, however the work is cut. Ending early gives a partial
    route to the place nearest to the goal that the search has seen. The graph must not change meanwhile.
    """

    def __init__(
        self,
        graph: "NodeGraph",
        start: Any,
        goal: Any,
        radius: float = 0.3,
        skills: Mapping[str, tuple[float, float]] | None = None,
        node_costs: np.ndarray | None = None,
        extent: tuple[float, float] | None = None,
        costs: Mapping[str, float] | None = None,
    ) -> None:
        first, second = _point("start", start), _point("goal", goal)
        if costs is not None:
            graph = plain_graph(graph)
        self._graph = graph
        self._changes = _changes_of(graph)
        self._radius = checked_radius(radius)
        self._doors = doors_of(graph, self._radius, skills, node_costs)
        self._net = net_of(graph)
        self._scratch = make_scratch(graph)
        limits = _limits(graph, self._radius, extent)
        self._priced = 1.0 if costs is None else _priced(graph, self._doors, costs, node_costs)
        self._area = None
        if isinstance(self._priced, Priced):
            self._area = AreaSearch(graph, self._doors, self._scratch, self._priced)
            self._area.begin(first, second, limits)
            self._again = first, second, self._radius, skills, None, None, extent
            return
        origin = graph.surface.origin
        sx, sy, sz = (np.array(first) - origin).tolist()
        gx, gy, gz = (np.array(second) - origin).tolist()
        self._status = start_search(self._net, self._doors, self._scratch, sx, sy, sz, gx, gy, gz, *limits)

    def advance(self, nodes: int) -> bool:
        """Expand at most ``nodes`` nodes (each about 0.1 µs); True when the search is done."""
        if not isinstance(nodes, Integral) or nodes < 1:
            raise NavmeshError(f"nodes = {nodes!r}: expected a whole number of at least 1")
        self._check()
        if self._area is not None:
            return self._area.advance(int(nodes))
        if self._status not in SEARCHING:
            return True
        return advance(self._net, self._doors, self._scratch, nodes) != RUNNING

    def finish(self) -> Route:
        """The route to the goal, or a partial one if the search is not done."""
        self._check()
        if self._area is not None and isinstance(self._priced, Priced):
            route = self._area.finish()
            if route is None:
                route = priced_route(self._graph, find_path(self._graph, *self._again), self._priced)
            return route
        route = self._plain()
        return (
            route if isinstance(self._priced, Priced) else replace(route, _cost=self._priced * route.length)
        )

    def _check(self) -> None:
        if _changes_of(self._graph) != self._changes:
            raise NavmeshError(
                "a zone of the graph was blocked or opened since begin_path; expected a new search"
            )

    def _plain(self) -> Route:
        if self._status not in SEARCHING:
            nodes, waypoints = np.empty(0, np.int32), np.empty((0, 3))
            return Route(STATUSES[self._status], self._radius, nodes, waypoints, 0.0, [], 0, self._graph)
        status, length, expanded, nodes, waypoints, leaps = answer_search(
            self._net, self._doors, self._scratch, self._graph.surface.origin
        )
        return Route(
            STATUSES[status], self._radius, nodes, waypoints, length, link_uses(self._graph, leaps), expanded,
            self._graph,
        )  # fmt: skip
