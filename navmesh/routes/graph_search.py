"""A* over the graph of discs, for one body radius, in slices if wanted.

A search goes from portal to portal. What it knows of the way to a portal is a label: the apex, where the
shortest line through the portals so far last turns, what that line costs up to there, and the funnel, the
two corners between which the portal is seen from the apex. So the cost of a label is that of the pulled line
and not of one through the middles of discs, and what is left is estimated by the shortest line out of the
funnel to the goal. A node keeps the `LABELS` cheapest of those that lead into it: the cheapest can turn out
to run into something that the portals do not know of. Only the cheapest is gone on from; the other is set
aside until another way to the goal is wanted. Labels are numbered as they come up: what a search knows lies
together, however far apart the numbers of its nodes are.

Where nodes have costs, the line goes straight from where it crosses one portal to where it best crosses the
next on the way to the goal, and each part is weighted by the node's factor. No factor is below 1, so the
estimate of the rest, a straight line, never is too much. Lengths are three-dimensional.
"""

from math import sqrt

import numpy as np

from navmesh.routes.heap import push, take_first
from surefoot.kernels import kernel
from surefoot.kernels.fetching import fetch

__all__ = [
    "ALL",
    "BEST",
    "COMPLETE",
    "EMPTY",
    "EXPANDED",
    "GOAL_NODE",
    "LABELS",
    "LIMIT",
    "RUNNING",
    "advance",
    "begin",
    "chain",
    "resume",
]

RUNNING, COMPLETE, EMPTY = 0, 1, 2
"""State of a search: not finished; the goal was reached, and `advance` goes on to the next best way to it;
nothing is left that costs less than the limit."""

LABELS = 2
"""Kept for each node; `_place_for` knows that there are two."""

# Places in scratch.numbers
_STAMP, _HEAP, _STATE, GOAL_NODE, BEST, EXPANDED = 0, 1, 2, 3, 4, 5
_USED = 10  # labels
ALL = 12
"""Place in scratch.numbers: whether no label is set aside."""
LIMIT = 7
"""Place in scratch.ends: ways that cost so much [m] are not looked for."""
_NEAREST = 6  # in scratch.ends: how near [m] to the goal a portal seen is
_ASIDE = 8  # in scratch.ends: the least total of a label that was set aside
_SAME = 1e-9  # [m]
_AHEAD = 4  # doors of a node that are fetched when it gets a label


@kernel(error_model="numpy", forceinline=True)
def _distance(ax, ay, az, bx, by, bz):
    return sqrt((ax - bx) * (ax - bx) + (ay - by) * (ay - by) + (az - bz) * (az - bz))


@kernel(error_model="numpy", forceinline=True)
def _turn(ax, ay, bx, by, cx, cy):
    """Twice the area of a-b-c, positive where c lies to the left of a-b."""
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


@kernel(error_model="numpy", forceinline=True)
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


@kernel(error_model="numpy", forceinline=True)
def _out_of_funnel(ax, ay, az, lx, ly, lz, rx, ry, rz, gx, gy, gz):
    """Length of the shortest line from the apex a through the funnel between l and r to g."""
    beyond_left = _turn(ax, ay, lx, ly, gx, gy) > 0.0
    beyond_right = _turn(ax, ay, rx, ry, gx, gy) < 0.0
    x, y, z = rx if beyond_right else gx, ry if beyond_right else gy, rz if beyond_right else gz
    x, y, z = lx if beyond_left else x, ly if beyond_left else y, lz if beyond_left else z
    length = _distance(ax, ay, az, x, y, z) + _distance(x, y, z, gx, gy, gz)
    if beyond_left & beyond_right:
        length = min(length, _distance(ax, ay, az, rx, ry, rz) + _distance(rx, ry, rz, gx, gy, gz))
    return length


