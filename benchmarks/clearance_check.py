"""Is there room for a body at a point? Asked of the triangles alone: this shares no code with the builder.

From each point rays go out over the floor in all directions, a few centimetres at a time. A ray ends where a part
of the mesh stands more than ``max_step`` and less than ``headroom`` above the floor that it runs on, or where no
floor within ``max_step`` of the last follows for longer than ``crack``.
"""

from math import cos, floor, pi, sin

import numpy as np
from numba import njit

__all__ = ["MeshIndex", "free_distance"]

_STRIDE = 0.04
_HEIGHTS = 8


class MeshIndex:
    """A mesh's triangles filed by squares of 0.5 m, for `free_distance`."""

    def __init__(self, vertices: np.ndarray, faces: np.ndarray, max_slope: float, side: float = 0.5) -> None:
        """``vertices`` (v, 3) float64 [m], Z up; ``faces`` (f, 3); ``max_slope`` [rad]."""
        self.corner = vertices.min(axis=0) - 1.0
        self.triangles = np.ascontiguousarray(vertices[faces] - self.corner)
        a, b, c = self.triangles[:, 0], self.triangles[:, 1], self.triangles[:, 2]
        normal = np.cross(b - a, c - a)
        size = np.linalg.norm(normal, axis=1)
        self.walkable = normal[:, 2] >= (np.cos(max_slope) - 1e-9) * size
        self.walkable &= size > 0.0
        self.side = side
        low = np.floor(self.triangles[:, :, :2].min(axis=1) / side).astype(np.int64)
        high = np.floor(self.triangles[:, :, :2].max(axis=1) / side).astype(np.int64)
        self.shape = high.max(axis=0) + 2
        self.start, self.member = _file(low, high, self.shape[0], self.shape[1])

    def arrays(self) -> tuple:
        """What the kernels take."""
        return self.triangles, self.walkable, self.start, self.member, self.side, self.shape[0], self.shape[1]


@njit(cache=True)
def _file(low, high, nx, ny):
    start = np.zeros(nx * ny + 1, np.int64)
    for t in range(low.shape[0]):
        for ix in range(low[t, 0], high[t, 0] + 1):
            for iy in range(low[t, 1], high[t, 1] + 1):
                start[ix * ny + iy + 1] += 1
    start = np.cumsum(start)
    fill = start[:-1].copy()
    member = np.empty(start[-1], np.int64)
    for t in range(low.shape[0]):
        for ix in range(low[t, 0], high[t, 0] + 1):
            for iy in range(low[t, 1], high[t, 1] + 1):
                member[fill[ix * ny + iy]] = t
                fill[ix * ny + iy] += 1
    return start, member


@njit(cache=True)
def _height(triangle, x, y):
    """Height of the triangle's plane at (x, y) if that lies in the triangle seen from above, else NaN."""
    ax, ay = triangle[0, 0], triangle[0, 1]
    bx, by = triangle[1, 0], triangle[1, 1]
    cx, cy = triangle[2, 0], triangle[2, 1]
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if abs(area) < 1e-12:
        return np.nan
    u = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
    v = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
    w = 1.0 - u - v
    if u < -1e-7 or v < -1e-7 or w < -1e-7:
        return np.nan
    return u * triangle[0, 2] + v * triangle[1, 2] + w * triangle[2, 2]


@njit(cache=True)
def _floor(mesh, x, y, z, step, headroom):
    """The walkable height at (x, y) nearest to ``z`` and within ``step``, with ``headroom`` above it, or NaN."""
    triangles, walkable, start, member, side, nx, ny = mesh
    ix, iy = int(floor(x / side)), int(floor(y / side))
    if ix < 0 or iy < 0 or ix >= nx or iy >= ny:
        return np.nan
    first, last = start[ix * ny + iy], start[ix * ny + iy + 1]
    best = np.nan
    least = step
    for i in range(first, last):
        t = member[i]
        if not walkable[t]:
            continue
        h = _height(triangles[t], x, y)
        if np.isnan(h) or abs(h - z) > least:
            continue
        free = True
        for j in range(first, last):
            other = _height(triangles[member[j]], x, y)
            if not np.isnan(other) and h + 0.01 < other < h + headroom:
                free = False
                break
        if free:
            least = abs(h - z)
            best = h
    return best


