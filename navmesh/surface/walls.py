"""Rule 2: parts of the mesh that a body standing on the floor cannot pass, however thin."""

import numpy as np

from navmesh.level.raster import (
    FLOOR,
    HIGHEST,
    KIND,
    LOWEST,
    SLOPE_X,
    SLOPE_Y,
    TOUCH,
    UPRIGHT,
    height_at,
    middle_of,
)
from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "clip_band",
    "cut_links_at_walls",
    "find_walls",
    "nearest_on_polygon",
    "range_in_column",
    "wall_base",
]


@kernel(error_model="numpy")
def clip_band(table, f, x, y, z, p, q, low, high, polygon, spare):
    """The part of a triangle between ``low`` and ``high`` above the plane through (x, y, z), seen from above.

    Fills ``polygon`` (8, 2) and returns its number of corners (0: nothing in the band).
    """
    count = 3
    for k in range(3):
        spare[k, 0] = table[f, 3 * k]
        spare[k, 1] = table[f, 3 * k + 1]
        spare[k, 2] = table[f, 3 * k + 2] - z - p * (table[f, 3 * k] - x) - q * (table[f, 3 * k + 1] - y)
    kept = 0
    for k in range(count):
        j = k + 1 if k + 1 < count else 0
        a, b = spare[k, 2] - low, spare[j, 2] - low
        if a > 0.0:
            polygon[kept, 0], polygon[kept, 1], polygon[kept, 2] = spare[k, 0], spare[k, 1], spare[k, 2]
            kept += 1
        if (a > 0.0) != (b > 0.0):
            t = a / (a - b)
            for i in range(3):
                polygon[kept, i] = spare[k, i] + t * (spare[j, i] - spare[k, i])
            kept += 1
    count = kept
    for k in range(count):
        for i in range(3):
            spare[k, i] = polygon[k, i]
    kept = 0
    for k in range(count):
        j = k + 1 if k + 1 < count else 0
        a, b = high - spare[k, 2], high - spare[j, 2]
        if a > 0.0:
            polygon[kept, 0], polygon[kept, 1] = spare[k, 0], spare[k, 1]
            kept += 1
        if (a > 0.0) != (b > 0.0):
            t = a / (a - b)
            polygon[kept, 0] = spare[k, 0] + t * (spare[j, 0] - spare[k, 0])
            polygon[kept, 1] = spare[k, 1] + t * (spare[j, 1] - spare[k, 1])
            kept += 1
    return kept


@kernel(error_model="numpy")
def nearest_on_polygon(polygon, count, x, y):
    """The vector (dx, dy) from (x, y) to the nearest point of a convex polygon that may be flat."""
    best = np.inf
    dx = 0.0
    dy = 0.0
    left = True
    right = True
    for k in range(count):
        j = k + 1 if k + 1 < count else 0
        ax, ay = polygon[k, 0] - x, polygon[k, 1] - y
        ex, ey = polygon[j, 0] - polygon[k, 0], polygon[j, 1] - polygon[k, 1]
        side = ax * ey - ay * ex
        left &= side > 0.0
        right &= side < 0.0
        length = ex * ex + ey * ey
        t = 0.0
        if length > 0.0:
            t = min(1.0, max(0.0, -(ax * ex + ay * ey) / length))
        px, py = ax + t * ex, ay + t * ey
        if px * px + py * py < best:
            best = px * px + py * py
            dx = px
            dy = py
    if left or right:
        return 0.0, 0.0
    return dx, dy


@kernel(error_model="numpy")
def _crosses_polygon(polygon, count, ax, ay, bx, by):
    """Whether the segment a-b meets a convex polygon that may be flat."""
    ex, ey = bx - ax, by - ay
    low, high = np.inf, -np.inf
    for k in range(count):
        side = (polygon[k, 0] - ax) * ey - (polygon[k, 1] - ay) * ex
        low = min(low, side)
        high = max(high, side)
    if low > 1e-12 or high < -1e-12:
        return False
    left = True
    right = True
    for k in range(count):
        j = k + 1 if k + 1 < count else 0
        fx, fy = polygon[j, 0] - polygon[k, 0], polygon[j, 1] - polygon[k, 1]
        one = (ax - polygon[k, 0]) * fy - (ay - polygon[k, 1]) * fx
        two = (bx - polygon[k, 0]) * fy - (by - polygon[k, 1]) * fx
        left &= one > 0.0
        right &= one < 0.0
        if (one <= 0.0 and two >= 0.0) or (one >= 0.0 and two <= 0.0):
            p = (polygon[k, 0] - ax) * ey - (polygon[k, 1] - ay) * ex
            r = (polygon[j, 0] - ax) * ey - (polygon[j, 1] - ay) * ex
            if ((p <= 0.0 and r >= 0.0) or (p >= 0.0 and r <= 0.0)) and not (
                one == 0.0 and two == 0.0 and p == 0.0 and r == 0.0
            ):
                return True
            if one == 0.0 and two == 0.0 and p == 0.0 and r == 0.0:
                lowest = min(
                    (polygon[k, 0] - ax) * ex + (polygon[k, 1] - ay) * ey,
                    (polygon[j, 0] - ax) * ex + (polygon[j, 1] - ay) * ey,
                )
                highest = max(
                    (polygon[k, 0] - ax) * ex + (polygon[k, 1] - ay) * ey,
                    (polygon[j, 0] - ax) * ex + (polygon[j, 1] - ay) * ey,
                )
                if highest >= 0.0 and lowest <= ex * ex + ey * ey:
                    return True
    return left or right