@kernel(error_model="numpy")
def begin(net, doors, scratch, start_node, goal_node, sx, sy, sz, gx, gy, gz):
    """Set up a search from (sx, sy, sz) in ``start_node`` to (gx, gy, gz) in ``goal_node``."""
    numbers = scratch.numbers
    numbers[_STAMP] += 1
    numbers[_HEAP] = 1
    numbers[_STATE] = RUNNING
    numbers[GOAL_NODE] = goal_node
    numbers[EXPANDED] = 0
    numbers[_USED] = 1
    numbers[BEST] = 0
    numbers[ALL] = 0
    ends = scratch.ends
    ends[0], ends[1], ends[2] = sx, sy, sz
    ends[3], ends[4], ends[5] = gx, gy, gz
    rest = _distance(sx, sy, sz, gx, gy, gz)
    ends[_NEAREST] = rest
    ends[LIMIT] = ends[_ASIDE] = 1e300
    _place_for(scratch.stamp, scratch.label, scratch.label_total, numbers[_STAMP], start_node, rest, 0)
    scratch.node[0] = start_node
    scratch.cost[0] = 0.0
    scratch.total[0] = rest
    for corner in (scratch.apex, scratch.left, scratch.right):
        corner[0, 0], corner[0, 1], corner[0, 2] = sx, sy, sz
    scratch.parent[0] = -1
    scratch.aside[0] = 0
    scratch.via[0] = -1
    scratch.heap_key[0] = rest
    scratch.heap_item[0] = 0


@kernel(error_model="numpy", forceinline=True)
def _place_for(seen, labels, totals, stamp, node, total, used):
    """Take for a label that costs ``total`` the place of the dearest of ``node``, or one that is free.

    Returns the number of the label, which is ``used`` where the place was free, or -1 where there is none, or
    one that costs the same.
    """
    fresh = seen[node] != stamp
    first = np.inf if fresh else totals[node, 0]
    second = np.inf if fresh else totals[node, 1]
    same = (abs(first - total) <= _SAME) | (abs(second - total) <= _SAME)
    if same | (max(first, second) <= total + _SAME):
        return np.int64(-1)
    seen[node] = stamp
    place = 1 if second > first else 0
    if fresh:
        labels[node, 1], totals[node, 1] = -1, np.inf
    label = np.int64(-1 if fresh else labels[node, place])
    label = used if label < 0 else label
    labels[node, place], totals[node, place] = label, total
    return label


