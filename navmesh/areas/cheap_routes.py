"""Routes that are cheap by what a metre costs in each area: queries with ``costs``.

The ends are snapped as ever, A* chooses stops of a roadmap (`navmesh.areas.roadmap`), and what it chose is
eased into a line (`navmesh.areas.roadmap_lines`). Roadmaps are made once for each radius, and priced once for
each set of costs.
"""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from navmesh.areas.areas import Areas
from navmesh.areas.kernel_arrays import make_trip
from navmesh.areas.line_costs import area_at, price
from navmesh.areas.pricing import Priced
from navmesh.areas.roadmap import leg_fits
from navmesh.areas.roadmap_lines import line_of
from navmesh.areas.roadmap_search import BEST as BEST_STOP
from navmesh.areas.roadmap_search import EXPANDED, begin_trip, go_on
from navmesh.graph.kernel_arrays import net_of
from navmesh.routes.graph_search import BEST, COMPLETE, EMPTY, GOAL_NODE, RUNNING
from navmesh.routes.query_kernels import GOAL_CELL, NEARER, START_CELL, start_search
from navmesh.routes.route import STATUSES, Route, link_uses
from navmesh.surface.clearance_field import centre_of, walk
from navmesh.surface.floor_store import height_of
from surefoot.kernels import allocating_kernel, kernel

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["AreaSearch", "are_plain", "priced_route"]

_COMPLETE, _PARTIAL, _NO_PATH, _OFF_GRAPH = range(4)  # indices into STATUSES
_WHOLE = 1 << 60
_FAILED = 9
"""In place of a status: there is a way, but no line was found; the route without costs has to do."""
_START, _GOAL, _STATUS = 8, 9, 10  # places in trip.numbers: the cells, and the status so far


@kernel(error_model="numpy")
def _is_allowed(net, road, k, x, y):
    areas = Areas(road.area, road.row, road.part)
    area = area_at(net, areas, k, x, y)
    return area >= 0 and road.factor[area] < np.inf


@kernel(error_model="numpy")
def _is_reached(net, road, trip, radius, k, x, y):
    """Whether the search that has ended came to where (x, y) in cell ``k`` can be got to."""
    node = np.int64(net.label[k])
    stamp = trip.numbers[0]
    areas = Areas(road.area, road.row, road.part)
    for at in range(road.group_start[node], road.group_start[node + 1]):
        stop = road.group[at]
        if trip.stamp[stop] != stamp:
            continue
        px, py, cell = road.x[stop], road.y[stop], np.int64(road.stop_cell[stop])
        if price(net, areas, road.factor, cell, px, py, x, y, k, 1e300) < np.inf and leg_fits(
            net, node, cell, px, py, x, y, k, radius
        ):
            return True
    return False


@kernel(error_model="numpy")
def _nearest_cell(net, road, trip, radius, x, y, z, reach, rise, reached):
    """The cell nearest to (x, y, z), at most ``reach`` [m] away horizontally and ``rise`` up or down, with
    its centre in no forbidden area and ``radius`` clear; -1 where there is none. With ``reached`` only where
    the search that has ended can get to."""
    h = net.cell
    ix, iy = int(np.floor(x / h)), int(np.floor(y / h))
    best, found = reach * reach + rise * rise, -1
    rings = int(min(reach / h, 2.0 * max(net.nx, net.ny))) + 1
    for ring in range(rings + 1):
        if ring > 1 and ((ring - 1) * h) ** 2 >= best:
            break
        for jx in range(max(ix - ring, 0), min(ix + ring + 1, net.nx)):
            edge = jx == ix - ring or jx == ix + ring
            for jy in range(iy - ring, iy + ring + 1, 1 if edge else max(2 * ring, 1)):
                if jy < 0 or jy >= net.ny:
                    continue
                column = jx * net.ny + jy
                for k in range(net.column_start[column], net.column_start[column + 1]):
                    if net.clearance[k] < radius or net.label[k] < 0:
                        continue
                    cx, cy = centre_of(net, k)
                    flat = (cx - x) ** 2 + (cy - y) ** 2
                    off = flat + (height_of(net, k) - z) ** 2
                    if off >= best or flat > reach * reach or abs(height_of(net, k) - z) > rise:
                        continue
                    if not _is_allowed(net, road, k, cx, cy):
                        continue
                    if not reached or _is_reached(net, road, trip, radius, k, cx, cy):
                        best, found = off, k
    return found


