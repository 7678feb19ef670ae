"""From the stops that a search over a roadmap chose to the line that a body walks: corners that make it no
cheaper are left out, the others moved to where it is cheaper."""

from math import sqrt

import numpy as np

from navmesh.areas.areas import Areas
from navmesh.areas.kernel_arrays import STRAIGHT
from navmesh.areas.line_costs import price
from navmesh.areas.pricing import price_of_lead
from navmesh.areas.roadmap_search import BEST
from navmesh.routes.string_pulling import CELLS, FITS, mend
from navmesh.surface.clearance_field import floor_at, same_place, walk
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["line_of"]

_SLACK = 0.005  # share of the radius kept on top of it
_SAME = 1e-9  # share of the cost that is no difference
_MOVES = 1  # rounds
_FIRST, _LAST = 0.2, 0.04  # [m] that a corner is moved at first, and at last


@kernel(error_model="numpy")
def _chain(net, road, trip, start_cell, goal_cell):
    """Write the stops from the start to the best one into trip.point; returns their number."""
    parent, via, ends = trip.parent, trip.road, trip.ends
    count = 0
    stop = trip.numbers[BEST]
    while stop >= 0:
        count += 1
        stop = np.int64(parent[stop])
    stops = road.x.size
    stop = trip.numbers[BEST]
    for i in range(count - 1, -1, -1):
        if stop >= stops:
            end = 0 if stop == stops else 3
            trip.point[i, 0], trip.point[i, 1] = ends[end], ends[end + 1]
            trip.point_cell[i] = start_cell if stop == stops else goal_cell
        else:
            trip.point[i, 0], trip.point[i, 1] = road.x[stop], road.y[stop]
            trip.point_cell[i] = road.stop_cell[stop]
        at = via[stop]
        before = np.int64(parent[stop])
        trip.point_kind[i] = road.kind[at] if at >= 0 else at
        trip.point_node[i] = road.road_node[at] if at >= 0 else net.label[trip.point_cell[i]]
        trip.point_cost[i] = trip.spent[stop] - (trip.spent[before] if before >= 0 else 0.0)
        stop = before
    return count


@kernel(error_model="numpy")
def _fitting(net, road, k, ax, ay, bx, by, target, radius, most):
    """What the straight line from a, in cell ``k``, to b costs; inf where it is not less than ``most``, or a
    body of ``radius`` does not fit on it."""
    dear = Areas(road.area, road.row, road.dear)
    cost = price(net, dear, road.factor, k, ax, ay, bx, by, target, most)
    if cost >= most:
        return np.inf
    reached, cell = walk(net, k, ax, ay, bx, by, radius, False)[:2]
    return cost if reached and same_place(net, cell, target) else np.inf


@kernel(error_model="numpy")
def _shorten(net, road, trip, first, count, radius):
    """Leave out the corners of point[first:count] that make the line no cheaper; returns the new count."""
    point, cell, node = trip.point, trip.point_cell, trip.point_node
    kind, cost = trip.point_kind, trip.point_cost
    kept = first + 1
    for i in range(first + 1, count):
        x, y, k, own, how, where = point[i, 0], point[i, 1], cell[i], cost[i], kind[i], node[i]
        while kept > first + 1:
            a = kept - 2
            most = (cost[kept - 1] + own) * (1.0 + _SAME) + 1e-9
            straight = _fitting(
                net, road, np.int64(cell[a]), point[a, 0], point[a, 1], x, y, np.int64(k), radius, most
            )
            if straight == np.inf:
                break
            own, how = straight, STRAIGHT
            kept -= 1
        point[kept, 0], point[kept, 1], cell[kept], cost[kept], kind[kept], node[kept] = (
            x,
            y,
            k,
            own,
            how,
            where,
        )
        kept += 1
    return kept


@kernel(error_model="numpy")
def _try_move(net, road, trip, i, dx, dy, radius):
    """Move corner ``i`` by d if that makes the line cheaper; returns whether it did."""
    point, cell, kind, cost = trip.point, trip.point_cell, trip.point_kind, trip.point_cost
    x, y = point[i, 0] + dx, point[i, 1] + dy
    reached, k = walk(net, np.int64(cell[i]), point[i, 0], point[i, 1], x, y, radius, False)[:2]
    if not reached:
        return False
    most = (cost[i] + cost[i + 1]) * (1.0 - 1e-6) - 1e-6
    before = _fitting(
        net, road, np.int64(cell[i - 1]), point[i - 1, 0], point[i - 1, 1], x, y, k, radius, most
    )
    if before == np.inf:
        return False
    after = _fitting(
        net, road, k, x, y, point[i + 1, 0], point[i + 1, 1], np.int64(cell[i + 1]), radius, most - before
    )
    if after == np.inf:
        return False
    point[i, 0], point[i, 1], cell[i], cost[i], cost[i + 1] = x, y, k, before, after
    kind[i] = kind[i + 1] = STRAIGHT
    return True


