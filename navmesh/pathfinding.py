"""Queries for paths: from a start and a goal to a route, one at a time, in slices, or in batches.

The stages: the ends are snapped to places where the body fits (`navmesh.snapping`), A* chooses the chain of discs
(`navmesh.search`), string pulling turns it into the line to walk (`navmesh.pulling`).
"""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from math import isfinite, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np
from numba import njit

from navmesh.errors import NavmeshError
from navmesh.field import cell_at, floor_at, walk
from navmesh.portals import open_portals
from navmesh.pulling import grow, pull
from navmesh.route import STATUSES, Route, Routes, link_uses
from navmesh.search import COMPLETE, EXPANDED, RUNNING, advance, begin, chain
from navmesh.snapping import snap
from navmesh.structs import make_doors, make_scratch, net_of

if TYPE_CHECKING:
    from navmesh.graph import NodeGraph

__all__ = ["SKILLS", "PathSearch", "find_path", "find_paths"]

SKILLS = ("jump", "vault", "drop", "gap")
"""The skills that `find_path` can be offered."""

_COMPLETE, _PARTIAL, _NO_PATH, _OFF_GRAPH = range(4)
_WHOLE = 1 << 60
_KEPT = 16
_START_CELL, _GOAL_CELL = 8, 9


@njit(cache=True, nogil=True)
def _start(net, doors, scratch, sx, sy, sz, gx, gy, gz, reach, rise):
    """Snap the ends and begin the search; False when one of them is off the graph."""
    start_node, start_cell, ax, ay = snap(net, sx, sy, sz, doors.radius, reach, rise)
    if start_node < 0:
        return False
    goal_node, goal_cell, bx, by = snap(net, gx, gy, gz, doors.radius, reach, rise)
    if goal_node < 0:
        return False
    scratch.numbers[_START_CELL] = start_cell
    scratch.numbers[_GOAL_CELL] = goal_cell
    az = floor_at(net, start_cell, ax, ay)
    bz = floor_at(net, goal_cell, bx, by)
    begin(net, doors, scratch, start_node, goal_node, ax, ay, az, bx, by, bz)
    return True


@njit(cache=True, nogil=True)
def _last_place(net, doors, scratch, node):
    """Where a route that does not reach the goal ends: the place in its last node nearest to it; (x, y, cell)."""
    gx, gy = scratch.ends[3], scratch.ends[4]
    x, y = net.position[node, 0], net.position[node, 1]
    cell = cell_at(net, x, y, net.position[node, 2])
    shrunk = net.node_radius[node] - doors.radius
    if shrunk <= 0.0:
        x, y, z = scratch.entry[node, 0], scratch.entry[node, 1], scratch.entry[node, 2]
        return x, y, cell_at(net, x, y, z)
    away = sqrt((gx - x) ** 2 + (gy - y) ** 2)
    share = min(shrunk / away, 1.0) if away > 0.0 else 0.0
    px, py = x + share * (gx - x), y + share * (gy - y)
    reached, end, _, _, _, _ = walk(net, cell, x, y, px, py, doors.radius, False)
    return (px, py, end) if reached else (x, y, cell)


