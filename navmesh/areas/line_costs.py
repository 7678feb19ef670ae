"""What a straight line over the surface costs, by the areas that it crosses."""

from math import sqrt

import numpy as np

from navmesh.areas.areas import PARTS
from navmesh.surface.clearance_field import same_place, slope_at
from navmesh.surface.columns import column_of
from navmesh.surface.storeys import linked
from surefoot.kernels import kernel

__all__ = ["area_at", "price"]


@kernel(error_model="numpy", forceinline=True)
def _part_of(at):
    """The part of a cell, 0 to PARTS - 1, at ``at`` parts from its side."""
    part = int(at)
    return 0 if part < 0 else (PARTS - 1 if part >= PARTS else part)


@kernel(error_model="numpy")
def area_at(net, areas, k, x, y):
    """The area of (x, y), at most a cell away from cell ``k``; -1 where no floor is linked to it there."""
    h = net.cell
    ix, iy = divmod(column_of(net, k), net.ny)
    jx, jy = int(x // h), int(y // h)
    other = np.int64(k)
    if jx != ix:
        other = linked(net, other, 0 if jx > ix else 2)
    if jy != iy and other >= 0:
        other = linked(net, other, 1 if jy > iy else 3)
    if other < 0 and jx != ix and jy != iy:
        other = linked(net, k, 1 if jy > iy else 3)
        if other >= 0:
            other = linked(net, other, 0 if jx > ix else 2)
    if other < 0:
        return -1
    row = areas.row[other]
    if row < 0:
        return np.int64(areas.area[other])
    px, py = _part_of((x / h - jx) * PARTS), _part_of((y / h - jy) * PARTS)
    return np.int64(areas.part[row, px * PARTS + py])


@kernel(error_model="numpy")
def _in_parts(part, row, weight, x, y, dx, dy, length):
    """What ``length`` [m] of a line in one cell cost. It begins at (x, y), in parts from the cell's corner,
    and goes on by (dx, dy) parts a metre."""
    px, py = _part_of(x), _part_of(y)
    step_x, step_y = (1 if dx > 0.0 else -1), (1 if dy > 0.0 else -1)
    next_x = (px + (step_x > 0) - x) / dx if dx != 0.0 else 1e300
    next_y = (py + (step_y > 0) - y) / dy if dy != 0.0 else 1e300
    every_x = abs(1.0 / dx) if dx != 0.0 else 1e300
    every_y = abs(1.0 / dy) if dy != 0.0 else 1e300
    s = total = 0.0
    while True:
        leave = min(next_x, next_y, length)
        if leave > s:
            total += (leave - s) * weight[part[row, px * PARTS + py]]
            s = leave
        if leave >= length:
            return total
        if next_x < next_y:
            px += step_x
            next_x += every_x
            if px < 0 or px >= PARTS:
                px -= step_x
                next_x = 1e300
        else:
            py += step_y
            next_y += every_y
            if py < 0 or py >= PARTS:
                py -= step_y
                next_y = 1e300


@kernel(error_model="numpy")
def price(net, areas, weight, k, ax, ay, bx, by, target, most):
    """What the straight line from a, in cell ``k``, to b in cell ``target`` costs [m], if a metre in each
    area costs its ``weight``; inf where it is more than ``most``, or the line does not lead there.

    ``areas`` is an `Areas`, with its parts or what `dearest` makes of them. Always that: of a bundle with the
    same arrays Numba would compile another kernel.
    """
    h = net.cell
    dx, dy = bx - ax, by - ay
    length = sqrt(dx * dx + dy * dy)
    k = np.int64(k)
    if length < 1e-12:
        return 0.0 if same_place(net, k, target) else np.inf
    ux, uy = dx / length, dy / length
    column = column_of(net, k)
    ix = column // net.ny
    iy = column - ix * net.ny
    way_x, turn_x = (0, 1) if dx > 0.0 else (2, -1)
    way_y, turn_y = (1, 1) if dy > 0.0 else (3, -1)
    next_x = ((ix + (turn_x > 0)) * h - ax) / ux if ux != 0.0 else 1e300
    next_y = ((iy + (turn_y > 0)) * h - ay) / uy if uy != 0.0 else 1e300
    step_x = h / abs(ux) if ux != 0.0 else 1e300
    step_y = h / abs(uy) if uy != 0.0 else 1e300
    scale = PARTS / h
    area, row, part = areas
    s = total = 0.0
    while True:
        leave = min(next_x, next_y, length)
        if leave > s:
            slope_x, slope_y = slope_at(net, k)
            rise = slope_x * ux + slope_y * uy
            steep = sqrt(1.0 + rise * rise)
            if row[k] < 0:
                total += (leave - s) * steep * weight[area[k]]
            else:
                x, y = (ax + s * ux) * scale - ix * PARTS, (ay + s * uy) * scale - iy * PARTS
                total += steep * _in_parts(part, row[k], weight, x, y, ux * scale, uy * scale, leave - s)
            if total > most:
                return np.inf
            s = leave
        if leave >= length:
            return total if same_place(net, k, target) else np.inf
        if next_x < next_y:
            next_x += step_x
            ix += turn_x
            k = linked(net, k, way_x)
        else:
            next_y += step_y
            iy += turn_y
            k = linked(net, k, way_y)
        if k < 0:
            return np.inf