@allocating_kernel(error_model="numpy", nogil=True)
def _start_trip(net, doors, road, trip, scratch, origin, sx, sy, sz, gx, gy, gz, reach, rise, step):
    """Snap the ends and begin the search; returns a status, as
    `navmesh.routes.query_kernels.start_search`."""
    sx, sy, sz = sx - origin[0], sy - origin[1], sz - origin[2]
    gx, gy, gz = gx - origin[0], gy - origin[1], gz - origin[2]
    status = start_search(net, doors, scratch, sx, sy, sz, gx, gy, gz, reach, rise, step)
    trip.numbers[_STATUS] = status
    if status > _PARTIAL:
        return status
    ends, numbers = scratch.ends, scratch.numbers
    start_node, goal_node = np.int64(scratch.node[numbers[BEST]]), numbers[GOAL_NODE]
    start_cell, goal_cell = numbers[START_CELL], numbers[GOAL_CELL]
    ax, ay, az, bx, by, bz = ends[0], ends[1], ends[2], ends[3], ends[4], ends[5]
    if road.forbids != 0:
        if not _is_allowed(net, road, start_cell, ax, ay):
            start_cell = np.int64(
                _nearest_cell(net, road, trip, doors.radius, sx, sy, sz, reach, rise, False)
            )
            if start_cell < 0:
                return _OFF_GRAPH
            start_node = np.int64(net.label[start_cell])
            ax, ay = centre_of(net, start_cell)
            az = height_of(net, start_cell)
        if status == _COMPLETE and not _is_allowed(net, road, goal_cell, bx, by):
            cell = np.int64(_nearest_cell(net, road, trip, doors.radius, gx, gy, gz, reach, rise, False))
            if cell >= 0:
                goal_cell, goal_node = cell, np.int64(net.label[cell])
                bx, by = centre_of(net, cell)
                bz = height_of(net, cell)
    trip.numbers[_START], trip.numbers[_GOAL] = start_cell, goal_cell
    begin_trip(net, doors, road, trip, start_node, goal_node, start_cell, goal_cell, ax, ay, az, bx, by, bz)
    return status


@allocating_kernel(error_model="numpy", nogil=True)
def _end_trip(net, doors, road, trip, scratch, origin, gx, gy, gz):
    """The route of a search: (status, length, cost, expanded, nodes, waypoints in world coordinates, leaps).

    g is the goal as it was asked for.
    """
    numbers, ends = trip.numbers, trip.ends
    status = numbers[_STATUS]
    state = go_on(road, trip, 0)
    gx, gy, gz = gx - origin[0], gy - origin[1], gz - origin[2]
    walked, points, nodes = False, scratch.points[:0].copy(), scratch.nodes[:0].copy()
    leaps, cost = np.empty((0, 2), np.int32), 0.0
    if state == EMPTY and road.forbids != 0:
        # the nearest place that can be got to
        ax, ay, az = ends[0], ends[1], ends[2]
        now = np.sqrt((ax - gx) ** 2 + (ay - gy) ** 2 + (az - gz) ** 2)
        cell = np.int64(_nearest_cell(net, road, trip, doors.radius, gx, gy, gz, now, now, True))
        status = _NO_PATH
        if cell >= 0:
            bx, by = centre_of(net, cell)
            bz = height_of(net, cell)
            if np.sqrt((bx - gx) ** 2 + (by - gy) ** 2 + (bz - gz) ** 2) <= now - NEARER:
                start_cell = numbers[_START]
                numbers[_GOAL] = cell
                node = net.label[start_cell]
                expanded = numbers[EXPANDED]
                first = np.int64(scratch.node[scratch.numbers[BEST]] if node < 0 else node)
                begin_trip(
                    net, doors, road, trip, first, np.int64(net.label[cell]), start_cell, cell,
                    ax, ay, az, bx, by, bz,
                )  # fmt: skip
                state = go_on(road, trip, _WHOLE)
                numbers[EXPANDED] += expanded
                status = numbers[_STATUS] = _PARTIAL
    elif state == EMPTY:
        status = _FAILED
    elif state != COMPLETE:
        stop = numbers[BEST_STOP]
        status = _NO_PATH
        if stop < road.x.size:
            off = np.sqrt((road.x[stop] - gx) ** 2 + (road.y[stop] - gy) ** 2 + (road.z[stop] - gz) ** 2)
            now = np.sqrt((ends[0] - gx) ** 2 + (ends[1] - gy) ** 2 + (ends[2] - gz) ** 2)
            if off <= now - NEARER:
                status = _PARTIAL
    if status <= _PARTIAL:
        walked, points, nodes, leaps, cost = line_of(
            net, doors, road, trip, scratch, numbers[_START], numbers[_GOAL]
        )
        if not walked:
            status = _NO_PATH if road.forbids != 0 else _FAILED
            points, nodes, cost = points[:0], nodes[:0], 0.0
    length = 0.0
    for i in range(1, points.shape[0]):
        dx, dy, dz = (
            points[i, 0] - points[i - 1, 0], points[i, 1] - points[i - 1, 1], points[i, 2] - points[i - 1, 2]
        )  # fmt: skip
        length += np.sqrt(dx * dx + dy * dy + dz * dz)
    return status, length, cost, numbers[EXPANDED], nodes, points + origin, leaps


