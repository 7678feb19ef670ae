"""Queries for paths: from a start and a goal to a route, one at a time, in slices, or in batches.

The stages: the ends are snapped to places where the body fits (`navmesh.snapping`), A* chooses the chain of
discs (`navmesh.search`), string pulling turns it into the line to walk (`navmesh.pulling`).
"""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from navmesh.answering import answer, answer_all, answer_search, start_search
from navmesh.bodies import doors_of
from navmesh.errors import NavmeshError
from navmesh.route import STATUSES, Route, Routes, link_uses
from navmesh.search import RUNNING, advance
from navmesh.structs import make_scratch, net_of

if TYPE_CHECKING:
    from navmesh.graph import NodeGraph

__all__ = ["PathSearch", "find_path", "find_paths"]


def _scratch_for(graph: "NodeGraph") -> Any:
    """Memory for one search, taken from the graph's stock; give it back with
    ``graph.cache["scratch"].append``."""
    stock = graph.cache.setdefault("scratch", [])
    return stock.pop() if stock else make_scratch(len(graph.radii), len(graph.edge_target))


def _limits(graph: "NodeGraph", radius: float) -> tuple[float, float]:
    """How far [m] an end may be moved sideways, and how far from a floor it may be above or below."""
    return 2.0 * radius + 2.0 * graph.surface.resolution, graph.rules.headroom


def _point(name: str, value: Any) -> tuple[float, float, float]:
    try:
        x, y, z = value
        x, y, z = float(x), float(y), float(z)
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
) -> Route:
    """See `NodeGraph.find_path`."""
    sx, sy, sz = _point("start", start)
    gx, gy, gz = _point("goal", goal)
    radius = float(radius)
    doors = doors_of(graph, radius, skills, node_costs)
    scratch = _scratch_for(graph)
    reach, rise = _limits(graph, radius)
    status, length, expanded, nodes, waypoints, leaps = answer(
        net_of(graph), doors, scratch, graph.surface.origin, sx, sy, sz, gx, gy, gz, reach, rise
    )
    graph.cache["scratch"].append(scratch)
    return Route(STATUSES[status], radius, nodes, waypoints, length, link_uses(graph, leaps), expanded, graph)


def _points(name: str, values: Any) -> np.ndarray:
    points = np.ascontiguousarray(values, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise NavmeshError(f"{name}: expected shape (q, 3), not {points.shape}")
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        raise NavmeshError(f"{name}[{bad[0]}]: expected finite coordinates [m], not {points[bad[0]]}")
    return points


def find_paths(
    graph: "NodeGraph",
    starts: Any,
    goals: Any,
    radius: float = 0.3,
    skills: Mapping[str, tuple[float, float]] | None = None,
    node_costs: np.ndarray | None = None,
    workers: int = 1,
) -> Routes:
    """See `NodeGraph.find_paths`."""
    first, second = _points("starts", starts), _points("goals", goals)
    if len(first) != len(second):
        raise NavmeshError(f"{len(first)} starts but {len(second)} goals: expected as many of each")
    if workers < 1:
        raise NavmeshError(f"workers = {workers}: expected at least 1")
    radius = float(radius)
    doors = doors_of(graph, radius, skills, node_costs)
    net = net_of(graph)
    reach, rise = _limits(graph, radius)
    bounds = np.linspace(0, len(first), min(workers, max(len(first), 1)) + 1).astype(int)

    def run(part: int) -> tuple:
        scratch = _scratch_for(graph)
        low, high = bounds[part], bounds[part + 1]
        try:
            return answer_all(
                net, doors, scratch, graph.surface.origin, first[low:high], second[low:high], reach, rise
            )
        finally:
            graph.cache["scratch"].append(scratch)

    if len(bounds) == 2:
        parts = [run(0)]
    else:
        with ThreadPoolExecutor(len(bounds) - 1) as pool:
            parts = list(pool.map(run, range(len(bounds) - 1)))
    return Routes(
        status=np.array(STATUSES)[np.concatenate([part[0] for part in parts])],
        length=np.concatenate([part[1] for part in parts]),
        radius=radius,
        expanded=np.concatenate([part[2] for part in parts]),
        waypoints=np.concatenate([part[3] for part in parts]),
        waypoint_start=_joined([part[4] for part in parts]),
        nodes=np.concatenate([part[5] for part in parts]),
        node_start=_joined([part[6] for part in parts]),
        leaps=np.concatenate([part[7] for part in parts]),
        leap_start=_joined([part[8] for part in parts]),
        graph=graph,
    )


def _joined(starts: list[np.ndarray]) -> np.ndarray:
    """One array of group starts from those of consecutive parts."""
    sizes = np.concatenate([np.diff(part) for part in starts])
    return np.concatenate([[0], np.cumsum(sizes)])


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
    ) -> None:
        sx, sy, sz = (np.array(_point("start", start)) - graph.surface.origin).tolist()
        gx, gy, gz = (np.array(_point("goal", goal)) - graph.surface.origin).tolist()
        self._graph = graph
        self._radius = float(radius)
        self._doors = doors_of(graph, self._radius, skills, node_costs)
        self._net = net_of(graph)
        self._scratch = make_scratch(len(graph.radii), len(graph.edge_target))
        reach, rise = _limits(graph, self._radius)
        self._on_graph = start_search(
            self._net, self._doors, self._scratch, sx, sy, sz, gx, gy, gz, reach, rise
        )

    def advance(self, nodes: int) -> bool:
        """Expand at most ``nodes`` nodes (each about 0.1 µs); True when the search is done."""
        if nodes < 1:
            raise NavmeshError(f"nodes = {nodes}: expected at least 1")
        return not self._on_graph or advance(self._net, self._doors, self._scratch, nodes) != RUNNING

    def finish(self) -> Route:
        """The route to the goal, or a partial one if the search is not done."""
        if not self._on_graph:
            nodes, waypoints = np.empty(0, np.int32), np.empty((0, 3))
            return Route("off_graph", self._radius, nodes, waypoints, 0.0, [], 0, self._graph)
        status, length, expanded, nodes, waypoints, leaps = answer_search(
            self._net, self._doors, self._scratch, self._graph.surface.origin
        )
        return Route(
            STATUSES[status], self._radius, nodes, waypoints, length, link_uses(self._graph, leaps), expanded,
            self._graph,
        )  # fmt: skip
