"""Searches on the coarse graph: which parts can be reached, and the shortest chain of terminals."""

from math import sqrt

import numpy as np

from navmesh.routes.heap import push, take_first
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["parts_reached", "shortest_chain"]


def parts_reached(parts: int, start: int, source: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Which of so many ``parts`` can be reached from the part ``start`` over leaps from the parts ``source``
    (l,) to the parts ``target`` (l,): (parts,) bool."""
    reached = np.zeros(parts, np.bool_)
    reached[start] = True
    while True:
        fresh = target[reached[source]]
        fresh = fresh[~reached[fresh]]
        if not len(fresh):
            return reached
        reached[fresh] = True


@kernel(error_model="numpy", forceinline=True)
def _off(place, k, x, y, z):
    """How far the ``k``-th place is from (x, y, z)."""
    dx, dy, dz = place[k, 0] - x, place[k, 1] - y, place[k, 2] - z
    return sqrt(dx * dx + dy * dy + dz * dz)


@allocating_kernel(error_model="numpy")
def shortest_chain(start, target, length, leap_start, leap_target, leap_cost, shut, place, begin, end, goal):
    """The shortest way over the terminals from a start to the ``goal`` (3,) [m], by A*.

    Of the n terminals: start (n + 1,), target (e,) int32, length (e,) [m]: edges; leap_start (n + 1,),
    leap_target (l,) int32, leap_cost (l,) [m]: leaps, and shut (l,) bool: which of them are not on offer;
    place (n, 3) [m]. ``begin`` and ``end`` are terminals and how far they are from the start and from the
    goal: (k,) int32, (k,) [m] each. Nothing is shorter than the straight line. Of equally long ways it is
    always the same.

    Returns (length, terminals (k,), lengths of the ways to each but the first (k - 1,)); infinite, and none,
    where there is no way.
    """
    count = start.size - 1
    x, y, z = goal
    cost, stretch, to_goal = np.full(count, np.inf), np.zeros(count), np.full(count, np.inf)
    parent, closed = np.full(count, -1, np.int32), np.zeros(count, np.bool_)
    most = begin[0].size + target.size + leap_target.size
    keys, items = np.empty(most), np.empty(most, np.int32)
    size, best, final = 0, np.inf, -1
    for i in range(end[0].size):
        to_goal[end[0][i]] = end[1][i]
    for i in range(begin[0].size):
        node = begin[0][i]
        cost[node] = begin[1][i]
        push(keys, items, size, cost[node] + _off(place, node, x, y, z), node)
        size += 1
    while size > 0 and keys[0] < best:
        node = items[0]
        take_first(keys, items, size)
        size -= 1
        if closed[node]:
            continue
        closed[node] = True
        if cost[node] + to_goal[node] < best:
            best, final = cost[node] + to_goal[node], node
        edges = start[node + 1] - start[node]
        for i in range(edges + leap_start[node + 1] - leap_start[node]):
            if i < edges:
                other, far = target[start[node] + i], np.float64(length[start[node] + i])
            else:
                leap = leap_start[node] + i - edges
                if shut[leap]:
                    continue
                other, far = leap_target[leap], leap_cost[leap]
            new = cost[node] + far
            if closed[other] or new >= cost[other] or new >= best:
                continue
            cost[other], parent[other], stretch[other] = new, node, far
            push(keys, items, size, new + _off(place, other, x, y, z), other)
            size += 1
    steps, node = 0, final
    while node >= 0:
        steps, node = steps + 1, parent[node]
    chain, ways = np.empty(steps, np.int32), np.empty(max(steps - 1, 0))
    for i in range(steps - 1, -1, -1):
        chain[i] = final
        if i > 0:
            ways[i - 1] = stretch[final]
        final = parent[final]
    return best, chain, ways