@njit(cache=True, nogil=True)
def _finish(net, doors, scratch, leaps):
    """Turn the search's state into corners in ``scratch.points``.

    ``leaps`` (n, 2) int32 receives (leap, corner at its run-up). Returns (status, nodes, corners, leaps used).
    """
    numbers = scratch.numbers
    ends = scratch.ends
    done = advance(net, doors, scratch, 0) == COMPLETE
    count = chain(net, scratch)
    scratch.points[0, 0], scratch.points[0, 1], scratch.points[0, 2] = ends[0], ends[1], ends[2]
    scratch.cells[0] = numbers[_START_CELL]
    corners = 1
    used = 0
    first = 1
    doors_count = doors.target.size
    for i in range(1, count):
        leap = scratch.edges[i] - doors_count
        if leap < 0:
            continue
        x, y = doors.leap_from[leap, 0], doors.leap_from[leap, 1]
        corners, reached = pull(net, doors, scratch, first, i, corners, x, y, doors.leap_from_cell[leap])
        if not reached:
            return _PARTIAL, i, corners, used
        leaps[used, 0] = doors.leap_id[leap]
        leaps[used, 1] = corners - 1
        used += 1
        grow(scratch, corners + 1)
        scratch.points[corners] = doors.leap_to[leap]
        scratch.cells[corners] = doors.leap_to_cell[leap]
        corners += 1
        first = i + 1
    x, y, cell = ends[3], ends[4], numbers[_GOAL_CELL]
    if not done:
        x, y, cell = _last_place(net, doors, scratch, scratch.nodes[count - 1])
        gain = sqrt((ends[0] - ends[3]) ** 2 + (ends[1] - ends[4]) ** 2) - sqrt(
            (x - ends[3]) ** 2 + (y - ends[4]) ** 2
        )
        if used == 0 and gain < net.cell:
            return _NO_PATH, 0, 0, 0
    corners, reached = pull(net, doors, scratch, first, count, corners, x, y, cell)
    return (_COMPLETE if done and reached else _PARTIAL), count, corners, used


@njit(cache=True, nogil=True)
def _length(scratch, corners):
    total = 0.0
    for i in range(1, corners):
        a, b = scratch.points[i - 1], scratch.points[i]
        total += sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)
    return total


@njit(cache=True, nogil=True)
def _answer(net, doors, scratch, origin):
    """The route of a search: (status, length, expanded, nodes, waypoints in world coordinates, leaps)."""
    leaps = np.empty((net.node_radius.size if doors.leap_id.size else 0, 2), np.int32)
    status, nodes, corners, used = _finish(net, doors, scratch, leaps)
    return (
        status,
        _length(scratch, corners),
        scratch.numbers[EXPANDED],
        scratch.nodes[:nodes].copy(),
        scratch.points[:corners] + origin,
        leaps[:used],
    )


@njit(cache=True, nogil=True)
def _one(net, doors, scratch, origin, sx, sy, sz, gx, gy, gz, reach, rise):
    """A whole query; `_answer`'s tuple."""
    ox, oy, oz = origin[0], origin[1], origin[2]
    if not _start(
        net, doors, scratch, sx - ox, sy - oy, sz - oz, gx - ox, gy - oy, gz - oz, reach, rise
    ):
        return _OFF_GRAPH, 0.0, 0, scratch.nodes[:0].copy(), np.empty((0, 3)), np.empty((0, 2), np.int32)
    advance(net, doors, scratch, _WHOLE)
    return _answer(net, doors, scratch, origin)


