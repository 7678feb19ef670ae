"""A* over the graph of discs, for one body radius, in slices if wanted.

The cost of a step is not measured between centres, which bends every route through the middles of large
discs, but along entry points: where the portal into the next disc is best crossed on the way from the present
entry point to the goal. Lengths are three-dimensional and weighted by the node's area cost; what is left is
estimated by the straight line to the goal, which never overestimates because no cost factor is below 1.
"""

from math import sqrt

from numba import njit

from navmesh.heap import push, take_first

__all__ = ["BEST", "COMPLETE", "EMPTY", "EXPANDED", "RUNNING", "advance", "begin", "chain"]

RUNNING, COMPLETE, EMPTY = 0, 1, 2
"""State of a search: not finished; the goal was reached; every reachable node was seen without reaching
it."""

# Places in scratch.numbers
_STAMP, _HEAP, _STATE, _GOAL_NODE, BEST, EXPANDED = 0, 1, 2, 3, 4, 5


@njit(error_model="numpy", cache=True, inline="always")
def _distance(ax, ay, az, bx, by, bz):
    return sqrt((ax - bx) * (ax - bx) + (ay - by) * (ay - by) + (az - bz) * (az - bz))


@njit(error_model="numpy", cache=True, inline="always")
def _crossing(lx, ly, rx, ry, ax, ay, bx, by):
    """Where on the portal (0 left, 1 right) the shortest way from a over the portal to b crosses it."""
    px = rx - lx
    py = ry - ly
    length = px * px + py * py
    if length < 1e-18:
        return 0.0
    along_a = (ax - lx) * px + (ay - ly) * py
    along_b = (bx - lx) * px + (by - ly) * py
    off_a = abs((ax - lx) * py - (ay - ly) * px)
    off_b = abs((bx - lx) * py - (by - ly) * px)
    both = (off_a + off_b) * length
    t = (along_a * off_b + along_b * off_a) / both if both > 0.0 else 0.5 * (along_a + along_b) / length
    return 0.0 if t < 0.0 else (1.0 if t > 1.0 else t)


@njit(error_model="numpy", cache=True)
def begin(net, doors, scratch, start_node, goal_node, sx, sy, sz, gx, gy, gz):
    """Set up a search from (sx, sy, sz) in ``start_node`` to (gx, gy, gz) in ``goal_node`` (or -1: as near as
    can be)."""
    numbers = scratch.numbers
    numbers[_STAMP] += 1
    numbers[_HEAP] = 1
    numbers[_STATE] = RUNNING
    numbers[_GOAL_NODE] = goal_node
    numbers[BEST] = start_node
    numbers[EXPANDED] = 0
    ends = scratch.ends
    ends[0], ends[1], ends[2] = sx, sy, sz
    ends[3], ends[4], ends[5] = gx, gy, gz
    rest = _distance(sx, sy, sz, gx, gy, gz)
    ends[6] = rest
    scratch.stamp[start_node] = numbers[_STAMP]
    scratch.cost[start_node] = 0.0
    scratch.total[start_node] = rest
    scratch.entry[start_node, 0], scratch.entry[start_node, 1], scratch.entry[start_node, 2] = sx, sy, sz
    scratch.parent[start_node] = -1
    scratch.via[start_node] = -1
    scratch.heap_key[0] = rest
    scratch.heap_node[0] = start_node


