"""How far each cell is from where walking ends.

`seed_clearance` measures the exact horizontal distance to walls and to the ends of the floor for the cells
beside them; `spread_clearance` carries the nearest places on, in two passes over the links, so that storeys
come for free.
"""

import numpy as np
from numba import njit

from navmesh.ledges import floor_end
from navmesh.walls import clip_band, nearest_on_polygon, range_in_column, wall_base

__all__ = ["seed_clearance", "spread_clearance"]


@njit(cache=True)
def _beside(link, c, dx, dy):
    """The cell one reaches from c by dx along x and dy along y (each -1, 0, 1) over links, or -1."""
    first = -1 if dx == 0 else link[c, 0 if dx > 0 else 2]
    second = -1 if dy == 0 else link[c, 1 if dy > 0 else 3]
    if dy == 0:
        return first
    if dx == 0:
        return second
    if first >= 0:
        there = link[first, 1 if dy > 0 else 3]
        if there >= 0:
            return there
    if second >= 0:
        return link[second, 0 if dx > 0 else 2]
    return -1


@njit(cache=True)
def seed_clearance(
    table, start, triangle, base, cell_column, height, gradient, link, resolution, ny, step, headroom
):
    """The vector to the nearest wall or floor end, for every cell beside one; (inf, inf) for the others: (n, 2)."""
    cells = cell_column.shape[0]
    nearest = np.full((cells, 2), np.inf)
    polygon = np.empty((8, 3))
    spare = np.empty((8, 3))
    half = 0.5 * resolution
    around = np.empty(9, np.int32)
    for c in range(cells):
        edge = base[c] < np.inf
        for dx in range(-1, 2):
            for dy in range(-1, 2):
                n = c if dx == 0 and dy == 0 else _beside(link, c, dx, dy)
                around[3 * dx + dy + 4] = n
                edge |= n < 0 or base[n] < np.inf
        if not edge:
            continue
        column = cell_column[c]
        ix = column // ny
        x = (ix + 0.5) * resolution
        y = (column - ix * ny + 0.5) * resolution
        best = np.inf
        for dx in range(-1, 2):
            for dy in range(-1, 2):
                n = around[3 * dx + dy + 4]
                there = column + dx * ny + dy
                if n >= 0 and base[n] == np.inf or start[there] == start[there + 1]:
                    continue
                rx, ry = x + dx * resolution, y + dy * resolution
                if n >= 0:
                    z, p, q, lowest = height[n], gradient[n, 0], gradient[n, 1], base[n]
                    px, py = rx, ry
                else:
                    z, p, q = height[c], gradient[c, 0], gradient[c, 1]
                    px, py = x, y
                    here = z + (p * dx + q * dy) * half
                    lowest = (
                        wall_base(table, start, triangle, there, rx, ry, here, resolution, step) + here - z
                    )
                slope = (abs(p) + abs(q)) * resolution * 1.5
                for k in range(start[there], start[there + 1]):
                    row = table[triangle[k]]
                    low, high = range_in_column(row, rx, ry, half)
                    if high <= z + lowest - slope or low >= z + headroom + slope:
                        continue
                    count = clip_band(row, px, py, z, p, q, lowest, headroom, polygon, spare)
                    if count == 0:
                        continue
                    vx, vy = nearest_on_polygon(polygon, count, x, y)
                    if vx * vx + vy * vy < best:
                        best = vx * vx + vy * vy
                        nearest[c, 0] = vx
                        nearest[c, 1] = vy
        for d in range(4):
            if link[c, d] >= 0:
                continue
            dx = (1 if d == 0 else 0) - (1 if d == 2 else 0)
            dy = (1 if d == 1 else 0) - (1 if d == 3 else 0)
            t = floor_end(
                table,
                start,
                triangle,
                resolution,
                ny,
                x,
                y,
                dx,
                dy,
                height[c],
                gradient[c, 0],
                gradient[c, 1],
                step,
                headroom,
            )
            if t * t < best:
                best = t * t
                nearest[c, 0] = t * dx
                nearest[c, 1] = t * dy
    return nearest


@njit(cache=True)
def _take(nearest, squared, c, n, dx, dy):
    """Let cell c consider the nearest place of cell n, whose centre lies (dx, dy) from c's."""
    if n < 0 or squared[n] == np.inf:
        return
    vx = nearest[n, 0] + dx
    vy = nearest[n, 1] + dy
    length = vx * vx + vy * vy
    if length < squared[c]:
        squared[c] = length
        nearest[c, 0] = vx
        nearest[c, 1] = vy


@njit(cache=True)
def spread_clearance(column_start, link, nearest, resolution, nx, ny):
    """Carry the nearest places of `seed_clearance` over the links, in place; returns the clearance (n,)."""
    cells = link.shape[0]
    squared = nearest[:, 0] ** 2 + nearest[:, 1] ** 2
    h = resolution
    for turn in range(2):
        back_x, back_y, on_y = (2, 3, 1) if turn == 0 else (0, 1, 3)
        s = -h if turn == 0 else h
        for strip in range(nx):
            ix = strip if turn == 0 else nx - 1 - strip
            first, last = column_start[ix * ny], column_start[(ix + 1) * ny]
            for k in range(first, last):
                c = k if turn == 0 else first + last - 1 - k
                n = link[c, back_x]
                if n >= 0:
                    _take(nearest, squared, c, n, s, 0.0)
                    _take(nearest, squared, c, link[n, back_y], s, s)
                    _take(nearest, squared, c, link[n, on_y], s, -s)
                n = link[c, back_y]
                if n >= 0:
                    _take(nearest, squared, c, n, 0.0, s)
                    _take(nearest, squared, c, link[n, back_x], s, s)
                n = link[c, on_y]
                if n >= 0:
                    _take(nearest, squared, c, link[n, back_x], s, -s)
            for k in range(first, last):
                c = first + last - 1 - k if turn == 0 else k
                _take(nearest, squared, c, link[c, on_y], 0.0, -s)
    return np.sqrt(squared)
