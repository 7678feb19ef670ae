"""Questions to the triangles themselves: what is under a point, what is above it, what crosses a line.

Kernels over the prepared triangles and column lists of `navmesh.level.raster`; all coordinates are relative
to the origin that the triangles were prepared with. `brute_surface_below` and `brute_crossed` are the slow
references of the tests.
"""

import math
from typing import NamedTuple

import numpy as np

from navmesh.level.raster import (
    AX,
    AY,
    AZ,
    BX,
    BY,
    BZ,
    CX,
    CY,
    CZ,
    FLOOR,
    HIGHEST,
    KIND,
    LOWEST,
    UPRIGHT,
    Patch,
    columns_of_triangles,
    height_at,
    prepare_triangles,
)
from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "MeshArrays",
    "MeshGrid",
    "brute_crossed",
    "brute_surface_below",
    "crossed",
    "lowest_above",
    "surface_below",
]

_FINEST, _COARSEST = 0.25, 0.5  # [m] sides of squares: about a triangle each, in levels of less than 500 m
_EDGE = 1e-7  # [m] points this close to a triangle's edge are on it


class MeshArrays(NamedTuple):
    """A `MeshGrid` as kernels take it."""

    triangles: np.ndarray
    """(t, COLUMNS) float64, see `navmesh.level.raster`."""
    start: np.ndarray
    """(nx·ny + 1,): the triangles that touch square c = ix·ny + iy are member[start[c]:start[c + 1]]."""
    member: np.ndarray
    size: float
    """[m], side of a square."""
    nx: int
    ny: int


class MeshGrid:
    """Triangles of a mesh filed by the squares that they touch."""

    def __init__(self, vertices: np.ndarray, faces: np.ndarray, origin: np.ndarray, max_slope: float) -> None:
        """``vertices`` (v, 3) float64 [m], ``faces`` (f, 3) int32, ``origin`` (3,) below and left of all."""
        open_parts = np.full(len(faces), -1, np.int32)  # what is inside of solids is no question here
        self.triangles = prepare_triangles(vertices, faces, open_parts, origin, math.cos(max_slope))
        high = (vertices.max(axis=0) - origin)[:2] if len(vertices) else np.ones(2)
        spacing = math.sqrt(float(high.prod()) / max(len(self.triangles), 1))
        self.size = max(min(max(spacing, _FINEST), _COARSEST), float(high.max()) / 1000.0)
        """[m], side of a square."""
        self.shape = (int(high[0] / self.size) + 1, int(high[1] / self.size) + 1)
        self.start, self.member = columns_of_triangles(
            self.triangles, Patch(self.size, 0, 0, *self.shape), (0, 0, *self.shape)
        )

    @property
    def arrays(self) -> MeshArrays:
        """What the kernels take as ``grid``."""
        return MeshArrays(self.triangles, self.start, self.member, self.size, *self.shape)


@kernel(error_model="numpy", forceinline=True)
def _column(grid, x, y):
    ix = math.floor(x / grid.size)
    iy = math.floor(y / grid.size)
    if ix < 0 or iy < 0 or ix >= grid.nx or iy >= grid.ny:
        return -1
    return ix * grid.ny + iy


@kernel(error_model="numpy", forceinline=True)
def _over(table, f, x, y):
    """Whether (x, y) is inside a prepared triangle that has a height there."""
    turn = 0
    for k in range(3):
        j = 3 * k + 3 if k < 2 else 0
        dx = table[f, j] - table[f, 3 * k]
        dy = table[f, j + 1] - table[f, 3 * k + 1]
        cross = dx * (y - table[f, 3 * k + 1]) - dy * (x - table[f, 3 * k])
        off = abs(cross)
        if off <= _EDGE * (abs(dx) + abs(dy)) and off <= _EDGE * math.sqrt(dx * dx + dy * dy):
            continue
        now = 1 if cross > 0.0 else -1
        if turn == 0:
            turn = now
        elif turn != now:
            return False
    return True


@kernel(error_model="numpy")
def surface_below(grid, x, y, low, high):
    """The highest surface under (x, y) with a height in [low, high].

    Returns (height [m], triangle): the triangle is -1 when there is none. Of surfaces at the same height
    a floor counts before anything else.
    """
    table = grid.triangles
    column = _column(grid, x, y)
    best = -np.inf
    which = -1
    if column < 0:
        return best, which
    for k in range(grid.start[column], grid.start[column + 1]):
        t = grid.member[k]
        if table[t, KIND] == UPRIGHT:
            break
        if table[t, LOWEST] > high or table[t, HIGHEST] < max(best, low) - 1e-6:
            continue
        z = height_at(table, t, x, y)
        if z > high or z < low or z < best - 1e-6:
            continue
        if (
            which >= 0
            and abs(z - best) <= 1e-6
            and not (table[t, KIND] == FLOOR and table[which, KIND] != FLOOR)
        ):
            continue
        if _over(table, t, x, y):
            best = z
            which = t
    return best, which