@njit(cache=True, nogil=True)
def _many(net, doors, scratch, origin, starts, goals, reach, rise):
    """Queries one after another; the arrays of `Routes`, with leaps (l, 2) and starts beginning at 0."""
    count = starts.shape[0]
    status = np.empty(count, np.int64)
    length = np.zeros(count)
    expanded = np.zeros(count, np.int64)
    waypoint_start = np.zeros(count + 1, np.int64)
    node_start = np.zeros(count + 1, np.int64)
    leap_start = np.zeros(count + 1, np.int64)
    waypoints = np.empty((8 * count + 64, 3))
    nodes = np.empty(16 * count + 64, np.int32)
    leaps = np.empty((count + 64, 2), np.int32)
    used_room = np.empty((net.node_radius.size if doors.leap_id.size else 0, 2), np.int32)
    ox, oy, oz = origin[0], origin[1], origin[2]
    for i in range(count):
        on = _start(
            net, doors, scratch,
            starts[i, 0] - ox, starts[i, 1] - oy, starts[i, 2] - oz,
            goals[i, 0] - ox, goals[i, 1] - oy, goals[i, 2] - oz, reach, rise,
        )  # fmt: skip
        status[i] = _OFF_GRAPH
        n = corners = used = 0
        if on:
            advance(net, doors, scratch, _WHOLE)
            status[i], n, corners, used = _finish(net, doors, scratch, used_room)
            length[i] = _length(scratch, corners)
            expanded[i] = scratch.numbers[EXPANDED]
        at = waypoint_start[i]
        if at + corners > waypoints.shape[0]:
            more = np.empty((2 * waypoints.shape[0] + corners, 3))
            more[:at] = waypoints[:at]
            waypoints = more
        for j in range(corners):
            for axis in range(3):
                waypoints[at + j, axis] = scratch.points[j, axis] + origin[axis]
        waypoint_start[i + 1] = at + corners
        at = node_start[i]
        if at + n > nodes.size:
            more_nodes = np.empty(2 * nodes.size + n, np.int32)
            more_nodes[:at] = nodes[:at]
            nodes = more_nodes
        nodes[at : at + n] = scratch.nodes[:n]
        node_start[i + 1] = at + n
        at = leap_start[i]
        if at + used > leaps.shape[0]:
            more_leaps = np.empty((2 * leaps.shape[0] + used, 2), np.int32)
            more_leaps[:at] = leaps[:at]
            leaps = more_leaps
        leaps[at : at + used] = used_room[:used]
        leap_start[i + 1] = at + used
    return (
        status, length, expanded, waypoints[: waypoint_start[count]].copy(), waypoint_start,
        nodes[: node_start[count]].copy(), node_start, leaps[: leap_start[count]].copy(), leap_start,
    )  # fmt: skip


def _checked_skills(skills: Mapping[str, tuple[float, float]] | None) -> tuple:
    """The skills on offer as a sorted tuple (name, least height, greatest height)."""
    offered = []
    for name, limits in (skills or {}).items():
        if name not in SKILLS:
            raise NavmeshError(f"skill {name!r}: expected one of {', '.join(SKILLS)}")
        try:
            low, high = (float(value) for value in limits)
        except (TypeError, ValueError):
            raise NavmeshError(f"skill {name!r}: expected (least, greatest height) [m], not {limits!r}") from None
        if not 0.0 <= low <= high < np.inf:
            raise NavmeshError(f"skill {name!r}: expected 0 <= least <= greatest height [m], not {limits!r}")
        offered.append((name, low, high))
    return tuple(sorted(offered))


def _portals_for(graph: "NodeGraph", radius: float) -> tuple:
    kept = graph.cache.setdefault("portals", {})
    if radius not in kept:
        if len(kept) >= _KEPT:
            del kept[next(iter(kept))]
        kept[radius] = open_portals(net_of(graph), graph.edge_width, graph.edge_cells, radius)
    return kept[radius]


def _leaps_for(graph: "NodeGraph", radius: float, skills: tuple) -> tuple:
    """The links on offer, grouped by the node they start from: the ``leap`` arrays of `make_doors`."""
    count = len(graph.radii)
    links = graph.links
    chosen = []
    for name, low, high in skills:
        of_kind = (links.affordance == name) & (links.height >= low) & (links.height <= high)
        chosen.append(np.flatnonzero(of_kind & (links.radius >= radius)))
    index = np.sort(np.concatenate(chosen)) if chosen else np.empty(0, np.int64)
    if len(index) == 0:
        nothing = np.empty((0, 3))
        none = np.empty(0, np.int32)
        return np.zeros(count + 1, np.int32), none, nothing, none, nothing, none, np.empty(0)
    index = index[(graph.label[links.start_cell[index]] >= 0) & (graph.label[links.end_cell[index]] >= 0)]
    origin = graph.surface.origin
    start, end = links.start[index] - origin, links.end[index] - origin
    start_cell, end_cell = links.start_cell[index], links.end_cell[index]
    node = graph.label[start_cell]
    order = np.lexsort((index, node))
    starts = np.searchsorted(node[order], np.arange(count + 1)).astype(np.int32)
    cost = np.maximum(links.cost[index], np.linalg.norm(end - start, axis=1))
    return (
        starts,
        index[order].astype(np.int32),
        np.ascontiguousarray(start[order]),
        start_cell[order],
        np.ascontiguousarray(end[order]),
        end_cell[order],
        cost[order],
    )


