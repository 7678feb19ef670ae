"""Cells of the surface: where the centre of a column's square is a floor point, and who neighbours whom."""

import math

import numpy as np

from navmesh.level.raster import (
    AX,
    AY,
    BX,
    BY,
    CX,
    CY,
    FLOOR,
    HIGHEST,
    KIND,
    PART,
    SAME_SURFACE,
    SLOPE_X,
    SLOPE_Y,
    TOUCH,
    UPRIGHT,
    height_at,
    is_over,
    middle_of,
)
from navmesh.level.solids import inside_solid
from navmesh.surface.ledges import GAP, comes_first, floor_at
from navmesh.surface.risers import faces_up, on_riser
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["find_floors", "neighbours_within_step"]


_LEVELS = 8
"""Most gaps above each other that are closed in one column."""


@kernel(error_model="numpy")
def _nearest_on(table, f, x, y):
    """The place on the outline of a triangle, seen from above, that is nearest to (x, y): (distance, x,
    y)."""
    least, at_x, at_y = np.inf, x, y
    for k in range(3):
        j = 3 * k + 3 if k < 2 else 0
        ax, ay = table[f, 3 * k], table[f, 3 * k + 1]
        ex, ey = table[f, j] - ax, table[f, j + 1] - ay
        length = ex * ex + ey * ey
        t = min(max(((x - ax) * ex + (y - ay) * ey) / length, 0.0), 1.0) if length > 0.0 else 0.0
        away = math.hypot(ax + t * ex - x, ay + t * ey - y)
        if away < least:
            least, at_x, at_y = away, ax + t * ex, ay + t * ey
    return least, at_x, at_y


@kernel(error_model="numpy", forceinline=True)
def _is_beyond(table, f, x, y, reach):
    """Whether a triangle's bounds, seen from above, are more than ``reach`` from (x, y) along an axis."""
    reach += TOUCH
    return (
        max(table[f, AX], table[f, BX], table[f, CX]) < x - reach
        or min(table[f, AX], table[f, BX], table[f, CX]) > x + reach
        or max(table[f, AY], table[f, BY], table[f, CY]) < y - reach
        or min(table[f, AY], table[f, BY], table[f, CY]) > y + reach
    )


@kernel(error_model="numpy")
def _close_gaps(
    table, start, triangle, patch, c, x, y, hit, hits, step, headroom,
    cell_column, height, gradient, first, cells, tried, crossing,
):  # fmt: skip
    """Add a cell to column ``c`` for each floor whose gap, narrower than `GAP`, holds the centre (x, y).

    ``hit`` (hits, 4) are the mesh parts over the centre; the column's cells begin at ``first``; ``tried`` has
    room for `_LEVELS` heights, ``crossing`` for what `inside_solid` wants. Returns the new number of cells.
    """
    for turn in range(_LEVELS):
        best, chosen, at_x, at_y, z = GAP, -1, x, y, 0.0
        for k in range(start[c], start[c + 1]):
            f = triangle[k]
            if table[f, KIND] != FLOOR:
                break
            if _is_beyond(table, f, x, y, best):
                continue
            level = height_at(table, f, x, y)
            known = False
            for i in range(first, cells):
                known |= abs(height[i] - level) <= step
            for i in range(turn):
                known |= abs(tried[i] - level) <= step
            if known:
                continue
            away, px, py = _nearest_on(table, f, x, y)
            if away < best or (away == best and chosen >= 0 and comes_first(table, f, chosen)):
                best, chosen, at_x, at_y, z = away, f, px, py, level
        if chosen < 0:
            break
        tried[turn] = z
        if best < 1e-12:
            continue
        free = True
        for j in range(hits):
            free &= not z + SAME_SURFACE < hit[j, 0] < z + headroom
        free = free and not inside_solid(table, start, triangle, c, x, y, z, crossing)
        beyond = GAP / best
        if not free or (
            floor_at(
                table, start, triangle, patch,
                at_x + beyond * (x - at_x), at_y + beyond * (y - at_y), z, step, headroom,
            ) < 0
        ):  # fmt: skip
            continue
        at = cells
        while at > first and height[at - 1] > z:
            height[at] = height[at - 1]
            gradient[at, 0], gradient[at, 1] = gradient[at - 1, 0], gradient[at - 1, 1]
            at -= 1
        height[at] = z
        gradient[at, 0], gradient[at, 1] = table[chosen, SLOPE_X], table[chosen, SLOPE_Y]
        cell_column[cells] = c
        cells += 1
    return cells


