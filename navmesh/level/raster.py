"""Triangles into the columns of a grid, in float64 and around a local origin.

Conservative: a triangle is recorded in every column whose square it touches, so that a wall without
thickness is never missed. What is in a column is decided later, on the triangles themselves.

Kernels are handed the table and a number, not the triangle's row: counting who holds a view of it took two
fifths of a build.
"""

import math
from typing import NamedTuple

import numpy as np

from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "AX", "AY", "AZ", "BX", "BY", "BZ", "COLUMNS", "CX", "CY", "CZ", "FALL", "FLOOR", "HEIGHT_AT_ORIGIN",
    "HIGHEST", "KIND", "LOWEST", "PART", "PLANE", "SAME_SURFACE", "SLOPE_X", "SLOPE_Y", "TOUCH", "UPHILL_X",
    "UPHILL_Y", "UPRIGHT", "Patch", "column_at", "columns_of_triangles", "height_at", "is_over", "middle_of",
    "near_triangles", "prepare_triangles",
]  # fmt: skip

AX, AY, AZ, BX, BY, BZ, CX, CY, CZ = range(9)
"""Columns of a table of triangles: the corners [m]."""
SLOPE_X, SLOPE_Y, HEIGHT_AT_ORIGIN = 9, 10, 11
"""The plane: dz/dx, dz/dy, and z [m] at x = y = 0; all 0 if the triangle is upright."""
LOWEST, HIGHEST = 12, 13
"""[m] least and greatest z."""
KIND = 14
"""`UPRIGHT`, `PLANE` or `FLOOR`."""
PART = 15
"""The closed part of the mesh that it belongs to (`navmesh.level.solids`), or -1."""
FALL, UPHILL_X, UPHILL_Y = 16, 17, 18
"""The length of (dz/dx, dz/dy), and the unit vector along it; only of those of kind `PLANE`."""
COLUMNS = 19

UPRIGHT, PLANE, FLOOR = 0.0, 1.0, 2.0
"""Kinds of triangle: without a height as a function of (x, y); with one; walkable by its slope."""
TOUCH = 1e-9
"""[m] What is this close touches: squares, triangles and heights."""
SAME_SURFACE = 0.01
"""[m] Parts of the mesh this close in height are one surface."""


class Patch(NamedTuple):
    """Columns that are looked at together: a rectangle of the grid. All by itself it is a grid, too."""

    side: float
    """[m], of a column's square."""
    left: int
    """The grid's number ix of the patch's first columns."""
    near: int
    """The grid's number iy of these."""
    nx: int
    ny: int
    """How many there are: column (ix - left)·ny + iy - near is the square [ix, ix + 1] × [iy, iy + 1] in
    units of `side`."""


@kernel(error_model="numpy", forceinline=True)
def middle_of(patch, column):
    """x and y of the middle of a column's square."""
    ix = column // patch.ny
    iy = column - ix * patch.ny
    return (ix + patch.left + 0.5) * patch.side, (iy + patch.near + 0.5) * patch.side


@kernel(error_model="numpy", forceinline=True)
def column_at(patch, x, y):
    """The column that (x, y) is in, or -1 where the patch has none."""
    ix = math.floor(x / patch.side) - patch.left
    iy = math.floor(y / patch.side) - patch.near
    return ix * patch.ny + iy if 0 <= ix < patch.nx and 0 <= iy < patch.ny else -1


@kernel(error_model="numpy")
def height_at(table, f, x, y):
    """Height [m] of triangle ``f``'s plane at (x, y); it is not upright."""
    return table[f, SLOPE_X] * x + table[f, SLOPE_Y] * y + table[f, HEIGHT_AT_ORIGIN]


@kernel(error_model="numpy")
def is_over(table, f, x, y):
    """Whether a prepared triangle that has a height covers (x, y); its edges belong to it."""
    one = (table[f, BX] - table[f, AX]) * (y - table[f, AY]) - (table[f, BY] - table[f, AY]) * (
        x - table[f, AX]
    )
    two = (table[f, CX] - table[f, BX]) * (y - table[f, BY]) - (table[f, CY] - table[f, BY]) * (
        x - table[f, BX]
    )
    three = (table[f, AX] - table[f, CX]) * (y - table[f, CY]) - (table[f, AY] - table[f, CY]) * (
        x - table[f, CX]
    )
    return (one >= -1e-9 and two >= -1e-9 and three >= -1e-9) or (
        one <= 1e-9 and two <= 1e-9 and three <= 1e-9
    )