@njit(error_model="numpy", cache=True)
def advance(net, doors, scratch, budget):
    """Expand at most ``budget`` nodes; returns RUNNING, COMPLETE or EMPTY. The slices do not change the
    result."""
    numbers = scratch.numbers
    if numbers[_STATE] != RUNNING:
        return numbers[_STATE]
    stamp = numbers[_STAMP]
    goal_node = numbers[_GOAL_NODE]
    gx, gy, gz = scratch.ends[3], scratch.ends[4], scratch.ends[5]
    # arrays taken out of their bundle in a loop are counted as used each time
    seen, costs, totals, entry = scratch.stamp, scratch.cost, scratch.total, scratch.entry
    parent, via = scratch.parent, scratch.via
    door_start, leap_start = doors.start, doors.leap_start
    keys, nodes, size = scratch.heap_key, scratch.heap_node, numbers[_HEAP]
    portal, targets, node_cost = doors.portal, doors.target, doors.node_cost
    nearest = scratch.ends[6]
    state = RUNNING
    while budget > 0:
        if size == 0:
            state = EMPTY
            break
        key, node = keys[0], nodes[0]
        take_first(keys, nodes, size)
        size -= 1
        if key > totals[node]:
            continue  # reached more cheaply since
        if node == goal_node:
            numbers[BEST] = node
            state = COMPLETE
            break
        budget -= 1
        numbers[EXPANDED] += 1
        cost = costs[node]
        x, y, z = entry[node, 0], entry[node, 1], entry[node, 2]
        rest = _distance(x, y, z, gx, gy, gz)
        if rest < nearest:
            nearest = rest
            numbers[BEST] = node
        factor = node_cost[node]
        # nothing that goes on from here costs less than the key: nodes with less are done with
        for door in range(door_start[node], door_start[node + 1]):
            target = targets[door]
            if seen[target] == stamp and totals[target] <= key:
                continue
            lx, ly, lz = portal[door, 0], portal[door, 1], portal[door, 2]
            rx, ry, rz = portal[door, 3], portal[door, 4], portal[door, 5]
            t = _crossing(lx, ly, rx, ry, x, y, gx, gy)
            ex, ey, ez = lx + t * (rx - lx), ly + t * (ry - ly), lz + t * (rz - lz)
            step = cost + factor * _distance(x, y, z, ex, ey, ez)
            rest = _distance(ex, ey, ez, gx, gy, gz)
            if target == goal_node:
                rest *= node_cost[target]
            if seen[target] != stamp or step + rest < totals[target] - 1e-9:
                seen[target] = stamp
                costs[target], totals[target] = step, step + rest
                entry[target, 0], entry[target, 1], entry[target, 2] = ex, ey, ez
                parent[target], via[target] = node, door
                push(keys, nodes, size, step + rest, target)
                size += 1
        for leap in range(leap_start[node], leap_start[node + 1]):
            target = net.label[doors.leap_to_cell[leap]]
            fx, fy, fz = doors.leap_from[leap, 0], doors.leap_from[leap, 1], doors.leap_from[leap, 2]
            tx, ty, tz = doors.leap_to[leap, 0], doors.leap_to[leap, 1], doors.leap_to[leap, 2]
            step = cost + factor * _distance(x, y, z, fx, fy, fz) + doors.leap_cost[leap]
            rest = _distance(tx, ty, tz, gx, gy, gz)
            if target == goal_node:
                rest *= node_cost[target]
            if seen[target] != stamp or step + rest < totals[target] - 1e-9:
                seen[target] = stamp
                costs[target], totals[target] = step, step + rest
                entry[target, 0], entry[target, 1], entry[target, 2] = tx, ty, tz
                parent[target], via[target] = node, targets.size + leap
                push(keys, nodes, size, step + rest, target)
                size += 1
    numbers[_HEAP] = size
    numbers[_STATE] = state
    scratch.ends[6] = nearest
    return state


@njit(error_model="numpy", cache=True)
def chain(net, scratch):
    """Write the chain of nodes to the best node and the doors between them; returns the number of nodes."""
    nodes, edges, parent, via = scratch.nodes, scratch.edges, scratch.parent, scratch.via
    count = 0
    node = scratch.numbers[BEST]
    while node >= 0:
        nodes[count] = node
        edges[count] = via[node]
        count += 1
        node = parent[node]
    for i in range(count // 2):
        j = count - 1 - i
        nodes[i], nodes[j] = nodes[j], nodes[i]
        edges[i], edges[j] = edges[j], edges[i]
    # edges[i] leads into nodes[i]; edges[0] is -1; from the number of doors on they are leaps
    return count
