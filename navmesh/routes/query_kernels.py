"""One query, compiled: snap the ends, search, pull taut; and many of them one after another."""

from math import sqrt

import numpy as np

from navmesh.graph.reachable_places import nearest_reachable
from navmesh.graph.snapping import snap
from navmesh.routes.graph_search import BEST, COMPLETE, EXPANDED, LABELS, LIMIT, advance, begin, chain, resume
from navmesh.routes.string_pulling import pull
from navmesh.surface.clearance_field import cell_at, floor_at, walk
from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "GOAL_CELL",
    "NEARER",
    "SEARCHING",
    "START_CELL",
    "answer",
    "answer_all",
    "answer_search",
    "start_search",
]

_COMPLETE, _PARTIAL, _NO_PATH, _OFF_GRAPH = range(4)  # indices into navmesh.routes.route.STATUSES
SEARCHING = (_COMPLETE, _PARTIAL)
"""What `start_search` returns where there is something to search for."""
_WHOLE = 1 << 60
START_CELL, GOAL_CELL, _STATUS = 8, 9, 11  # places in scratch.numbers
NEARER = 0.01  # [m] that a place must be nearer to the goal than the start to be gone to
_CLOSE = 0.985  # share of the length found that another chain must promise to be tried
_AGAIN = 0.5  # share of the labels expanded that may be expanded again then, and
_MORE = 32  # some more


@kernel(error_model="numpy", nogil=True)
def _mark_reached(net, doors, scratch, region):
    """Mark in scratch.reached the regions that leaps lead to from ``region``, with it, and list them in
    scratch.part_stack; returns how many, and how many rows of the tiles they have."""
    reached, listed = scratch.reached, scratch.part_stack
    mark = scratch.numbers[0]
    reached[region] = mark
    listed[0] = region
    at, count, rows = 0, 1, 0
    if doors.anywhere >= 0:
        reached[doors.anywhere] = mark
        listed[1] = doors.anywhere
        count = 2
    while at < count:
        here = listed[at]
        at += 1
        part = here
        while True:
            rows += doors.part_row_start[part + 1] - doors.part_row_start[part]
            own = doors.part_whole[part]
            for i in range(doors.part_leap_start[own], doors.part_leap_start[own + 1]):
                leap = doors.part_leap[i]
                node, to = net.label[doors.leap_from_cell[leap]], net.label[doors.leap_to_cell[leap]]
                if doors.leap_closed[leap] or node < 0 or to < 0 or doors.region[doors.part[node]] != here:
                    continue
                other = doors.region[doors.part[to]]
                if reached[other] != mark:
                    reached[other] = mark
                    listed[count] = other
                    count += 1
            part = doors.ring[part]
            if part == here:
                break
    return count, rows


@kernel(error_model="numpy", nogil=True)
def start_search(net, doors, scratch, sx, sy, sz, gx, gy, gz, reach, rise, step):
    """Snap the ends and begin the search; returns a status.

    `_PARTIAL` where the goal cannot be reached and the search is for the nearest place that can, `_NO_PATH`
    where that is no nearer than the start, `_OFF_GRAPH`, or `_COMPLETE`.
    """
    if doors.radius > doors.widest:
        return _OFF_GRAPH
    start_node, start_cell, ax, ay = snap(net, sx, sy, sz, doors.radius, reach, rise, step)
    if start_node < 0:
        return _OFF_GRAPH
    goal_node, goal_cell, bx, by = snap(net, gx, gy, gz, doors.radius, reach, rise, step)
    if goal_node < 0:
        return _OFF_GRAPH
    scratch.numbers[0] += 1  # marks of the last search hold no more
    az = floor_at(net, start_cell, ax, ay)
    status = _COMPLETE
    region = doors.region[doors.part[start_node]]
    if doors.region[doors.part[goal_node]] != region:
        regions, rows = _mark_reached(net, doors, scratch, region)
        if scratch.reached[doors.region[doors.part[goal_node]]] != scratch.numbers[0]:
            status = _PARTIAL
            now = (ax - gx) * (ax - gx) + (ay - gy) * (ay - gy) + (az - gz) * (az - gz)
            goal_node, goal_cell, bx, by, near = nearest_reachable(
                net, doors, scratch, regions, rows, gx, gy, gz, now
            )
            if goal_node < 0 or near > sqrt(now) - NEARER:
                return _NO_PATH
    scratch.numbers[START_CELL] = start_cell
    scratch.numbers[GOAL_CELL] = goal_cell
    scratch.numbers[_STATUS] = status
    bz = floor_at(net, goal_cell, bx, by)
    begin(net, doors, scratch, start_node, goal_node, ax, ay, az, bx, by, bz)
    return status