@allocating_kernel(error_model="numpy", nogil=True)
def find_floors(table, start, triangle, patch, slope, step, headroom):
    """Rule 1 at the centre of every column; one in a gap narrower than `navmesh.surface.ledges.GAP` is on its
    floor.

    ``table``, ``start``, ``triangle`` come from `navmesh.level.raster`; ``slope`` is the tangent of the
    steepest slope walked on. Returns ``column_start`` (columns + 1,) int32, ``cell_column`` (n,) int32,
    ``height`` (n,) and ``gradient`` (n, 2) float64; cells of a column go upwards. On a riser the gradient is
    cut to ``slope``, so that neighbours on the floors at its foot and head meet it within a step.
    """
    columns = patch.nx * patch.ny
    most = 1
    for c in range(columns):
        most = max(most, start[c + 1] - start[c])
    limit = triangle.shape[0]  # each cell of a column stands for another triangle of it
    cell_column = np.empty(limit, np.int32)
    height = np.empty(limit, np.float64)
    gradient = np.empty((limit, 2), np.float64)
    column_start = np.empty(columns + 1, np.int32)
    hit = np.empty((most, 4), np.float64)
    face = np.empty(most, np.int32)
    tried = np.empty(_LEVELS)
    crossing = np.empty((most, 4))
    cells = 0
    for c in range(columns):
        column_start[c] = cells
        if start[c + 1] == start[c]:
            continue
        x, y = middle_of(patch, c)
        hits = 0
        walkable = False
        lowest, highest = np.inf, -np.inf  # the floors that the column touches, at its centre
        lid = -np.inf  # no face of a closed part is higher here
        for k in range(start[c], start[c + 1]):
            f = triangle[k]
            if table[f, KIND] == UPRIGHT:
                if table[f, PART] >= 0.0:
                    lid = max(lid, table[f, HIGHEST])
                continue
            level = height_at(table, f, x, y)
            if table[f, KIND] == FLOOR:
                lowest, highest = min(lowest, level), max(highest, level)
            if not is_over(table, f, x, y):
                continue
            hit[hits, 0] = level
            hit[hits, 1] = table[f, SLOPE_X]
            hit[hits, 2] = table[f, SLOPE_Y]
            hit[hits, 3] = table[f, KIND]
            if table[f, KIND] != FLOOR and not faces_up(table, f):
                hit[hits, 3] = UPRIGHT  # nobody stands on it either
            walkable |= hit[hits, 3] != UPRIGHT
            if table[f, PART] >= 0.0:
                lid = max(lid, level)
            face[hits] = f
            hits += 1
        first = cells
        for i in range(hits if walkable else 0):
            if hit[i, 3] == UPRIGHT:
                continue
            z = hit[i, 0]
            free = True
            for j in range(hits):
                if z + SAME_SURFACE < hit[j, 0] < z + headroom:
                    free = False
                    break
                # of surfaces that coincide the highest stays, then the one with the greater gradient, but a
                # steep one never where there is another
                if hit[j, 3] >= hit[i, 3] and j != i and abs(hit[j, 0] - z) <= SAME_SURFACE:
                    later = hit[j, 0] == z and (
                        (hit[j, 1], hit[j, 2]) > (hit[i, 1], hit[i, 2])
                        or ((hit[j, 1], hit[j, 2]) == (hit[i, 1], hit[i, 2]) and j < i)
                    )
                    if hit[j, 3] > hit[i, 3] or hit[j, 0] > z or later:
                        free = False
                        break
            if not free or (
                z + SAME_SURFACE < lid and inside_solid(table, start, triangle, c, x, y, z, crossing)
            ):
                continue
            cut = 1.0
            if hit[i, 3] != FLOOR:
                if not on_riser(table, start, triangle, patch, face[i], x, y, step, headroom):
                    continue
                cut = slope / math.hypot(hit[i, 1], hit[i, 2])
            at = cells
            while at > first and height[at - 1] > z:
                height[at] = height[at - 1]
                gradient[at, 0] = gradient[at - 1, 0]
                gradient[at, 1] = gradient[at - 1, 1]
                at -= 1
            height[at] = z
            gradient[at, 0] = cut * hit[i, 1]
            gradient[at, 1] = cut * hit[i, 2]
            cell_column[cells] = c
            cells += 1
        known = highest < lowest or (
            cells == first + 1 and highest - height[first] <= step and height[first] - lowest <= step
        )
        if not known:  # there may be floor that no cell of the column stands for
            cells = _close_gaps(
                table, start, triangle, patch, c, x, y, hit, hits, step, headroom,
                cell_column, height, gradient, first, cells, tried, crossing,
            )  # fmt: skip
    column_start[columns] = cells
    return column_start, cell_column[:cells].copy(), height[:cells].copy(), gradient[:cells].copy()


@allocating_kernel(error_model="numpy", nogil=True)
def neighbours_within_step(column_start, cell_column, height, gradient, patch, step):
    """Floors of adjoining columns that meet within ``step`` at the shared border: (n, 4) int32 or -1.

    Heights are compared where the squares meet, so that a slope does not count as a step. Each cell takes
    the nearest in height, and only where that choice is mutual.
    """
    cells = cell_column.shape[0]
    link = np.full((cells, 4), -1, np.int32)
    half = 0.5 * patch.side
    for c in range(cells):
        column = cell_column[c]
        for d in range(2):
            other = column + patch.ny if d == 0 else column + 1
            z = height[c] + gradient[c, d] * half
            best = step + TOUCH
            chosen = -1
            for n in range(column_start[other], column_start[other + 1]):
                difference = abs(height[n] - gradient[n, d] * half - z)
                if difference <= best:
                    best = difference
                    chosen = n
            if chosen < 0:
                continue
            back = height[chosen] - gradient[chosen, d] * half
            mutual = True
            for m in range(column_start[column], column_start[column + 1]):
                if m != c and abs(height[m] + gradient[m, d] * half - back) < best:
                    mutual = False
            if mutual and link[chosen, d + 2] < 0:
                link[c, d] = chosen
                link[chosen, d + 2] = c
    return link