@njit(cache=True)
def _crossed(mesh, ax, ay, bx, by, z):
    """Whether the level line from a to b at height ``z`` meets a triangle."""
    triangles, walkable, start, member, side, nx, ny = mesh
    dx, dy = bx - ax, by - ay
    for ix in range(int(floor(min(ax, bx) / side)), int(floor(max(ax, bx) / side)) + 1):
        for iy in range(int(floor(min(ay, by) / side)), int(floor(max(ay, by) / side)) + 1):
            if ix < 0 or iy < 0 or ix >= nx or iy >= ny:
                continue
            for i in range(start[ix * ny + iy], start[ix * ny + iy + 1]):
                p = triangles[member[i]]
                e1 = p[1] - p[0]
                e2 = p[2] - p[0]
                # direction (dx, dy, 0)
                hx, hy, hz = dy * e2[2], -dx * e2[2], dx * e2[1] - dy * e2[0]
                det = e1[0] * hx + e1[1] * hy + e1[2] * hz
                if abs(det) < 1e-14:
                    continue
                sx, sy, sz = ax - p[0, 0], ay - p[0, 1], z - p[0, 2]
                u = (sx * hx + sy * hy + sz * hz) / det
                if u < 0.0 or u > 1.0:
                    continue
                qx, qy, qz = sy * e1[2] - sz * e1[1], sz * e1[0] - sx * e1[2], sx * e1[1] - sy * e1[0]
                v = (dx * qx + dy * qy) / det
                if v < 0.0 or u + v > 1.0:
                    continue
                t = (e2[0] * qx + e2[1] * qy + e2[2] * qz) / det
                if 0.0 <= t <= 1.0:
                    return True
    return False


@njit(cache=True)
def _ray(mesh, x, y, z, dx, dy, limit, step, headroom, crack):
    """How far one ray gets, at most ``limit``."""
    reached = 0.0
    missing = -1.0
    fz = z
    while reached < limit:
        there = min(reached + _STRIDE, limit)
        px, py = x + there * dx, y + there * dy
        h = _floor(mesh, px, py, fz, step, headroom)
        if np.isnan(h):
            if missing < 0.0:
                missing = reached
            if there - missing > crack:
                return missing
        else:
            missing = -1.0
        base = fz if np.isnan(h) else max(fz, h)
        qx, qy = x + reached * dx, y + reached * dy
        for i in range(_HEIGHTS):
            level = base + step + 0.02 + (headroom - step - 0.04) * i / (_HEIGHTS - 1)
            if _crossed(mesh, qx, qy, px, py, level):
                return reached
        if not np.isnan(h):
            fz = h
        reached = there
    return limit if missing < 0.0 else (limit if limit - missing <= crack else missing)


@njit(cache=True)
def _measure(mesh, points, limit, step, headroom, crack, directions):
    count = points.shape[0]
    free = np.empty(count)
    for i in range(count):
        x, y = points[i, 0], points[i, 1]
        z = _floor(mesh, x, y, points[i, 2], step + 0.3, headroom)
        if np.isnan(z):
            free[i] = -1.0
            continue
        least = limit
        for k in range(directions):
            angle = 2.0 * pi * k / directions
            least = min(least, _ray(mesh, x, y, z, cos(angle), sin(angle), least, step, headroom, crack))
            if least <= 0.0:
                break
        free[i] = least
    return free


def free_distance(
    index: MeshIndex,
    points: np.ndarray,
    limit: float,
    max_step: float,
    headroom: float,
    crack: float,
    directions: int = 48,
) -> np.ndarray:
    """(n,) float64 [m]: how far walking goes on around each of ``points`` (n, 3), at most ``limit``.

    -1 where the point has no walkable floor within ``max_step`` + 0.3 m. ``crack`` [m]: gaps in the floor up to
    this wide do not end it.
    """
    local = np.ascontiguousarray(points - index.corner)
    return _measure(index.arrays(), local, limit, max_step, headroom, crack, directions)