@kernel(error_model="numpy")
def range_in_column(table, f, x, y, reach):
    """Bounds of a triangle's height within ``reach`` of (x, y) along both axes."""
    if table[f, KIND] == UPRIGHT:
        return table[f, LOWEST], table[f, HIGHEST]
    middle = height_at(table, f, x, y)
    spread = (abs(table[f, SLOPE_X]) + abs(table[f, SLOPE_Y])) * reach
    return max(table[f, LOWEST], middle - spread), min(table[f, HIGHEST], middle + spread)


@kernel(error_model="numpy")
def wall_base(table, start, triangle, column, x, y, z, side, step):
    """Height above z from which on mesh in the column is a wall: step above the highest floor that a body
    standing at z reaches by steps within the column."""
    reach = 0.0
    grew = True
    while grew:
        grew = False
        for k in range(start[column], start[column + 1]):
            f = triangle[k]
            if table[f, KIND] != FLOOR:
                break
            low, high = range_in_column(table, f, x, y, 0.5 * side)
            if low - z <= reach + step + TOUCH and high - z > reach:
                reach = high - z
                grew = True
    return reach + step


@allocating_kernel(error_model="numpy", nogil=True)
def find_walls(table, start, triangle, cell_column, height, gradient, patch, step, headroom):
    """Height above each cell from which on mesh in its own column is a wall [m], or inf: (n,)."""
    cells = cell_column.shape[0]
    base = np.full(cells, np.inf)
    half = 0.5 * patch.side
    for c in range(cells):
        column = cell_column[c]
        if start[column + 1] - start[column] == 1:
            continue
        z = height[c]
        slope = (abs(gradient[c, 0]) + abs(gradient[c, 1])) * half
        found = False
        x = y = 0.0
        near = False  # whether anything is as high and as low as that anywhere
        for k in range(start[column], start[column + 1]):
            f = triangle[k]
            if table[f, HIGHEST] <= z + step or table[f, LOWEST] >= z + headroom + slope:
                continue
            if not near:
                near = True
                x, y = middle_of(patch, column)
            low, high = range_in_column(table, f, x, y, half)
            if high > z + step and low < z + headroom + slope:
                found = True
                break
        if found:
            lowest = wall_base(table, start, triangle, column, x, y, z, patch.side, step)
            if lowest < headroom:
                base[c] = lowest
    return base


@kernel(error_model="numpy")
def _wall_between(
    table, start, triangle, base, height, gradient, c, column, x, y, ax, ay, bx, by, half, headroom,
    polygon, spare,
):  # fmt: skip
    """Whether a wall in cell c's column crosses the segment a-b."""
    z = height[c]
    slope = (abs(gradient[c, 0]) + abs(gradient[c, 1])) * half
    for k in range(start[column], start[column + 1]):
        f = triangle[k]
        low, high = range_in_column(table, f, x, y, half)
        if high <= z + base[c] - slope or low >= z + headroom + slope:
            continue
        count = clip_band(
            table, f, x, y, z, gradient[c, 0], gradient[c, 1], base[c], headroom, polygon, spare
        )
        if count > 0 and _crosses_polygon(polygon, count, ax, ay, bx, by):
            return True
    return False


@allocating_kernel(error_model="numpy", nogil=True)
def cut_links_at_walls(table, start, triangle, base, cell_column, height, gradient, link, patch, headroom):
    """Cut, in place, the links whose line from centre to centre meets a wall in either column."""
    polygon = np.empty((8, 3))
    spare = np.empty((8, 3))
    half = 0.5 * patch.side
    for c in range(cell_column.shape[0]):
        for d in range(2):
            n = link[c, d]
            if n < 0 or (base[c] == np.inf and base[n] == np.inf):
                continue
            column = cell_column[c]
            ax, ay = middle_of(patch, column)
            bx = ax + patch.side if d == 0 else ax
            by = ay if d == 0 else ay + patch.side
            cut = False
            for k in range(2):
                side, x, y = (c, ax, ay) if k == 0 else (n, bx, by)
                if not cut and base[side] < np.inf:
                    cut = _wall_between(
                        table, start, triangle, base, height, gradient, side, cell_column[side],
                        x, y, ax, ay, bx, by, half, headroom, polygon, spare,
                    )  # fmt: skip
            if cut:
                link[c, d] = -1
                link[n, d + 2] = -1