@allocating_kernel(error_model="numpy", nogil=True)
def _answer(net, doors, road, trip, scratch, origin, sx, sy, sz, gx, gy, gz, reach, rise, step):
    """A whole query; `_end_trip`'s tuple."""
    status = _start_trip(net, doors, road, trip, scratch, origin, sx, sy, sz, gx, gy, gz, reach, rise, step)
    if status > _PARTIAL:
        nodes, waypoints = scratch.nodes[:0].copy(), np.empty((0, 3))
        return status, 0.0, 0.0, 0, nodes, waypoints, np.empty((0, 2), np.int32)
    go_on(road, trip, _WHOLE)
    return _end_trip(net, doors, road, trip, scratch, origin, gx, gy, gz)


@allocating_kernel(error_model="numpy", nogil=True)
def _line_price(net, road, k, points):
    """What the line through ``points`` (n, 3), relative to the origin, from cell ``k`` on costs."""
    areas = Areas(road.area, road.row, road.part)
    total = 0.0
    for i in range(1, points.shape[0]):
        ax, ay, bx, by = points[i - 1, 0], points[i - 1, 1], points[i, 0], points[i, 1]
        end = walk(net, k, ax, ay, bx, by, 0.0, True)[1]
        total += price(net, areas, road.factor, k, ax, ay, bx, by, end, 1e300)
        k = end
    return total


def are_plain(factor: np.ndarray, doors: Any) -> bool:
    """Whether costs change nothing about which route is the best."""
    return bool((factor == factor[0]).all() and (factor[0] == 1.0 or not doors.leap_id.size)) and bool(
        np.isfinite(factor[0])
    )


def priced_route(
    graph: "NodeGraph", route: Route, priced: Priced, link_costs: np.ndarray | None = None
) -> Route:
    """``route``, found without costs, with what it costs; ``link_costs`` as of `NodeGraph.find_path`."""
    origin, cost, first = graph.surface.origin, 0.0, 0
    own = graph.links.cost if link_costs is None else graph.links.cost + link_costs
    for use in [*route.links, None]:
        last = len(route.waypoints) - 1 if use is None else use.first
        points = route.waypoints[first : last + 1] - origin
        if len(points):
            cell = graph.project(route.waypoints[first])[0]
            cost += _line_price(net_of(graph), priced.road, int(cell), points)
        if use is not None:
            cost += float(own[use.link])
            first = use.last
    return replace(route, _cost=cost)


class AreaSearch:
    """One search with costs over a graph, to be begun, advanced and ended, or answered at once."""

    def __init__(self, graph: "NodeGraph", doors: Any, scratch: Any, priced: Priced) -> None:
        """``doors`` as of `doors_of`, ``scratch`` as of `make_scratch`."""
        self._graph, self._doors, self._scratch, self._priced = graph, doors, scratch, priced
        self._trip = (
            priced.trips.pop() if priced.trips else make_trip(len(priced.road.stops), len(priced.road.roads))
        )
        self._goal = (0.0, 0.0, 0.0)
        self._status = _OFF_GRAPH
        self._all = net_of(graph), doors, priced.road, self._trip, scratch, graph.surface.origin

    def begin(self, start: Any, goal: Any, limits: tuple[float, float, float]) -> None:
        """``start`` and ``goal`` are three numbers each; ``limits`` say how far they may be moved."""
        self._goal = goal
        self._status = _start_trip(*self._all, *start, *goal, *limits)

    def advance(self, stops: int) -> bool:
        """Expand at most ``stops``; True when the search is done."""
        if self._status > _PARTIAL:
            return True
        return go_on(self._priced.road, self._trip, stops) != RUNNING

    def finish(self) -> Route | None:
        """The route; None where one that was found without costs has to do."""
        if self._status > _PARTIAL:
            nothing = np.empty(0, np.int32), np.empty((0, 3)), np.empty((0, 2), np.int32)
            return self._route(self._status, 0.0, 0.0, 0, *nothing)
        return self._route(*_end_trip(*self._all, *self._goal))

    def answer(self, start: Any, goal: Any, limits: tuple[float, float, float]) -> Route | None:
        """`begin`, `advance` to the end, `finish`."""
        return self._route(*_answer(*self._all, *start, *goal, *limits))

    def give_back(self) -> None:
        """Let another search have the memory."""
        self._priced.trips.append(self._trip)

    def _route(self, status, length, cost, expanded, nodes, waypoints, leaps) -> Route | None:
        if status == _FAILED:
            return None
        graph = self._graph
        return Route(
            STATUSES[status], self._doors.radius, nodes, waypoints, length, link_uses(graph, leaps), expanded,
            graph, cost,
        )  # fmt: skip
