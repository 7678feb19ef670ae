"""Triangles into the columns of a grid, in float64 and around a local origin.

Conservative: a triangle is recorded in every column whose square it touches, so that a wall without
thickness is never missed. What is in a column is decided later, on the triangles themselves.

Kernels are handed the table and a number, not the triangle's row: counting who holds a view of it took two
fifths of a build.
"""

import math

import numpy as np

from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "FLOOR",
    "PLANE",
    "SAME_SURFACE",
    "TOUCH",
    "UPRIGHT",
    "columns_of_triangles",
    "is_over",
    "prepare_triangles",
]

UPRIGHT, PLANE, FLOOR = 0.0, 1.0, 2.0
"""Kinds of triangle: without a height as a function of (x, y); with one; walkable by its slope."""
TOUCH = 1e-9
"""[m] What is this close touches: squares, triangles and heights."""
SAME_SURFACE = 0.01
"""[m] Parts of the mesh this close in height are one surface."""


@kernel
def is_over(table, f, x, y):
    """Whether a prepared triangle that has a height covers (x, y); its edges belong to it."""
    one = (table[f, 3] - table[f, 0]) * (y - table[f, 1]) - (table[f, 4] - table[f, 1]) * (x - table[f, 0])
    two = (table[f, 6] - table[f, 3]) * (y - table[f, 4]) - (table[f, 7] - table[f, 4]) * (x - table[f, 3])
    three = (table[f, 0] - table[f, 6]) * (y - table[f, 7]) - (table[f, 1] - table[f, 7]) * (x - table[f, 6])
    return (one >= -1e-9 and two >= -1e-9 and three >= -1e-9) or (
        one <= 1e-9 and two <= 1e-9 and three <= 1e-9
    )


@allocating_kernel
def prepare_triangles(vertices, faces, part, origin, steepest):
    """Triangles with what the kernels ask of them.

    ``vertices`` (v, 3) float64, ``faces`` (f, 3) int32, ``part`` (f,) int32 the closed part of each or -1
    (`navmesh.solids`), ``origin`` (3,) float64 is subtracted; ``steepest`` is the least vertical part of a
    walkable face's unit normal. Returns (t, 16) float64, without the triangles that have no area: ax ay az
    bx by bz cx cy cz, the plane p q s (z = p·x + q·y + s), least z, greatest z, the kind, and the part.
    """
    count = faces.shape[0]
    table = np.empty((count, 16), np.float64)
    kept = 0
    for f in range(count):
        for k in range(3):
            for j in range(3):
                table[kept, 3 * k + j] = vertices[faces[f, k], j] - origin[j]
        ux, uy, uz = (
            table[kept, 3] - table[kept, 0],
            table[kept, 4] - table[kept, 1],
            table[kept, 5] - table[kept, 2],
        )
        vx, vy, vz = (
            table[kept, 6] - table[kept, 0],
            table[kept, 7] - table[kept, 1],
            table[kept, 8] - table[kept, 2],
        )
        normal_x = uy * vz - uz * vy
        normal_y = uz * vx - ux * vz
        normal_z = ux * vy - uy * vx
        size = math.sqrt(normal_x * normal_x + normal_y * normal_y + normal_z * normal_z)
        if size < 1e-12:
            continue
        table[kept, 12] = min(table[kept, 2], table[kept, 5], table[kept, 8])
        table[kept, 13] = max(table[kept, 2], table[kept, 5], table[kept, 8])
        if abs(normal_z) < 1e-3 * size:
            table[kept, 9] = table[kept, 10] = table[kept, 11] = 0.0
            table[kept, 14] = UPRIGHT
        else:
            table[kept, 9] = -normal_x / normal_z
            table[kept, 10] = -normal_y / normal_z
            table[kept, 11] = (
                table[kept, 2] - table[kept, 9] * table[kept, 0] - table[kept, 10] * table[kept, 1]
            )
            table[kept, 14] = FLOOR if normal_z >= steepest * size else PLANE
        table[kept, 15] = part[f]
        kept += 1
    return table[:kept]


@allocating_kernel
def columns_of_triangles(table, resolution, nx, ny, window):
    """The triangles that touch each column, as lists: ``start`` (nx·ny + 1,) and ``triangle`` (k,) int32.

    ``table`` comes from `prepare_triangles`. Column ix·ny + iy is the square
    [ix, ix + 1] × [iy, iy + 1] in units of ``resolution``. Only columns from (window[0], window[1]) up to,
    not
    including, (window[2], window[3]) get any.
    """
    count = table.shape[0]
    inverse = 1.0 / resolution
    strips = 0
    for t in range(count):
        low = min(table[t, 0], table[t, 3], table[t, 6]) - TOUCH
        high = max(table[t, 0], table[t, 3], table[t, 6]) + TOUCH
        strips += max(
            min(window[2] - 1, math.floor(high * inverse)) - max(window[0], math.floor(low * inverse)) + 1, 0
        )
    span = np.empty((strips, 3), np.int32)
    start = np.zeros(nx * ny + 2, np.int32)
    spans = 0
    for t in range(count):
        low = min(table[t, 0], table[t, 3], table[t, 6]) - TOUCH
        high = max(table[t, 0], table[t, 3], table[t, 6]) + TOUCH
        first = max(window[0], math.floor(low * inverse))
        last = min(window[2] - 1, math.floor(high * inverse))
        for ix in range(first, last + 1):
            x0 = ix * resolution - TOUCH
            x1 = (ix + 1) * resolution + TOUCH
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
            span[spans, 0] = t
            span[spans, 1] = ix * ny + iy0
            span[spans, 2] = ix * ny + iy1 + 1
            start[ix * ny + iy0 + 1] += 1
            start[ix * ny + iy1 + 2] -= 1
            spans += 1
    # differences -> counts -> starts; `fill` walks each column's next free place
    columns = nx * ny
    fill = np.empty(columns, np.int32)
    running = 0
    total = 0
    start[0] = 0
    for c in range(columns):
        running += start[c + 1]
        fill[c] = total
        total += running
    triangle = np.empty(total, np.int32)
    for k in range(spans):
        t = span[k, 0]
        for c in range(span[k, 1], span[k, 2]):
            triangle[fill[c]] = t
            fill[c] += 1
    start[0] = 0
    for c in range(columns):
        start[c + 1] = fill[c]
    return start[: columns + 1], triangle