@kernel(error_model="numpy")
def advance(net, doors, scratch, budget):
    """Expand at most ``budget`` labels; returns RUNNING, COMPLETE or EMPTY. The slices do not change the
    result."""
    numbers = scratch.numbers
    if numbers[_STATE] != RUNNING:
        return numbers[_STATE]
    stamp = numbers[_STAMP]
    goal_node = numbers[GOAL_NODE]
    gx, gy, gz = scratch.ends[3], scratch.ends[4], scratch.ends[5]
    seen, labels, label_total = scratch.stamp, scratch.label, scratch.label_total
    nodes, costs, totals = scratch.node, scratch.cost, scratch.total
    parent, via, used = scratch.parent, scratch.via, numbers[_USED]
    apex, left, right = scratch.apex, scratch.left, scratch.right
    door_start, leap_start = doors.start, doors.leap_start
    keys, items, size = scratch.heap_key, scratch.heap_item, numbers[_HEAP]
    portal, targets, node_cost = doors.portal, doors.target, doors.node_cost
    weighted = doors.weighted != 0
    leaps = doors.leap_id.size > 0
    doors_count = targets.size
    head, following = doors.head, doors.following
    slots = following.size
    first_slot = doors_count - slots
    nearest, limit = scratch.ends[_NEAREST], scratch.ends[LIMIT]
    aside, least_aside, every = scratch.aside, scratch.ends[_ASIDE], numbers[ALL] != 0
    state = RUNNING
    while budget > 0:
        if size == 0 or keys[0] >= limit:
            state = EMPTY
            break
        key, label = keys[0], items[0]
        take_first(keys, items, size)
        size -= 1
        if key > totals[label]:
            continue  # another label has taken its place
        node = np.int64(nodes[label])
        if not every and key > min(label_total[node, 0], label_total[node, 1]):
            aside[label] = 1
            least_aside = min(least_aside, key)
            continue
        if node == goal_node:
            numbers[BEST] = label
            state = COMPLETE
            break
        budget -= 1
        numbers[EXPANDED] += 1
        cost = costs[label]
        ax, ay, az = apex[label, 0], apex[label, 1], apex[label, 2]
        lx, ly, lz = left[label, 0], left[label, 1], left[label, 2]
        rx, ry, rz = right[label, 0], right[label, 1], right[label, 2]
        # the portal's place nearest to the goal, in case the search ends early
        rest = _distance(0.5 * (lx + rx), 0.5 * (ly + ry), 0.5 * (lz + rz), gx, gy, gz)
        if rest < nearest:
            nearest = rest
            numbers[BEST] = label
        before = nodes[parent[label]] if parent[label] >= 0 else -1
        factor = node_cost[node] if weighted else 1.0
        to_left, to_right = _distance(ax, ay, az, lx, ly, lz), _distance(ax, ay, az, rx, ry, rz)
        on, last = door_start[node], door_start[node + 1]
        for door in range(on, last):
            fetch(seen, np.int64(targets[door]))
        more = head[node] if slots > 0 else -1
        while on < last or more >= 0:
            if on < last:
                door = np.int64(on)
                on += 1
            else:
                door = np.int64(first_slot + more)
                more = following[more]
            target = targets[door]
            if (target < 0) | (target == before):
                continue
            # nothing that goes on from here costs less than the key
            done = max(label_total[target, 0], label_total[target, 1]) <= key
            if done & (seen[target] == stamp):
                continue
            plx, ply, plz = portal[door, 0], portal[door, 1], portal[door, 2]
            prx, pry, prz = portal[door, 3], portal[door, 4], portal[door, 5]
            nax, nay, naz, spent = ax, ay, az, cost
            if weighted:
                t = _crossing(plx, ply, prx, pry, ax, ay, gx, gy)
                nax, nay, naz = plx + t * (prx - plx), ply + t * (pry - ply), plz + t * (prz - plz)
                spent += factor * _distance(ax, ay, az, nax, nay, naz)
                plx, ply, plz, prx, pry, prz = nax, nay, naz, nax, nay, naz
                rest = _distance(nax, nay, naz, gx, gy, gz)
                if target == goal_node:
                    rest *= node_cost[target]
            else:
                # chosen, not branched: nobody can foretell on which side a portal lies
                past_left = _turn(ax, ay, lx, ly, prx, pry) > 0.0  # all of the portal is left of the funnel
                past_right = (not past_left) & (_turn(ax, ay, rx, ry, plx, ply) < 0.0)
                within = not (past_left | past_right)
                cut_left = within & (_turn(ax, ay, lx, ly, plx, ply) > 0.0)
                cut_right = within & (_turn(ax, ay, rx, ry, prx, pry) < 0.0)
                nax = lx if past_left else (rx if past_right else ax)
                nay = ly if past_left else (ry if past_right else ay)
                naz = lz if past_left else (rz if past_right else az)
                spent += to_left if past_left else (to_right if past_right else 0.0)
                plx, ply, plz = lx if cut_left else plx, ly if cut_left else ply, lz if cut_left else plz
                prx, pry, prz = rx if cut_right else prx, ry if cut_right else pry, rz if cut_right else prz
                rest = _out_of_funnel(nax, nay, naz, plx, ply, plz, prx, pry, prz, gx, gy, gz)
            total = max(spent + rest, key)
            slot = _place_for(seen, labels, label_total, stamp, target, total, used)
            if slot < 0:
                continue
            used += slot == used
            nodes[slot], costs[slot], totals[slot] = target, spent, total
            parent[slot], via[slot] = label, door
            apex[slot, 0], apex[slot, 1], apex[slot, 2] = nax, nay, naz
            left[slot, 0], left[slot, 1], left[slot, 2] = plx, ply, plz
            right[slot, 0], right[slot, 1], right[slot, 2] = prx, pry, prz
            aside[slot] = not every and total > min(label_total[target, 0], label_total[target, 1])
            if aside[slot]:
                least_aside = min(least_aside, total)
                continue
            for i in range(_AHEAD):
                fetch(portal, np.int64(door_start[target]) + i)
            push(keys, items, size, total, slot)
            size += 1
        if not leaps:
            continue
        own = doors.whole[node]
        for leap in range(leap_start[own], leap_start[own + 1]):
            target = net.label[doors.leap_to_cell[leap]]
            if target < 0 or doors.leap_closed[leap] or net.label[doors.leap_from_cell[leap]] != node:
                continue
            fx, fy, fz = doors.leap_from[leap, 0], doors.leap_from[leap, 1], doors.leap_from[leap, 2]
            tx, ty, tz = doors.leap_to[leap, 0], doors.leap_to[leap, 1], doors.leap_to[leap, 2]
            walked = factor * _out_of_funnel(ax, ay, az, lx, ly, lz, rx, ry, rz, fx, fy, fz)
            spent = cost + walked + doors.leap_cost[leap]
            rest = _distance(tx, ty, tz, gx, gy, gz)
            if target == goal_node:
                rest *= node_cost[target]
            total = max(spent + rest, key)
            slot = _place_for(seen, labels, label_total, stamp, target, total, used)
            if slot < 0:
                continue
            used += slot == used
            nodes[slot], costs[slot], totals[slot] = target, spent, total
            parent[slot], via[slot] = label, doors_count + leap
            for corner in (apex, left, right):
                corner[slot, 0], corner[slot, 1], corner[slot, 2] = tx, ty, tz
            aside[slot] = not every and total > min(label_total[target, 0], label_total[target, 1])
            if aside[slot]:
                least_aside = min(least_aside, total)
                continue
            push(keys, items, size, total, slot)
            size += 1
    numbers[_HEAP], numbers[_USED] = size, used
    numbers[_STATE] = state
    scratch.ends[_NEAREST], scratch.ends[_ASIDE] = nearest, least_aside
    return state


