"""A* over a priced roadmap, in slices if wanted.

What is left from a stop to the goal is at least the straight line at the least cost of a metre, and at least
what the landmarks say: the way from v to the goal costs no less than that from a landmark to the goal minus
that from the landmark to v, and no less than that from v to a landmark minus that from the goal's stops to
it (Goldberg and Harrelson, 2005). Start and goal are joined to the stops of their nodes.
"""

from math import sqrt

import numpy as np

from navmesh.areas.areas import Areas
from navmesh.areas.kernel_arrays import BENT, LANDMARKS, STRAIGHT
from navmesh.areas.line_costs import price
from navmesh.areas.roadmap import leg_fits, sector_of
from navmesh.routes.graph_search import COMPLETE, EMPTY, RUNNING
from navmesh.routes.heap import push, take_first
from surefoot.kernels import kernel

__all__ = ["BEST", "EXPANDED", "begin_trip", "go_on"]

# Places in trip.numbers
_STAMP, _HEAP, _STATE, BEST, EXPANDED, GOAL_NODE = 0, 1, 2, 3, 4, 5
_NEAREST = 6  # in trip.ends: how near [m] to the goal a stop seen is
_LEGS = 3  # of an end, to the nearest stops of its node in each eighth of the circle
_APART = 2.0  # by which the straight line is counted more where a body does not fit on it


@kernel(error_model="numpy", forceinline=True)
def _rest(road, trip, stop):
    """At least so much [m] is left from a stop to the goal."""
    ends, landmark, bound = trip.ends, road.landmark, trip.bound
    dx, dy, dz = road.x[stop] - ends[3], road.y[stop] - ends[4], road.z[stop] - ends[5]
    rest = road.least * sqrt(dx * dx + dy * dy + dz * dz)
    for i in range(LANDMARKS):
        there = bound[i] - landmark[stop, i]
        back = landmark[stop, LANDMARKS + i] - bound[LANDMARKS + i]
        if there > rest:  # nan is not
            rest = there
        if back > rest:
            rest = back
    return rest


@kernel(error_model="numpy")
def _toll(net, road, radius, node, k, ax, ay, bx, by, target, straight):
    """What a leg between a stop and an end in ``node`` costs; inf where it cannot be gone. Not ``straight``:
    at a guess, for legs on which a body does not fit."""
    areas = Areas(road.area, road.row, road.part)
    cost = price(net, areas, road.factor, k, ax, ay, bx, by, target, 1e300)
    if not straight:
        far = sqrt((bx - ax) ** 2 + (by - ay) ** 2)
        return _APART * (cost if cost < np.inf else far * road.factor[max(road.area[k], road.area[target])])
    if cost < np.inf and not leg_fits(net, node, k, ax, ay, bx, by, target, radius):
        return np.inf
    return cost


@kernel(error_model="numpy")
def _choose_legs(road, trip, node, x, y):
    """Write the `_LEGS` stops of ``node`` nearest to (x, y) in each direction into trip.near; returns how
    many."""
    near, far = trip.near, trip.far
    for i in range(8 * _LEGS):
        far[i] = np.inf
    xs, ys = road.x, road.y
    for at in range(road.group_start[node], road.group_start[node + 1]):
        stop = road.group[at]
        dx, dy = xs[stop] - x, ys[stop] - y
        square, first = dx * dx + dy * dy, _LEGS * sector_of(dx, dy)
        i = first + _LEGS - 1
        if square >= far[i]:
            continue
        while i > first and far[i - 1] > square:
            far[i], near[i] = far[i - 1], near[i - 1]
            i -= 1
        far[i], near[i] = square, stop
    count = 0
    for i in range(8 * _LEGS):
        if far[i] < np.inf:
            near[count] = near[i]
            count += 1
    return count