@allocating_kernel(error_model="numpy", nogil=True)
def _trace(net, doors, scratch, leaps, count, gx, gy, goal_cell, last_try):
    """Pull the chain of ``count`` nodes taut, to g in ``goal_cell``, into ``scratch.points``.

    ``leaps`` (n, 2) int32 receives (leap, corner at its run-up). The cells are searched on the ``last_try``
    only. Returns (whether the goal was reached, nodes, corners, leaps used, cost [m], how much of it rounding
    the corners adds to what the search thought of).
    """
    ends = scratch.ends
    scratch.points[0, 0], scratch.points[0, 1], scratch.points[0, 2] = ends[0], ends[1], ends[2]
    scratch.cells[0] = scratch.numbers[START_CELL]
    corners = 1
    used = 0
    first = 1
    cost = rounding = 0.0
    doors_count = doors.target.size
    edges = scratch.edges
    for i in range(1, count):
        leap = edges[i] - doors_count
        if leap < 0:
            continue
        x, y, cell = doors.leap_from[leap, 0], doors.leap_from[leap, 1], np.int64(doors.leap_from_cell[leap])
        leg = corners - 1
        corners, reached, more = pull(net, doors, scratch, first, i, corners, x, y, cell, last_try)
        rounding += more
        cost += _length(scratch, leg, corners) + doors.leap_cost[leap]
        if not reached:
            return False, i, corners, used, cost, rounding
        leaps[used, 0] = doors.leap_id[leap]
        leaps[used, 1] = corners - 1
        used += 1
        if corners + 1 >= scratch.cells.size:
            return False, i, corners, used, cost, rounding
        scratch.points[corners] = doors.leap_to[leap]
        scratch.cells[corners] = doors.leap_to_cell[leap]
        corners += 1
        first = i + 1
    leg = corners - 1
    corners, reached, more = pull(net, doors, scratch, first, count, corners, gx, gy, goal_cell, last_try)
    return reached, count, corners, used, cost + _length(scratch, leg, corners), rounding + more


@kernel(error_model="numpy", nogil=True)
def _length(scratch, first, last):
    """Length [m] of the line through the corners [first:last]."""
    points = scratch.points
    total = 0.0
    for i in range(first + 1, last):
        dx = points[i, 0] - points[i - 1, 0]
        dy = points[i, 1] - points[i - 1, 1]
        dz = points[i, 2] - points[i - 1, 2]
        total += sqrt(dx * dx + dy * dy + dz * dz)
    return total


@kernel(error_model="numpy", nogil=True)
def _early_end(net, doors, scratch):
    """Where a search that was ended early leads: (x, y, cell) of the middle of the portal seen that is
    nearest to the goal."""
    label = scratch.numbers[BEST]
    door = scratch.via[label]
    if door < 0 or door >= doors.target.size:
        x, y, z = scratch.apex[label, 0], scratch.apex[label, 1], scratch.apex[label, 2]
        return x, y, cell_at(net, x, y, z)
    lx, ly = doors.portal[door, 0], doors.portal[door, 1]
    x, y = 0.5 * (lx + doors.portal[door, 3]), 0.5 * (ly + doors.portal[door, 4])
    return x, y, walk(net, np.int64(doors.portal_cell[door, 0]), lx, ly, x, y, 0.0, True)[1]


