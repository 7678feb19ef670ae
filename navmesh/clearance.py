"""How far each cell is from where walking ends.

`seed_clearance` measures the exact horizontal distance to walls and to the ends of the floor for the cells
beside them; `spread_clearance` carries the nearest places on, in two passes over the links, so that storeys
come for free.
"""

import numpy as np
from numba import njit

from navmesh.ledges import floor_at, floor_end
from navmesh.walls import clip_band, nearest_on_polygon, range_in_column, wall_base

__all__ = ["seed_clearance", "spread_clearance"]

_CORNERS = ((1, 1), (-1, 1), (-1, -1), (1, -1))
"""Where one gets by direction d, then d + 1, of `navmesh.surface.DIRECTIONS`."""


@njit(cache=True)
def _nearest_on_edge(edge, x, y, cross_x, cross_y, reach):
    """The vector from (x, y) to the nearest point of an edge, within ``reach`` of the crossing."""
    if (edge[2], edge[3]) < (edge[0], edge[1]):  # the same answer from either triangle at the edge
        edge[0], edge[1], edge[2], edge[3] = edge[2], edge[3], edge[0], edge[1]
    ex, ey = edge[2] - edge[0], edge[3] - edge[1]
    length = np.sqrt(ex * ex + ey * ey)
    if length < 1e-12:
        return cross_x - x, cross_y - y
    ex /= length
    ey /= length
    middle = (cross_x - edge[0]) * ex + (cross_y - edge[1]) * ey
    t = (x - edge[0]) * ex + (y - edge[1]) * ey
    t = min(max(t, 0.0, middle - reach), length, middle + reach)
    return edge[0] + t * ex - x, edge[1] + t * ey - y


@njit(cache=True)
def seed_clearance(
    table, start, triangle, base, cell_column, height, gradient, link, resolution, ny, step, headroom
):
    """The vector to the nearest wall or floor end for cells beside one, (inf, inf) for the others: (n, 2)."""
    cells = cell_column.shape[0]
    nearest = np.full((cells, 2), np.inf)
    polygon = np.empty((8, 3))
    spare = np.empty((8, 3))
    edge = np.empty(4)
    half = 0.5 * resolution
    for c in range(cells):
        beside = base[c] < np.inf
        for d in range(4):
            n = link[c, d]
            beside |= n < 0 or base[n] < np.inf
        if not beside:
            # a square at a corner may hold the end of a wall that no square to the sides knows
            for d in range(4):
                m = link[link[c, d], (d + 1) % 4]
                beside |= m < 0 or base[m] < np.inf
            if not beside:
                continue
        column = cell_column[c]
        ix = column // ny
        x = (ix + 0.5) * resolution
        y = (column - ix * ny + 0.5) * resolution
        best = np.inf
        for d in range(-1, 8):
            dx = (1 if d == 0 else 0) - (1 if d == 2 else 0)
            dy = (1 if d == 1 else 0) - (1 if d == 3 else 0)
            n = c if d < 0 else link[c, d % 4]
            if d >= 4:
                m = link[c, (d + 1) % 4]
                if n < 0 or m < 0 or base[n] < np.inf or base[m] < np.inf:
                    continue  # those know all of the wall
                dx, dy = _CORNERS[d - 4]
                n = link[n, (d + 1) % 4]
            there = column + dx * ny + dy
            if (n >= 0 and base[n] == np.inf) or start[there] == start[there + 1]:
                continue
            rx, ry = x + dx * resolution, y + dy * resolution
            if n >= 0:
                px, py, z, p, q = rx, ry, height[n], gradient[n, 0], gradient[n, 1]
                lowest = base[n]
            else:
                px, py, z, p, q = x, y, height[c], gradient[c, 0], gradient[c, 1]
                rise = (p * dx + q * dy) * half
                lowest = rise + wall_base(table, start, triangle, there, rx, ry, z + rise, resolution, step)
            slope = (abs(p) + abs(q)) * resolution * 1.5
            for k in range(start[there], start[there + 1]):
                f = triangle[k]
                low, high = range_in_column(table, f, rx, ry, half)
                if high <= z + lowest - slope or low >= z + headroom + slope:
                    continue
                left, right = (
                    min(table[f, 0], table[f, 3], table[f, 6]) - x,
                    max(table[f, 0], table[f, 3], table[f, 6]) - x,
                )
                near, far = (
                    min(table[f, 1], table[f, 4], table[f, 7]) - y,
                    max(table[f, 1], table[f, 4], table[f, 7]) - y,
                )
                away_x, away_y = max(left, -right, 0.0), max(near, -far, 0.0)
                if away_x * away_x + away_y * away_y > best * (1.0 + 1e-9):
                    continue
                count = clip_band(table, f, px, py, z, p, q, lowest, headroom, polygon, spare)
                if count == 0:
                    continue
                vx, vy = nearest_on_polygon(polygon, count, x, y)
                squared = vx * vx + vy * vy
                # equally near places: the same one whatever the order of the triangles
                if squared < best or (squared == best and (vx, vy) < (nearest[c, 0], nearest[c, 1])):
                    best = squared
                    nearest[c, 0] = vx
                    nearest[c, 1] = vy
        for d in range(4):
            if link[c, d] >= 0:
                continue
            dx = (1.0 if d == 0 else 0.0) - (1.0 if d == 2 else 0.0)
            dy = (1.0 if d == 1 else 0.0) - (1.0 if d == 3 else 0.0)
            if best < resolution * resolution:
                # nothing to gain where the floor reaches as far as the wall
                t = np.sqrt(best)
                here = height[c] + t * (gradient[c, 0] * dx + gradient[c, 1] * dy)
                if (
                    floor_at(
                        table, start, triangle, resolution, ny, x + t * dx, y + t * dy, here, step, headroom
                    )
                    >= 0
                ):
                    continue
            t = floor_end(
                table, start, triangle, resolution, ny, x, y, d,
                height[c], gradient[c, 0], gradient[c, 1], step, headroom, edge,
            )  # fmt: skip
            vx, vy = _nearest_on_edge(edge, x, y, x + t * dx, y + t * dy, 0.75 * resolution)
            if vx * vx + vy * vy < best:
                best = vx * vx + vy * vy
                nearest[c, 0] = vx
                nearest[c, 1] = vy
    return nearest