@kernel(error_model="numpy")
def begin_trip(net, doors, road, trip, start_node, goal_node, start_cell, goal_cell, ax, ay, az, bx, by, bz):
    """Set up a search from a, in ``start_cell``, to b."""
    numbers, ends = trip.numbers, trip.ends
    numbers[_STAMP] += 1
    stamp = numbers[_STAMP]
    numbers[_STATE] = RUNNING
    numbers[EXPANDED] = 0
    numbers[GOAL_NODE] = goal_node
    ends[0], ends[1], ends[2], ends[3], ends[4], ends[5] = ax, ay, az, bx, by, bz
    near = trip.near
    count = road.x.size
    start, goal = count, count + 1
    for i in range(2 * LANDMARKS):
        trip.bound[i] = np.nan
    found = 0
    legs = _choose_legs(road, trip, goal_node, bx, by)
    for attempt in range(2):
        for at in range(legs):
            stop = near[at]
            toll = _toll(
                net, road, doors.radius, goal_node, np.int64(road.stop_cell[stop]), road.x[stop],
                road.y[stop], bx, by, goal_cell, attempt == 0,
            )  # fmt: skip
            if toll == np.inf:
                continue
            found += 1
            trip.goal_stamp[stop] = stamp if attempt == 0 else -stamp
            trip.goal_toll[stop] = toll
            for i in range(LANDMARKS):
                there = road.landmark[stop, i] + toll
                back = road.landmark[stop, LANDMARKS + i] - toll
                if not trip.bound[i] <= there and there == there:
                    trip.bound[i] = there
                if not trip.bound[LANDMARKS + i] >= back and back == back:
                    trip.bound[LANDMARKS + i] = back
        if found > 0:
            break
    seen, spent, totals, rests, parent, via = (
        trip.stamp,
        trip.spent,
        trip.total,
        trip.rest,
        trip.parent,
        trip.road,
    )
    keys, items, size = trip.heap_key, trip.heap_item, 0
    seen[start], spent[start], parent[start], via[start] = stamp, 0.0, -1, STRAIGHT
    numbers[BEST] = start
    ends[_NEAREST] = sqrt((ax - bx) ** 2 + (ay - by) ** 2 + (az - bz) ** 2)
    seen[goal] = 0
    found = 0
    legs = _choose_legs(road, trip, start_node, ax, ay)
    for attempt in range(2):
        for at in range(legs):
            stop = near[at]
            toll = _toll(
                net, road, doors.radius, start_node, start_cell, ax, ay, road.x[stop], road.y[stop],
                np.int64(road.stop_cell[stop]), attempt == 0,
            )  # fmt: skip
            if toll == np.inf:
                continue
            found += 1
            seen[stop], spent[stop], parent[stop], via[stop] = stamp, toll, start, -1 - attempt
            rests[stop] = _rest(road, trip, stop)
            totals[stop] = toll + rests[stop]
            push(keys, items, size, totals[stop], stop)
            size += 1
        if start_node == goal_node:
            toll = _toll(
                net, road, doors.radius, start_node, start_cell, ax, ay, bx, by, goal_cell, attempt == 0
            )
            if toll < np.inf:
                found += 1
                seen[goal], spent[goal], parent[goal], via[goal] = stamp, toll, start, -1 - attempt
                totals[goal] = toll
                push(keys, items, size, toll, goal)
                size += 1
        if found > 0:
            break
    numbers[_HEAP] = size


@kernel(error_model="numpy")
def go_on(road, trip, budget):
    """Expand at most ``budget`` stops; returns RUNNING, COMPLETE or EMPTY. The slices do not change the
    result."""
    numbers, ends = trip.numbers, trip.ends
    if numbers[_STATE] != RUNNING:
        return numbers[_STATE]
    stamp = numbers[_STAMP]
    seen, spent, totals, rests, parent, via = (
        trip.stamp,
        trip.spent,
        trip.total,
        trip.rest,
        trip.parent,
        trip.road,
    )
    keys, items, size = trip.heap_key, trip.heap_item, numbers[_HEAP]
    road_start, to, tolls, done = road.road_start, road.to, road.toll, trip.done
    goal = road.x.size + 1
    nearest = ends[_NEAREST]
    state = RUNNING
    while budget > 0:
        if size == 0:
            state = EMPTY
            break
        key, stop = keys[0], items[0]
        take_first(keys, items, size)
        size -= 1
        if done[stop] == stamp:
            continue
        done[stop] = stamp
        if stop == goal:
            numbers[BEST] = goal
            state = COMPLETE
            break
        budget -= 1
        numbers[EXPANDED] += 1
        dx, dy, dz = road.x[stop] - ends[3], road.y[stop] - ends[4], road.z[stop] - ends[5]
        rest = sqrt(dx * dx + dy * dy + dz * dz)
        if rest < nearest:
            nearest = rest
            numbers[BEST] = stop
        here = spent[stop]
        for at in range(road_start[stop], road_start[stop + 1]):
            other = to[at]
            cost = here + tolls[at]
            if done[other] == stamp:
                continue
            if seen[other] != stamp:
                rests[other] = _rest(road, trip, other)
            elif cost >= spent[other]:
                continue
            total = max(cost + rests[other], key)
            seen[other], spent[other], totals[other], parent[other], via[other] = stamp, cost, total, stop, at
            push(keys, items, size, total, other)
            size += 1
        if abs(trip.goal_stamp[stop]) == stamp:
            cost = here + trip.goal_toll[stop]
            if seen[goal] != stamp or cost < spent[goal]:
                seen[goal], spent[goal], totals[goal], parent[goal] = stamp, cost, max(cost, key), stop
                via[goal] = STRAIGHT if trip.goal_stamp[stop] == stamp else BENT
                push(keys, items, size, totals[goal], goal)
                size += 1
    numbers[_HEAP] = size
    numbers[_STATE] = state
    ends[_NEAREST] = nearest
    return state