@allocating_kernel(error_model="numpy", nogil=True)
def _finish(net, doors, scratch, leaps):
    """Turn the search's state into corners in ``scratch.points``.

    The line of the cheapest chain can be longer than the search thought, and than rounding the corners makes
    it. While chains are left that may lead to a shorter one, they are pulled taut too, as many as the goal
    has labels and with no more than half as much searching again; the shortest counts. Returns (status,
    nodes, corners, leaps used).
    """
    numbers, ends = scratch.numbers, scratch.ends
    state = advance(net, doors, scratch, 0)
    count = chain(scratch)
    if state != COMPLETE:
        x, y, cell = _early_end(net, doors, scratch)
        now = _far(ends[0], ends[1], ends[2], ends[3], ends[4], ends[5])
        after = _far(x, y, floor_at(net, cell, x, y), ends[3], ends[4], ends[5])
        if after > now - NEARER:
            return _NO_PATH, 0, 0, 0
        nodes, corners, used = _trace(net, doors, scratch, leaps, count, x, y, cell, True)[1:4]
        return _PARTIAL, nodes, corners, used
    x, y, cell = ends[3], ends[4], numbers[GOAL_CELL]
    most = numbers[EXPANDED] + int(_AGAIN * numbers[EXPANDED]) + _MORE
    cheapest = numbers[BEST]
    least = 1e300
    kept_nodes = kept = kept_used = 0
    fresh = False
    nodes = corners = used = 0
    for attempt in range(LABELS):
        reached, nodes, corners, used, cost, rounding = _trace(
            net, doors, scratch, leaps, count, x, y, cell, False
        )
        fresh = reached and cost < least
        if fresh:
            least = cost
            ends[LIMIT] = cost * _CLOSE - rounding
        if attempt == LABELS - 1 or (doors.weighted and reached):
            break
        if resume(net, doors, scratch, most - numbers[EXPANDED]) != COMPLETE:
            break
        if fresh:
            kept_nodes, kept, kept_used = nodes, corners, used
            scratch.kept[:corners] = scratch.points[:corners]
            scratch.kept_nodes[:nodes] = scratch.nodes[:nodes]
            scratch.kept_leaps[:used] = leaps[:used]
        count = chain(scratch)
    if fresh:
        return numbers[_STATUS], nodes, corners, used
    if kept > 0:
        scratch.points[:kept] = scratch.kept[:kept]
        scratch.nodes[:kept_nodes] = scratch.kept_nodes[:kept_nodes]
        leaps[:kept_used] = scratch.kept_leaps[:kept_used]
        return numbers[_STATUS], kept_nodes, kept, kept_used
    numbers[BEST] = cheapest
    count = chain(scratch)
    reached, nodes, corners, used = _trace(net, doors, scratch, leaps, count, x, y, cell, True)[:4]
    return (numbers[_STATUS] if reached else _PARTIAL), nodes, corners, used


@kernel(error_model="numpy", forceinline=True)
def _far(ax, ay, az, bx, by, bz):
    return sqrt((ax - bx) * (ax - bx) + (ay - by) * (ay - by) + (az - bz) * (az - bz))


@allocating_kernel(error_model="numpy", nogil=True)
def answer_search(net, doors, scratch, origin):
    """The route of a search: (status, length, expanded, nodes, waypoints in world coordinates, leaps)."""
    leaps = np.empty((net.node_radius.size if doors.leap_id.size else 0, 2), np.int32)
    status, nodes, corners, used = _finish(net, doors, scratch, leaps)
    return (
        status,
        _length(scratch, 0, corners),
        scratch.numbers[EXPANDED],
        scratch.nodes[:nodes].copy(),
        scratch.points[:corners] + origin,
        leaps[:used],
    )


@allocating_kernel(error_model="numpy", nogil=True)
def answer(net, doors, scratch, origin, sx, sy, sz, gx, gy, gz, reach, rise, step):
    """A whole query; `answer_search`'s tuple."""
    ox, oy, oz = origin[0], origin[1], origin[2]
    status = start_search(
        net, doors, scratch, sx - ox, sy - oy, sz - oz, gx - ox, gy - oy, gz - oz, reach, rise, step
    )
    if status > _PARTIAL:
        return status, 0.0, 0, scratch.nodes[:0].copy(), np.empty((0, 3)), np.empty((0, 2), np.int32)
    advance(net, doors, scratch, _WHOLE)
    return answer_search(net, doors, scratch, origin)


@allocating_kernel(error_model="numpy", nogil=True)
def answer_all(net, doors, scratch, origin, starts, goals, reach, rise, step):
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
        status[i] = start_search(
            net, doors, scratch,
            starts[i, 0] - ox, starts[i, 1] - oy, starts[i, 2] - oz,
            goals[i, 0] - ox, goals[i, 1] - oy, goals[i, 2] - oz, reach, rise, step,
        )  # fmt: skip
        n = corners = used = 0
        if status[i] <= _PARTIAL:
            advance(net, doors, scratch, _WHOLE)
            status[i], n, corners, used = _finish(net, doors, scratch, used_room)
            length[i] = _length(scratch, 0, corners)
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