@kernel(error_model="numpy")
def resume(net, doors, scratch, budget):
    """Look on for another way to the goal after COMPLETE, also through labels that were set aside; returns
    COMPLETE where there is one."""
    numbers, limit = scratch.numbers, scratch.ends[LIMIT]
    if scratch.ends[_ASIDE] < limit:
        for label in range(numbers[_USED]):
            if scratch.aside[label] and scratch.total[label] < limit:
                scratch.aside[label] = 0
                push(scratch.heap_key, scratch.heap_item, numbers[_HEAP], scratch.total[label], label)
                numbers[_HEAP] += 1
    scratch.ends[_ASIDE] = 1e300
    numbers[ALL] = 1
    numbers[_STATE] = RUNNING
    return advance(net, doors, scratch, budget)


@kernel(error_model="numpy")
def chain(scratch):
    """Write the chain of nodes to the best label and the doors between them; returns the number of nodes.

    edges[i] leads into nodes[i]; edges[0] is -1; from the number of doors on they are leaps.
    """
    nodes, edges, parent, via, node = scratch.nodes, scratch.edges, scratch.parent, scratch.via, scratch.node
    count = 0
    label = scratch.numbers[BEST]
    while label >= 0:
        nodes[count] = node[label]
        edges[count] = via[label]
        count += 1
        label = parent[label]
    for i in range(count // 2):
        j = count - 1 - i
        nodes[i], nodes[j] = nodes[j], nodes[i]
        edges[i], edges[j] = edges[j], edges[i]
    return count