def _doors_for(graph: "NodeGraph", radius: float, skills: Any, node_costs: np.ndarray | None) -> Any:
    """The `Doors` for a body, made once for each radius and offer of skills (those with costs each time)."""
    offered = _checked_skills(skills) if skills else ()
    if node_costs is None:
        kept = graph.cache.setdefault("doors", {})
        doors = kept.get((radius, offered))
        if doors is not None:
            return doors
    if not isfinite(radius) or radius <= 0.0:
        raise NavmeshError(f"radius = {radius!r}: expected a body's radius [m], above 0")
    count = len(graph.radii)
    if node_costs is None:
        costs = np.ones(count)
    else:
        costs = np.ascontiguousarray(node_costs, dtype=np.float64)
        if costs.shape != (count,) or not np.all(costs >= 1.0) or not np.all(np.isfinite(costs)):
            raise NavmeshError(f"node_costs: expected {count} finite factors of at least 1, one for each node")
    doors = make_doors(
        radius, *_portals_for(graph, radius), costs, node_costs is not None, *_leaps_for(graph, radius, offered)
    )
    if node_costs is None:
        if len(kept) >= _KEPT:
            del kept[next(iter(kept))]
        kept[(radius, offered)] = doors
    return doors


def _scratch_for(graph: "NodeGraph") -> Any:
    """Memory for one search, taken from the graph's stock; give it back with ``graph.cache["scratch"].append``."""
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
    doors = _doors_for(graph, radius, skills, node_costs)
    scratch = _scratch_for(graph)
    reach, rise = _limits(graph, radius)
    status, length, expanded, nodes, waypoints, leaps = _one(
        net_of(graph), doors, scratch, graph.surface.origin, sx, sy, sz, gx, gy, gz, reach, rise
    )
    graph.cache["scratch"].append(scratch)
    return Route(
        STATUSES[status], radius, nodes, waypoints, length, link_uses(graph, leaps), expanded, graph
    )


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
        raise NavmeshError(f"{len(first)} starts but {len(second)} goals: expected as many of one as of the other")
    if workers < 1:
        raise NavmeshError(f"workers = {workers}: expected at least 1")
    radius = float(radius)
    doors = _doors_for(graph, radius, skills, node_costs)
    net = net_of(graph)
    reach, rise = _limits(graph, radius)
    bounds = np.linspace(0, len(first), min(workers, max(len(first), 1)) + 1).astype(int)

    def run(part: int) -> tuple:
        scratch = _scratch_for(graph)
        low, high = bounds[part], bounds[part + 1]
        try:
            return _many(
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

    The result is that of `find_path`, bit for bit, however the work is cut. Ending early gives a partial route to
    the place nearest to the goal that the search has seen. The graph must not change meanwhile.
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
        self._doors = _doors_for(graph, self._radius, skills, node_costs)
        self._net = net_of(graph)
        self._scratch = make_scratch(len(graph.radii), len(graph.edge_target))
        reach, rise = _limits(graph, self._radius)
        self._on_graph = _start(self._net, self._doors, self._scratch, sx, sy, sz, gx, gy, gz, reach, rise)

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
        status, length, expanded, nodes, waypoints, leaps = _answer(
            self._net, self._doors, self._scratch, self._graph.surface.origin
        )
        return Route(
            STATUSES[status], self._radius, nodes, waypoints, length, link_uses(self._graph, leaps), expanded,
            self._graph,
        )  # fmt: skip
