"""How far each cell is from where walking ends: the nearest places that the cells beside walls and the ends
of the floor know (`navmesh.surface.blockers`), carried on in two passes over the links, so that storeys come
for free.
"""

import numpy as np

from navmesh.surface.clearance_field import centre_of, gap_at
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["settle_clearance", "spread_clearance"]


@allocating_kernel
def spread_clearance(column_start, link, nearest, source, resolution, nx, ny):
    """Carry the nearest places over the links, in place; returns the clearance (n,).

    ``nearest`` (n, 2) float64 are the vectors of `navmesh.surface.blockers.nearest_blockers`, ``source`` (n,)
    int32 the cell whose list of blockers the place is from, or -1.

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
                origin = c
                before = best
                n = link[c, back]
                m = link[c, side]
                if n >= 0:
                    vx, vy = nearest[n, 0] + h, nearest[n, 1]
                    if vx * vx + vy * vy < best:
                        best, bx, by, origin = vx * vx + vy * vy, vx, vy, n
                    diagonal = link[n, other]
                    if diagonal >= 0:
                        vx, vy = nearest[diagonal, 0] + h, nearest[diagonal, 1] - h
                        if vx * vx + vy * vy < best:
                            best, bx, by, origin = vx * vx + vy * vy, vx, vy, diagonal
                    diagonal = link[n, side]
                    if diagonal >= 0:
                        vx, vy = nearest[diagonal, 0] + h, nearest[diagonal, 1] + h
                        if vx * vx + vy * vy < best:
                            best, bx, by, origin = vx * vx + vy * vy, vx, vy, diagonal
                elif m >= 0:
                    diagonal = link[m, back]
                    if diagonal >= 0:
                        vx, vy = nearest[diagonal, 0] + h, nearest[diagonal, 1] + h
                        if vx * vx + vy * vy < best:
                            best, bx, by, origin = vx * vx + vy * vy, vx, vy, diagonal
                if m >= 0:
                    vx, vy = nearest[m, 0], nearest[m, 1] + h
                    if vx * vx + vy * vy < best:
                        best, bx, by, origin = vx * vx + vy * vy, vx, vy, m
                if best < before:
                    squared[c] = best
                    nearest[c, 0] = bx
                    nearest[c, 1] = by
                    source[c] = source[origin]
            for k in range(first, last):
                c = first + last - 1 - k if turn == 0 else k
                n = link[c, other]
                if n >= 0:
                    vx, vy = nearest[n, 0], nearest[n, 1] - h
                    if vx * vx + vy * vy < squared[c]:
                        squared[c] = vx * vx + vy * vy
                        nearest[c, 0] = vx
                        nearest[c, 1] = vy
                        source[c] = source[n]
    return np.sqrt(squared)


@kernel
def settle_clearance(field):
    """Measure the clearance of cells within two cells of where walking ends, in place, in the lists of the
    cells around: what was carried over the links is the nearest place of another cell."""
    for c in range(field.clearance.shape[0]):
        if field.clearance[c] < 2.0 * field.cell:
            x, y = centre_of(field, c)
            gap, qx, qy = gap_at(field, c, x, y)
            if gap < field.clearance[c]:
                field.clearance[c] = gap
                field.nearest[c, 0], field.nearest[c, 1] = qx - x, qy - y
