"""One query, compiled: snap the ends, search, pull taut; and many of them one after another."""

from math import sqrt

import numpy as np
from numba import njit

from navmesh.field import cell_at, floor_at, walk
from navmesh.pulling import pull
from navmesh.search import COMPLETE, EXPANDED, advance, begin, chain
from navmesh.snapping import snap

__all__ = ["answer", "answer_all", "answer_search", "start_search"]

_COMPLETE, _PARTIAL, _NO_PATH, _OFF_GRAPH = range(4)  # indices into navmesh.route.STATUSES
_WHOLE = 1 << 60
_START_CELL, _GOAL_CELL = 8, 9  # places in scratch.numbers


@njit(error_model="numpy", cache=True, nogil=True)
def start_search(net, doors, scratch, sx, sy, sz, gx, gy, gz, reach, rise):
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


@njit(error_model="numpy", cache=True, nogil=True)
def _last_place(net, doors, scratch, node):
    """Where a route that does not reach the goal ends: the place in its last node nearest to it; (x, y,
    cell)."""
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
    reached, end = walk(net, cell, x, y, px, py, doors.radius, False)[:2]
    return (px, py, end) if reached else (x, y, cell)


@njit(error_model="numpy", cache=True, nogil=True)
def _finish(net, doors, scratch, leaps):
    """Turn the search's state into corners in ``scratch.points``.

    ``leaps`` (n, 2) int32 receives (leap, corner at its run-up). Returns (status, nodes, corners, leaps
    used).
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
    edges = scratch.edges
    for i in range(1, count):
        leap = edges[i] - doors_count
        if leap < 0:
            continue
        x, y, cell = doors.leap_from[leap, 0], doors.leap_from[leap, 1], np.int64(doors.leap_from_cell[leap])
        corners, reached = pull(net, doors, scratch, first, i, corners, x, y, cell)
        if not reached:
            return _PARTIAL, i, corners, used
        leaps[used, 0] = doors.leap_id[leap]
        leaps[used, 1] = corners - 1
        used += 1
        if corners + 1 >= scratch.cells.size:
            return _PARTIAL, i, corners, used
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


@njit(error_model="numpy", cache=True, nogil=True)
def _length(scratch, corners):
    points = scratch.points
    total = 0.0
    for i in range(1, corners):
        dx = points[i, 0] - points[i - 1, 0]
        dy = points[i, 1] - points[i - 1, 1]
        dz = points[i, 2] - points[i - 1, 2]
        total += sqrt(dx * dx + dy * dy + dz * dz)
    return total


@njit(error_model="numpy", cache=True, nogil=True)
def answer_search(net, doors, scratch, origin):
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


@njit(error_model="numpy", cache=True, nogil=True)
def answer(net, doors, scratch, origin, sx, sy, sz, gx, gy, gz, reach, rise):
    """A whole query; `answer_search`'s tuple."""
    ox, oy, oz = origin[0], origin[1], origin[2]
    if not start_search(
        net, doors, scratch, sx - ox, sy - oy, sz - oz, gx - ox, gy - oy, gz - oz, reach, rise
    ):
        return _OFF_GRAPH, 0.0, 0, scratch.nodes[:0].copy(), np.empty((0, 3)), np.empty((0, 2), np.int32)
    advance(net, doors, scratch, _WHOLE)
    return answer_search(net, doors, scratch, origin)


@njit(error_model="numpy", cache=True, nogil=True)
def answer_all(net, doors, scratch, origin, starts, goals, reach, rise):
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
        on = start_search(
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
        points = scratch.points
        for j in range(corners):
            waypoints[at + j, 0] = points[j, 0] + ox
            waypoints[at + j, 1] = points[j, 1] + oy
            waypoints[at + j, 2] = points[j, 2] + oz
        waypoint_start[i + 1] = at + corners
        at = node_start[i]
        if at + n > nodes.size:
            more_nodes = np.empty(2 * nodes.size + n, np.int32)
            more_nodes[:at] = nodes[:at]
            nodes = more_nodes
        chosen = scratch.nodes
        for j in range(n):
            nodes[at + j] = chosen[j]
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
