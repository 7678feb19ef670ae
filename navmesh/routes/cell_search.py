"""The last resort of string pulling: a search over the cells themselves, where no straight line can be
mended."""

import numpy as np

from navmesh.routes.heap import push, take_first
from surefoot.kernels import allocating_kernel

__all__ = ["DETOURS", "search_cells"]

DETOURS = 6
"""Place in scratch.numbers that counts these searches."""

_TIGHT = 25.0
"""Cost factor of cells whose centre is short of the radius by less than a cell: only where there is no other
way."""


@allocating_kernel(error_model="numpy")
def search_cells(net, scratch, start, goal, radius):
    """Cells (k,) int32 from cell ``start`` to cell ``goal`` over links, shortest for a body of ``radius``;
    empty if none.

    Cells whose centre is short of the radius by less than 0.75 cells count 25 times their length.
    """
    scratch.numbers[DETOURS] += 1
    stamp = scratch.numbers[DETOURS]
    seen = scratch.cell_stamp
    best = scratch.cell_best
    parent = scratch.cell_parent
    keys = np.empty(256, np.float64)
    items = np.empty(256, np.int32)
    h = net.cell
    goal_x = net.cell_column[goal] // net.ny
    goal_y = net.cell_column[goal] % net.ny
    seen[start] = stamp
    best[start] = 0.0
    found = False
    keys[0], items[0] = 0.0, start
    size = 1
    while size > 0:
        k = items[0]
        take_first(keys, items, size)
        size -= 1
        if k == goal:
            found = True
            break
        for way in range(4):
            other = net.link[k, way]
            if other < 0:
                continue
            if other == goal or net.clearance[other] >= radius:
                cost = best[k] + h
            elif net.clearance[other] >= radius - 0.75 * h:
                cost = best[k] + h * _TIGHT
            else:
                continue
            if seen[other] != stamp or cost < best[other] - 1e-9:
                seen[other] = stamp
                best[other] = cost
                parent[other] = k
                if size == keys.size:
                    keys = np.concatenate((keys, np.empty_like(keys)))
                    items = np.concatenate((items, np.empty_like(items)))
                column = net.cell_column[other]
                steps = abs(column // net.ny - goal_x) + abs(column % net.ny - goal_y)
                push(keys, items, size, cost + h * steps, other)
                size += 1
    if not found:
        return np.empty(0, np.int32)
    count = 1
    k = goal
    while k != start:
        k = parent[k]
        count += 1
    cells = np.empty(count, np.int32)
    k = goal
    for i in range(count - 1, -1, -1):
        cells[i] = k
        k = parent[k]
    return cells
