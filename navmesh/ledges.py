"""Rule 3: where the floor ends on the way from a cell to a neighbour that it is not linked to."""

import math

import numpy as np
from numba import njit

__all__ = ["floor_at", "floor_end", "is_over"]


@njit(cache=True)
def is_over(row, x, y):
    """Whether a prepared triangle that has a height covers (x, y); its edges belong to it."""
    one = (row[3] - row[0]) * (y - row[1]) - (row[4] - row[1]) * (x - row[0])
    two = (row[6] - row[3]) * (y - row[4]) - (row[7] - row[4]) * (x - row[3])
    three = (row[0] - row[6]) * (y - row[7]) - (row[1] - row[7]) * (x - row[6])
    return (one >= -1e-9 and two >= -1e-9 and three >= -1e-9) or (
        one <= 1e-9 and two <= 1e-9 and three <= 1e-9
    )


@njit(cache=True)
def floor_at(table, start, triangle, resolution, ny, x, y, z, step, headroom):
    """The prepared triangle that is floor (rule 1) at (x, y) within ``step`` of z, or -1."""
    column = int(math.floor(x / resolution)) * ny + int(math.floor(y / resolution))
    chosen = -1
    at = -np.inf
    for k in range(start[column], start[column + 1]):
        row = table[triangle[k]]
        if row[14] != 2.0:
            continue
        here = row[9] * x + row[10] * y + row[11]
        if abs(here - z) <= step + 1e-9 and here > at and is_over(row, x, y):
            chosen = triangle[k]
            at = here
    if chosen < 0:
        return -1
    for k in range(start[column], start[column + 1]):
        row = table[triangle[k]]
        if row[14] == 0.0:
            continue
        here = row[9] * x + row[10] * y + row[11]
        if at + 0.01 < here < at + headroom and is_over(row, x, y):
            return -1
    return chosen


@njit(cache=True)
def floor_end(table, start, triangle, resolution, ny, x, y, dx, dy, z, p, q, step, headroom):
    """How far the floor goes on from (x, y) in direction (dx, dy), up to one ``resolution`` [m].

    The floor at the start is the plane of height z and gradient (p, q); bisection, to 1/64 of a cell.
    """
    low = 0.0
    high = resolution
    for _ in range(6):
        t = 0.5 * (low + high)
        here = z + t * (p * dx + q * dy)
        if (
            floor_at(table, start, triangle, resolution, ny, x + t * dx, y + t * dy, here, step, headroom)
            >= 0
        ):
            low = t
        else:
            high = t
    return 0.5 * (low + high)