@kernel(error_model="numpy")
def _move(net, road, trip, first, count, radius):
    """Move the corners between the ends of point[first:count]."""
    for _ in range(_MOVES):
        moved = False
        for i in range(first + 1, count - 1):
            point = trip.point
            side = _FIRST
            while side >= _LAST:
                better = False
                # along the bisector of the turn and across it
                ax, ay = point[i - 1, 0] - point[i, 0], point[i - 1, 1] - point[i, 1]
                bx, by = point[i + 1, 0] - point[i, 0], point[i + 1, 1] - point[i, 1]
                a, b = sqrt(ax * ax + ay * ay), sqrt(bx * bx + by * by)
                if a < 1e-6 or b < 1e-6:
                    break
                ux, uy = ax / a + bx / b, ay / a + by / b
                u = sqrt(ux * ux + uy * uy)
                if u < 1e-3:
                    ux, uy, u = -ay / a, ax / a, 1.0
                ux, uy = ux / u * side, uy / u * side
                for way in range(4):
                    dx, dy = (ux, uy) if way == 0 else (-uy, ux) if way == 1 else (uy, -ux)
                    if way == 3:
                        dx, dy = -ux, -uy
                    if _try_move(net, road, trip, i, dx, dy, radius):
                        better = moved = True
                        break
                if not better:
                    side *= 0.5
        if not moved:
            break


@kernel(error_model="numpy")
def _ease(net, road, trip, first, count, radius):
    """Shorten and move the walked part point[first:count]; returns the new count, with what follows left
    where it is."""
    point, cell, cost = trip.point, trip.point_cell, trip.point_cost
    dear = Areas(road.area, road.row, road.dear)
    for i in range(first + 1, count):
        if trip.point_kind[i] == STRAIGHT:
            cost[i] = price(
                net, dear, road.factor, np.int64(cell[i - 1]), point[i - 1, 0], point[i - 1, 1],
                point[i, 0], point[i, 1], np.int64(cell[i]), 1e300,
            )  # fmt: skip
    count = _shorten(net, road, trip, first, count, radius)
    _move(net, road, trip, first, count, radius)
    return _shorten(net, road, trip, first, count, radius)


@allocating_kernel(error_model="numpy", nogil=True)
def line_of(net, doors, road, trip, scratch, start_cell, goal_cell):
    """The line of a search's best chain: (whether it could be walked, waypoints (k, 3), nodes (n,), leaps
    (l, 2), cost [m])."""
    radius = doors.radius
    count = _chain(net, road, trip, start_cell, goal_cell)
    points, cells, areas = scratch.points, scratch.cells, Areas(road.area, road.row, road.part)
    nodes, leaps = np.empty(count + 1, np.int32), np.empty((count, 2), np.int32)
    passed = used = 0
    for i in range(count):
        node = trip.point_node[i]
        if passed == 0 or nodes[passed - 1] != node:
            nodes[passed] = node
            passed += 1
    points[0, 0], points[0, 1] = trip.point[0, 0], trip.point[0, 1]
    cells[0] = trip.point_cell[0]
    corners = 1
    total = 0.0
    first = 0
    while first < count:
        last = first + 1
        while last < count and trip.point_kind[last] < 0:
            last += 1
        # the walked part first:last, then a leap to the point last
        enough = radius * (1.0 + _SLACK)
        end = _ease(net, road, trip, first, last, enough)
        for i in range(first + 1, end):
            x, y, k = trip.point[i, 0], trip.point[i, 1], np.int64(trip.point_cell[i])
            if corners + 1 >= cells.size:
                return False, points[:0].copy(), nodes[:0].copy(), leaps[:0].copy(), 0.0
            if trip.point_kind[i] == STRAIGHT:
                points[corners, 0], points[corners, 1], cells[corners] = x, y, k
                corners += 1
                total += price_of_lead(net, areas, road.factor, scratch, corners - 2, corners)
                continue
            begun = corners - 1
            scratch.nodes[0] = trip.point_node[i]
            corners, state = mend(net, doors, scratch, begun, corners, x, y, k, 0, 1, CELLS)
            if state != FITS:
                return False, points[:0].copy(), nodes[:0].copy(), leaps[:0].copy(), 0.0
            total += price_of_lead(net, areas, road.factor, scratch, begun, corners)
        if last < count:
            leaps[used, 0] = doors.leap_id[trip.point_kind[last]]
            leaps[used, 1] = corners - 1
            used += 1
            points[corners, 0], points[corners, 1] = trip.point[last, 0], trip.point[last, 1]
            cells[corners] = trip.point_cell[last]
            corners += 1
            total += trip.point_cost[last]
        first = last
    for i in range(corners):
        points[i, 2] = floor_at(net, np.int64(cells[i]), points[i, 0], points[i, 1])
    return (
        total < np.inf, points[:corners].copy(), nodes[:passed].copy(), leaps[:used].copy(), total,
    )  # fmt: skip
