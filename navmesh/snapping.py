"""Where a route may begin and end: the place nearest to the one asked for at which the body fits."""

import numpy as np
from numba import njit

from navmesh.field import centre_of, floor_at, gap_at, walk

__all__ = ["roomy_cell", "snap"]

_MARGIN = 0.015  # share of the radius: a little more than what string pulling keeps


@njit(error_model="numpy", cache=True)
def _floor_near(net, x, y, z, rise):
    """The cell with a node under (x, y) whose floor is nearest to ``z`` and within ``rise``, or -1."""
    ix = int(x // net.cell)
    iy = int(y // net.cell)
    if ix < 0 or iy < 0 or ix >= net.nx or iy >= net.ny:
        return -1
    column = ix * net.ny + iy
    best = -1
    least = rise
    for k in range(net.column_start[column], net.column_start[column + 1]):
        off = abs(floor_at(net, k, x, y) - z)
        if off <= least and net.label[k] >= 0:
            least = off
            best = k
    return best


@njit(error_model="numpy", cache=True)
def _sees(net, k, x, y):
    """Whether (x, y) is on this side of what ends walking nearest to the centre of ``k``."""
    cx, cy = centre_of(net, k)
    vx, vy = net.nearest[k, 0], net.nearest[k, 1]
    far = vx * vx + vy * vy
    return far > 0.0 and (x - cx) * vx + (y - cy) * vy < far


@njit(error_model="numpy", cache=True)
def _seeing_cell(net, x, y, z, rise):
    """The cell nearest to (x, y), at most two squares away, that sees it, or -1: beside a thin wall, the
    square under a point may have its centre, and so its cell, on the other side."""
    h = net.cell
    ix = int(x // h)
    iy = int(y // h)
    best = -1
    least = 1e300
    for jx in range(max(ix - 2, 0), min(ix + 3, net.nx)):
        for jy in range(max(iy - 2, 0), min(iy + 3, net.ny)):
            cx, cy = (jx + 0.5) * h, (jy + 0.5) * h
            off = (cx - x) ** 2 + (cy - y) ** 2
            if off < least:
                k = _floor_near(net, cx, cy, z, rise)
                if k >= 0 and _sees(net, k, x, y):
                    least = off
                    best = k
    return best


@njit(error_model="numpy", cache=True)
def _nearest_cell(net, x, y, z, reach, rise):
    """The cell with a node whose centre is nearest to (x, y) horizontally, within ``reach``, or -1."""
    h = net.cell
    rings = int(reach / h) + 1
    ix = int(x // h)
    iy = int(y // h)
    best = -1
    least = reach * reach
    for jx in range(max(ix - rings, 0), min(ix + rings + 1, net.nx)):
        for jy in range(max(iy - rings, 0), min(iy + rings + 1, net.ny)):
            dx = (jx + 0.5) * h - x
            dy = (jy + 0.5) * h - y
            if dx * dx + dy * dy < least:
                k = _floor_near(net, (jx + 0.5) * h, (jy + 0.5) * h, z, rise)
                if k >= 0:
                    least = dx * dx + dy * dy
                    best = k
    return best


@njit(error_model="numpy", cache=True)
def roomy_cell(net, k, x, y, radius, reach):
    """The cell nearest to (x, y), reached over links from ``k`` within ``reach``, whose centre has ``radius``
    free, or -1."""
    h = net.cell
    rings = int(reach / h) + 1
    side = 2 * rings + 1
    seen = np.zeros((side, side), np.uint8)
    queue = np.empty(side * side, np.int32)
    ix0 = net.cell_column[k] // net.ny - rings
    iy0 = net.cell_column[k] % net.ny - rings
    queue[0] = k
    seen[rings, rings] = 1
    size = 1
    head = 0
    best = -1
    least = reach * reach
    while head < size:
        at = queue[head]
        head += 1
        column = net.cell_column[at]
        ix = column // net.ny
        iy = column - ix * net.ny
        dx = (ix + 0.5) * h - x
        dy = (iy + 0.5) * h - y
        off = dx * dx + dy * dy
        if off < least and net.clearance[at] >= radius and net.label[at] >= 0:
            least = off
            best = at
        for way in range(4):
            other = net.link[at, way]
            if other < 0:
                continue
            jx = net.cell_column[other] // net.ny - ix0
            jy = net.cell_column[other] % net.ny - iy0
            if 0 <= jx < side and 0 <= jy < side and not seen[jx, jy]:
                seen[jx, jy] = 1
                queue[size] = other
                size += 1
    return best


@njit(error_model="numpy", cache=True)
def snap(net, x, y, z, radius, reach, rise):
    """The place for a body of ``radius`` nearest to (x, y, z).

    The floor is the one nearest to ``z``, at most ``rise`` above or below it; where there is none straight
    under the point, or the body does not fit, places up to ``reach`` away are taken. Returns (node, cell, x,
    y); node is -1 where there is no such place.
    """
    k = _floor_near(net, x, y, z, rise)
    if k >= 0 and net.clearance[k] >= radius + 0.7072 * net.cell:
        return net.label[k], k, x, y
    if k < 0 or not _sees(net, k, x, y):
        k = _seeing_cell(net, x, y, z, rise)
    if k < 0:
        k = _nearest_cell(net, x, y, z, reach, rise)
        if k < 0:
            return -1, -1, x, y
        column = net.cell_column[k]
        ix = column // net.ny
        x = (ix + 0.5) * net.cell
        y = (column - ix * net.ny + 0.5) * net.cell
    gap, qx, qy = gap_at(net, k, x, y)
    if gap < radius and gap > 1e-6:
        push = radius * (1.0 + _MARGIN) / gap
        nx = qx + (x - qx) * push
        ny = qy + (y - qy) * push
        if radius - gap <= reach:
            reached, cell = walk(net, k, x, y, nx, ny, 0.0, True)[:2]
            if reached:
                after = gap_at(net, cell, nx, ny)[0]
                if after >= radius:
                    x, y, k, gap = nx, ny, cell, after
    if gap >= radius and net.clearance[k] >= radius:
        return net.label[k], k, x, y
    cell = roomy_cell(net, k, x, y, radius, reach)
    if cell < 0:
        return -1, -1, x, y
    if gap >= radius:
        return net.label[cell], k, x, y
    column = net.cell_column[cell]
    ix = column // net.ny
    cx = (ix + 0.5) * net.cell
    cy = (column - ix * net.ny + 0.5) * net.cell
    reached, end = walk(net, k, x, y, cx, cy, 0.0, True)[:2]
    if reached and end == cell:
        low, high = 0.0, 1.0
        for _ in range(8):
            middle = 0.5 * (low + high)
            px = x + middle * (cx - x)
            py = y + middle * (cy - y)
            at = walk(net, k, x, y, px, py, 0.0, True)[1]
            if gap_at(net, at, px, py)[0] >= radius:
                high = middle
            else:
                low = middle
        px = x + high * (cx - x)
        py = y + high * (cy - y)
        at = walk(net, k, x, y, px, py, 0.0, True)[1]
        return net.label[cell], at, px, py
    return net.label[cell], cell, cx, cy