@njit(cache=True)
def spread_clearance(column_start, link, nearest, resolution, nx, ny):
    """Carry the nearest places of `seed_clearance` over the links, in place; returns the clearance (n,).

    Each pass goes over the strips of equal ix, forth and back within a strip; a cell takes from the cells
    behind it, the two diagonal ones included.
    """
    squared = np.empty(link.shape[0])
    for c in range(link.shape[0]):
        squared[c] = nearest[c, 0] * nearest[c, 0] + nearest[c, 1] * nearest[c, 1]
    for turn in range(2):
        back, side, other = (2, 3, 1) if turn == 0 else (0, 1, 3)
        h = -resolution if turn == 0 else resolution
        for strip in range(nx):
            ix = strip if turn == 0 else nx - 1 - strip
            first, last = column_start[ix * ny], column_start[(ix + 1) * ny]
            for k in range(first, last):
                c = k if turn == 0 else first + last - 1 - k
                best = squared[c]
                bx, by = nearest[c, 0], nearest[c, 1]
                before = best
                n = link[c, back]
                m = link[c, side]
                if n >= 0:
                    vx, vy = nearest[n, 0] + h, nearest[n, 1]
                    if vx * vx + vy * vy < best:
                        best, bx, by = vx * vx + vy * vy, vx, vy
                    diagonal = link[n, other]
                    if diagonal >= 0:
                        vx, vy = nearest[diagonal, 0] + h, nearest[diagonal, 1] - h
                        if vx * vx + vy * vy < best:
                            best, bx, by = vx * vx + vy * vy, vx, vy
                    diagonal = link[n, side]
                    if diagonal >= 0:
                        vx, vy = nearest[diagonal, 0] + h, nearest[diagonal, 1] + h
                        if vx * vx + vy * vy < best:
                            best, bx, by = vx * vx + vy * vy, vx, vy
                elif m >= 0:
                    diagonal = link[m, back]
                    if diagonal >= 0:
                        vx, vy = nearest[diagonal, 0] + h, nearest[diagonal, 1] + h
                        if vx * vx + vy * vy < best:
                            best, bx, by = vx * vx + vy * vy, vx, vy
                if m >= 0:
                    vx, vy = nearest[m, 0], nearest[m, 1] + h
                    if vx * vx + vy * vy < best:
                        best, bx, by = vx * vx + vy * vy, vx, vy
                if best < before:
                    squared[c] = best
                    nearest[c, 0] = bx
                    nearest[c, 1] = by
            for k in range(first, last):
                c = first + last - 1 - k if turn == 0 else k
                n = link[c, other]
                if n >= 0:
                    vx, vy = nearest[n, 0], nearest[n, 1] - h
                    if vx * vx + vy * vy < squared[c]:
                        squared[c] = vx * vx + vy * vy
                        nearest[c, 0] = vx
                        nearest[c, 1] = vy
    return np.sqrt(squared)