@kernel(error_model="numpy")
def lowest_above(grid, x, y, low, high):
    """Height [m] of the lowest surface over (x, y) strictly between ``low`` and ``high``, or infinity."""
    table = grid.triangles
    column = _column(grid, x, y)
    best = np.inf
    if column < 0:
        return best
    for k in range(grid.start[column], grid.start[column + 1]):
        t = grid.member[k]
        if table[t, KIND] == UPRIGHT:
            break
        if table[t, HIGHEST] <= low or table[t, LOWEST] >= high or table[t, LOWEST] > best + 1e-6:
            continue
        z = height_at(table, t, x, y)
        if low < z < high and z < best and _over(table, t, x, y):
            best = z
    return best


@kernel(error_model="numpy")
def _hits(table, f, px, py, pz, dx, dy, dz):
    """Whether the segment p to p + d meets a prepared triangle."""
    e1x, e1y, e1z = table[f, BX] - table[f, AX], table[f, BY] - table[f, AY], table[f, BZ] - table[f, AZ]
    e2x, e2y, e2z = table[f, CX] - table[f, AX], table[f, CY] - table[f, AY], table[f, CZ] - table[f, AZ]
    hx = dy * e2z - dz * e2y
    hy = dz * e2x - dx * e2z
    hz = dx * e2y - dy * e2x
    a = e1x * hx + e1y * hy + e1z * hz
    scale = (abs(e1x) + abs(e1y) + abs(e1z)) * (abs(hx) + abs(hy) + abs(hz))
    if abs(a) <= 1e-12 * scale or a == 0.0:
        return False
    sx, sy, sz = px - table[f, AX], py - table[f, AY], pz - table[f, AZ]
    u = (sx * hx + sy * hy + sz * hz) / a
    if u < -1e-9 or u > 1.0 + 1e-9:
        return False
    qx = sy * e1z - sz * e1y
    qy = sz * e1x - sx * e1z
    qz = sx * e1y - sy * e1x
    v = (dx * qx + dy * qy + dz * qz) / a
    if v < -1e-9 or u + v > 1.0 + 1e-9:
        return False
    t = (e2x * qx + e2y * qy + e2z * qz) / a
    return -1e-9 <= t <= 1.0 + 1e-9


@allocating_kernel(error_model="numpy")
def crossed(grid, px, py, pz, qx, qy, qz):
    """Whether anything of the mesh crosses the segment p-q (metres)."""
    table, size = grid.triangles, grid.size
    dx, dy, dz = qx - px, qy - py, qz - pz
    low = min(pz, qz)
    high = max(pz, qz)
    left, right = min(px, qx), max(px, qx)
    first = max(0, math.floor(left / size))
    last = min(grid.nx - 1, math.floor(right / size))
    for ix in range(first, last + 1):
        # the stretch of the segment over this strip of squares
        y0, y1 = py, qy
        if abs(dx) > 1e-12:
            t0 = (max(left, ix * size) - px) / dx
            t1 = (min(right, (ix + 1) * size) - px) / dx
            y0 = py + min(max(t0, 0.0), 1.0) * dy
            y1 = py + min(max(t1, 0.0), 1.0) * dy
        if y0 > y1:
            y0, y1 = y1, y0
        for iy in range(
            max(0, math.floor(y0 / size - 1e-9)), min(grid.ny - 1, math.floor(y1 / size + 1e-9)) + 1
        ):
            column = ix * grid.ny + iy
            for k in range(grid.start[column], grid.start[column + 1]):
                t = grid.member[k]
                if table[t, LOWEST] > high or table[t, HIGHEST] < low:
                    continue
                if _hits(table, t, px, py, pz, dx, dy, dz):
                    return True
    return False


def brute_surface_below(triangles: np.ndarray, x: float, y: float, low: float, high: float) -> float:
    """`surface_below` over all prepared ``triangles`` (t, COLUMNS), by barycentric coordinates; height or
    -inf."""
    best = -math.inf
    for row in triangles:
        a, b, c = row[:9].reshape(3, 3)
        if row[KIND] == UPRIGHT:
            continue
        weights = np.linalg.solve(np.array([[a[0], b[0], c[0]], [a[1], b[1], c[1]], [1, 1, 1]]), [x, y, 1.0])
        z = float(weights @ (a[2], b[2], c[2]))
        if weights.min() >= -1e-9 and low <= z <= high:
            best = max(best, z)
    return best


def brute_crossed(triangles: np.ndarray, p: np.ndarray, q: np.ndarray) -> bool:
    """`crossed` over all prepared ``triangles`` (t, COLUMNS): solves p + t·(q - p) = a + u·(b - a) + v·(c -
    a)."""
    for row in triangles:
        a, b, c = row[:9].reshape(3, 3)
        matrix = np.column_stack((p - q, b - a, c - a))
        if abs(np.linalg.det(matrix)) < 1e-12:
            continue
        t, u, v = np.linalg.solve(matrix, p - a)
        if 0 <= t <= 1 and u >= 0 and v >= 0 and u + v <= 1:
            return True
    return False