@allocating_kernel(error_model="numpy", nogil=True)
def prepare_triangles(vertices, faces, part, origin, steepest):
    """Triangles with what the kernels ask of them.

    ``vertices`` (v, 3) float64, ``faces`` (f, 3) int32, ``part`` (f,) int32 the closed part of each or -1
    (`navmesh.level.solids`), ``origin`` (3,) float64 is subtracted; ``steepest`` is the least vertical part
    of a walkable face's unit normal. Returns (t, COLUMNS) float64, without the triangles that have no area.
    """
    count = faces.shape[0]
    table = np.empty((count, COLUMNS), np.float64)
    kept = 0
    for f in range(count):
        for k in range(3):
            for j in range(3):
                table[kept, 3 * k + j] = vertices[faces[f, k], j] - origin[j]
        ux, uy, uz = (
            table[kept, BX] - table[kept, AX],
            table[kept, BY] - table[kept, AY],
            table[kept, BZ] - table[kept, AZ],
        )
        vx, vy, vz = (
            table[kept, CX] - table[kept, AX],
            table[kept, CY] - table[kept, AY],
            table[kept, CZ] - table[kept, AZ],
        )
        normal_x = uy * vz - uz * vy
        normal_y = uz * vx - ux * vz
        normal_z = ux * vy - uy * vx
        size = math.sqrt(normal_x * normal_x + normal_y * normal_y + normal_z * normal_z)
        if size < 1e-12:
            continue
        table[kept, LOWEST] = min(table[kept, AZ], table[kept, BZ], table[kept, CZ])
        table[kept, HIGHEST] = max(table[kept, AZ], table[kept, BZ], table[kept, CZ])
        if abs(normal_z) < 1e-3 * size:
            table[kept, SLOPE_X] = table[kept, SLOPE_Y] = table[kept, HEIGHT_AT_ORIGIN] = 0.0
            table[kept, KIND] = UPRIGHT
        else:
            table[kept, SLOPE_X] = -normal_x / normal_z
            table[kept, SLOPE_Y] = -normal_y / normal_z
            table[kept, HEIGHT_AT_ORIGIN] = (
                table[kept, AZ]
                - table[kept, SLOPE_X] * table[kept, AX]
                - table[kept, SLOPE_Y] * table[kept, AY]
            )
            table[kept, KIND] = FLOOR if normal_z >= steepest * size else PLANE
            if table[kept, KIND] == PLANE:
                fall = math.hypot(table[kept, SLOPE_X], table[kept, SLOPE_Y])
                table[kept, FALL] = fall
                table[kept, UPHILL_X] = table[kept, SLOPE_X] / fall
                table[kept, UPHILL_Y] = table[kept, SLOPE_Y] / fall
        table[kept, PART] = part[f]
        kept += 1
    return table[:kept]


@allocating_kernel(error_model="numpy", nogil=True)
def near_triangles(vertices, faces, low, high):
    """The triangles whose bounds touch the rectangle from ``low`` to ``high`` (2,): (k,) int32, rising."""
    near = np.empty(faces.shape[0], np.int32)
    count = 0
    for f in range(faces.shape[0]):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        touches = True
        for axis in range(2):
            least = min(vertices[a, axis], vertices[b, axis], vertices[c, axis])
            most = max(vertices[a, axis], vertices[b, axis], vertices[c, axis])
            touches &= most >= low[axis] and least <= high[axis]
        if touches:
            near[count] = f
            count += 1
    return near[:count].copy()


@allocating_kernel(error_model="numpy", nogil=True)
def columns_of_triangles(table, patch, window):
    """The triangles that touch each column, as lists: ``start`` (columns + 1,) and ``triangle`` (k,) int32.

    Those of a column are in the order of their kinds, `FLOOR` first and `UPRIGHT` last, so that who looks for
    floor need not look at the others. ``table`` comes from `prepare_triangles`. Only columns from (window[0],
    window[1]) up to, not including, (window[2], window[3]) get any, which are in the `Patch`.
    """
    count = table.shape[0]
    side, ny = patch.side, patch.ny
    inverse = 1.0 / side
    strips = 0
    for t in range(count):
        low = min(table[t, AX], table[t, BX], table[t, CX]) - TOUCH
        high = max(table[t, AX], table[t, BX], table[t, CX]) + TOUCH
        strips += max(
            min(window[2] - 1, math.floor(high * inverse)) - max(window[0], math.floor(low * inverse)) + 1, 0
        )
    span = np.empty((strips, 4), np.int32)
    start = np.zeros(patch.nx * ny + 2, np.int32)
    spans = 0
    for t in range(count):
        low = min(table[t, AX], table[t, BX], table[t, CX]) - TOUCH
        high = max(table[t, AX], table[t, BX], table[t, CX]) + TOUCH
        first = max(window[0], math.floor(low * inverse))
        last = min(window[2] - 1, math.floor(high * inverse))
        for ix in range(first, last + 1):
            x0 = ix * side - TOUCH
            x1 = (ix + 1) * side + TOUCH
            bottom = np.inf
            top = -np.inf
            for k in range(3):
                ax = table[t, 3 * k]
                ay = table[t, 3 * k + 1]
                j = 3 * k + 3 if k < 2 else 0
                bx = table[t, j]
                by = table[t, j + 1]
                if ax > bx:
                    ax, ay, bx, by = bx, by, ax, ay
                if bx < x0 or ax > x1:
                    continue
                if ax < x0:
                    ay += (by - ay) * (x0 - ax) / (bx - ax)
                    ax = x0
                if bx > x1:
                    by = ay + (by - ay) * (x1 - ax) / (bx - ax)
                bottom = min(bottom, ay, by)
                top = max(top, ay, by)
            if bottom > top:
                continue
            iy0 = max(window[1], math.floor((bottom - TOUCH) * inverse))
            iy1 = min(window[3] - 1, math.floor((top + TOUCH) * inverse))
            if iy1 < iy0:
                continue
            first_column = (ix - patch.left) * ny + iy0 - patch.near
            after = first_column + iy1 + 1 - iy0
            span[spans, 0], span[spans, 1], span[spans, 2] = t, first_column, after
            span[spans, 3] = np.int32(table[t, KIND])
            start[first_column + 1] += 1
            start[after + 1] -= 1
            spans += 1
    # differences -> counts -> starts; `fill` walks each column's next free place
    columns = patch.nx * ny
    fill = np.empty(columns, np.int32)
    running = 0
    total = 0
    start[0] = 0
    for c in range(columns):
        running += start[c + 1]
        fill[c] = total
        total += running
    triangle = np.empty(total, np.int32)
    for kind in (FLOOR, PLANE, UPRIGHT):
        for k in range(spans):
            if span[k, 3] != kind:
                continue
            for c in range(span[k, 1], span[k, 2]):
                triangle[fill[c]] = span[k, 0]
                fill[c] += 1
    start[0] = 0
    for c in range(columns):
        start[c + 1] = fill[c]
    return start[: columns + 1], triangle
