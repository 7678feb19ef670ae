"""Rule 3: where the floor ends on the way from a cell to a neighbour that it is not linked to."""

import numpy as np

from navmesh.level.raster import (
    FLOOR,
    KIND,
    SAME_SURFACE,
    TOUCH,
    UPRIGHT,
    column_at,
    height_at,
    is_over,
)
from surefoot.kernels import kernel

__all__ = ["GAP", "comes_first", "floor_at", "floor_end"]

GAP = 0.1
"""[m] Gaps in the floor that are narrower than this are floor: a foot that comes down on one is held by both
sides."""


@kernel(error_model="numpy")
def comes_first(table, one, other):
    """A choice between two triangles that does not depend on their order in the mesh."""
    for k in range(12):
        if table[one, k] != table[other, k]:
            return table[one, k] < table[other, k]
    return False


@kernel(error_model="numpy")
def floor_at(table, start, triangle, patch, x, y, z, step, headroom):
    """The prepared triangle that is floor (rule 1) at (x, y) within ``step`` of z, or -1."""
    column = column_at(patch, x, y)
    chosen = -1
    if column < 0:
        return chosen
    at = -np.inf
    for k in range(start[column], start[column + 1]):
        f = triangle[k]
        if table[f, KIND] != FLOOR:
            break
        here = height_at(table, f, x, y)
        if abs(here - z) > step + TOUCH or here < at or not is_over(table, f, x, y):
            continue
        if here == at and chosen >= 0 and not comes_first(table, f, chosen):
            continue
        chosen = triangle[k]
        at = here
    if chosen < 0:
        return -1
    for k in range(start[column], start[column + 1]):
        f = triangle[k]
        if table[f, KIND] == UPRIGHT:
            break
        here = height_at(table, f, x, y)
        if at + SAME_SURFACE < here < at + headroom and is_over(table, f, x, y):
            return -1
    return chosen


@kernel(error_model="numpy")
def floor_end(table, start, triangle, patch, x, y, d, z, p, q, step, headroom, edge):
    """How far the floor goes on from (x, y) in direction d (`navmesh.surface.surface.DIRECTIONS`), at most a
    cell.

    The floor at the start is the plane of height z and gradient (p, q). Walks from triangle to triangle;
    ``edge`` (4,) receives the edge that ends the floor, as x, y of both its corners. Where something else
    than an edge ends it (a low obstacle, a ceiling), the place is bisected to 1/64 of a cell and both
    corners are that place.
    """
    dx = (1.0 if d == 0 else 0.0) - (1.0 if d == 2 else 0.0)
    dy = (1.0 if d == 1 else 0.0) - (1.0 if d == 3 else 0.0)
    slope = p * dx + q * dy
    t = 0.0
    for _ in range(8):
        ahead = t + 1e-4
        here = floor_at(
            table,
            start,
            triangle,
            patch,
            x + ahead * dx,
            y + ahead * dy,
            z + ahead * slope,
            step,
            headroom,
        )
        if here < 0:
            if t > 0.0:
                return t
            break
        out = np.inf
        for k in range(3):
            j = 3 * k + 3 if k < 2 else 0
            ax, ay = table[here, 3 * k] - x, table[here, 3 * k + 1] - y
            bx, by = table[here, j] - x, table[here, j + 1] - y
            # the edge in a frame along and across the way
            along_a, across_a = ax * dx + ay * dy, ay * dx - ax * dy
            along_b, across_b = bx * dx + by * dy, by * dx - bx * dy
            if (across_a > 0.0) == (across_b > 0.0):
                continue
            s = across_a / (across_a - across_b)
            crossing = along_a + s * (along_b - along_a)
            if ahead < crossing < out:
                out = crossing
                edge[0], edge[1], edge[2], edge[3] = ax + x, ay + y, bx + x, by + y
        if out >= patch.side:
            break
        t = out
    low = 0.0
    high = patch.side
    for _ in range(6):
        t = 0.5 * (low + high)
        if (
            floor_at(table, start, triangle, patch, x + t * dx, y + t * dy, z + t * slope, step, headroom)
            >= 0
        ):
            low = t
        else:
            high = t
    t = 0.5 * (low + high)
    edge[0] = edge[2] = x + t * dx
    edge[1] = edge[3] = y + t * dy
    return t
