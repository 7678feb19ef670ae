"""The last resort of string pulling: a search over the cells themselves, where no straight line can be
mended."""

import numpy as np

from navmesh.routes.heap import push, take_first
from navmesh.routes.leading_round import lead_round, push_off
from navmesh.routes.walked_line import append_corner
from navmesh.surface.clearance_field import centre_of, gap_at, walk
from navmesh.surface.columns import column_of
from navmesh.surface.storeys import linked
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["DETOURS", "over_cells", "search_cells"]

DETOURS = 6
"""Place in scratch.numbers that counts these searches."""

_TIGHT = 25.0
"""Cost factor of cells whose centre is short of the radius by less than a cell: only where there is no other
way."""
_PASSED = 8
"""Cells that may be passed over because no straight line leads to their middle."""


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
    goal_x, goal_y = divmod(column_of(net, goal), net.ny)
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
            other = linked(net, k, way)
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
                column = column_of(net, other)
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


@kernel(error_model="numpy", forceinline=True)
def _fits_on(net, k, ax, ay, x, y, radius):
    """Whether a body of ``radius`` gets straight from a, in cell ``k``, to (x, y)."""
    reached, _, gap = walk(net, k, ax, ay, x, y, radius, True)[:3]
    return reached and gap >= radius * (1.0 - 1e-9)


@allocating_kernel(error_model="numpy")
def _step_to(net, doors, scratch, first, count, height, x, y, k):
    """Add a line from the leg's last corner to (x, y) in cell ``k``: straight, or led round what is too near.
    The stack has ``height`` entries. Returns the new count and whether the body fits."""
    radius, stack, stack_cell = doors.radius, scratch.stack, scratch.stack_cell
    a = np.int64(scratch.cells[count - 1])
    ax, ay = scratch.points[count - 1, 0], scratch.points[count - 1, 1]
    reached, _, gap, place, qx, qy, tight = walk(net, a, ax, ay, x, y, radius, True)
    bends = 0
    if not reached or gap < radius * (1.0 - 1e-9):
        if not reached or height + 2 > stack_cell.size:
            return count, False
        px, py = ax + place * (x - ax), ay + place * (y - ay)
        bends = lead_round(net, scratch, height, tight, ax, ay, px, py, x, y, qx, qy, radius)
        if bends == 0:
            return count, False
        for i in range(height + bends - 1, height - 1, -1):
            if not _fits_on(net, a, ax, ay, stack[i, 0], stack[i, 1], radius):
                return count, False
            a, ax, ay = np.int64(stack_cell[i]), stack[i, 0], stack[i, 1]
        if not _fits_on(net, a, ax, ay, x, y, radius):
            return count, False
    for i in range(height + bends - 1, height - 1, -1):
        count = append_corner(
            net, doors, scratch, first, count, stack[i, 0], stack[i, 1], np.int64(stack_cell[i])
        )
    return append_corner(net, doors, scratch, first, count, x, y, k), True


@allocating_kernel(error_model="numpy")
def over_cells(net, doors, scratch, first, count, height, gx, gy, goal_cell):
    """Add a line from the leg's last corner to g that follows cells; returns the new count and whether the
    body fits."""
    radius = doors.radius
    cells = search_cells(net, scratch, np.int64(scratch.cells[count - 1]), goal_cell, radius)
    if cells.size == 0 or count + 3 * cells.size > scratch.cells.size:
        return count, False
    missed = 0
    for step in range(1, cells.size):
        k, x, y = goal_cell, gx, gy
        if step < cells.size - 1:
            k = np.int64(cells[step])
            x, y = centre_of(net, k)
            if net.clearance[k] < radius:
                _, qx, qy = gap_at(net, k, x, y)
                _, x, y, k = push_off(net, k, x, y, qx, qy, radius)
        count, fits = _step_to(net, doors, scratch, first, count, height, x, y, k)
        missed = 0 if fits else missed + 1
        if missed > _PASSED:
            return count, False
    return count, missed == 0
