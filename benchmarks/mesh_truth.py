"""The walking rule checked on the mesh itself, independent of the graph builder: rays against triangles.

A walker moves along a straight line in small strides. At each stride a vertical ray finds the floor (rule 1
of `navmesh.WalkRules`, risers included), horizontal rays at many heights look for walls (rule 2), and the
floor may be missing for at most one cell (rule 3). Deliberately slow and simple.
"""

import math

import numpy as np
from numba import njit

import navmesh

__all__ = ["MeshTruth"]

_BIN = 0.5  # [m] side of the squares that triangles are sorted into, by their bounding boxes
_RAYS = 12  # horizontal rays per stride, between step and headroom
_DOWNHILL = 0.01  # [m] between the vertical rays along a fall line


@njit
def _sort_into_bins(corners, low_x, low_y, nx, ny, size):
    """Triangles by the bins that their bounding boxes touch, in CSR form."""
    start = np.zeros(nx * ny + 1, np.int64)
    for turn in range(2):
        if turn == 1:
            start = np.concatenate((np.zeros(1, np.int64), np.cumsum(start[:-1])))
            member = np.empty(start[-1] + 1, np.int64)
            place = start[:-1].copy()
        for t in range(corners.shape[0]):
            x0 = int((corners[t, :, 0].min() - low_x - 0.01) // size)
            x1 = int((corners[t, :, 0].max() - low_x + 0.01) // size)
            y0 = int((corners[t, :, 1].min() - low_y - 0.01) // size)
            y1 = int((corners[t, :, 1].max() - low_y + 0.01) // size)
            for ix in range(max(0, x0), min(nx - 1, x1) + 1):
                for iy in range(max(0, y0), min(ny - 1, y1) + 1):
                    if turn == 0:
                        start[ix * ny + iy] += 1
                    else:
                        member[place[ix * ny + iy]] = t
                        place[ix * ny + iy] += 1
    return start, member


@njit
def _bin_of(x, y, frame):
    ix = min(max(int((x - frame[0]) // frame[2]), 0), int(frame[3]) - 1)
    iy = min(max(int((y - frame[1]) // frame[2]), 0), int(frame[4]) - 1)
    return ix * int(frame[4]) + iy


@njit
def _height_at(p, x, y):
    """Height at which a vertical ray at (x, y) meets the face ``p`` (3, 3), by barycentric coordinates; nan
    where it passes by or the face is upright."""
    ax, ay = p[1, 0] - p[0, 0], p[1, 1] - p[0, 1]
    bx, by = p[2, 0] - p[0, 0], p[2, 1] - p[0, 1]
    area = ax * by - ay * bx
    if abs(area) < 1e-12:
        return np.nan
    u = ((x - p[0, 0]) * by - (y - p[0, 1]) * bx) / area
    v = (ax * (y - p[0, 1]) - ay * (x - p[0, 0])) / area
    if u < -1e-7 or v < -1e-7 or u + v > 1 + 1e-7:
        return np.nan
    return p[0, 2] + u * (p[1, 2] - p[0, 2]) + v * (p[2, 2] - p[0, 2])


@njit
def _floor_near(corners, floors, start, member, frame, x, y, z, tolerance, headroom):
    """Height of the floor point at (x, y) nearest to z, at most ``tolerance`` away; nan without one."""
    b = _bin_of(x, y, frame)
    heights = np.empty(start[b + 1] - start[b])
    walkable = np.zeros(start[b + 1] - start[b], np.bool_)
    count = 0
    for k in range(start[b], start[b + 1]):
        height = _height_at(corners[member[k]], x, y)
        if height != height:
            continue
        heights[count] = height
        walkable[count] = floors[member[k]]
        count += 1
    best = np.nan
    for i in range(count):
        if not walkable[i] or abs(heights[i] - z) > tolerance:
            continue
        free = True
        for j in range(count):
            free &= not (heights[i] + 0.0101 < heights[j] < heights[i] + headroom - 1e-6)
        if free and not abs(best - z) <= abs(heights[i] - z):
            best = heights[i]
    return best


@njit
def _is_free(corners, start, member, frame, x, y, z, headroom):
    """Whether no face is above (x, y, z) within the headroom."""
    b = _bin_of(x, y, frame)
    for k in range(start[b], start[b + 1]):
        height = _height_at(corners[member[k]], x, y)  # nan fails the comparison
        if z + 0.0101 < height < z + headroom - 1e-6:
            return False
    return True


@njit
def _steep_near(corners, floors, start, member, frame, x, y, z, tolerance):
    """Height and gradient (p, q) of the steep upward face at (x, y) nearest to z; nan without one."""
    b = _bin_of(x, y, frame)
    best, p, q = np.nan, 0.0, 0.0
    for k in range(start[b], start[b + 1]):
        if floors[member[k]]:
            continue
        c = corners[member[k]]
        ax, ay = c[1, 0] - c[0, 0], c[1, 1] - c[0, 1]
        bx, by = c[2, 0] - c[0, 0], c[2, 1] - c[0, 1]
        area = ax * by - ay * bx
        if area < 1e-9:  # upright or facing down
            continue
        u = ((x - c[0, 0]) * by - (y - c[0, 1]) * bx) / area
        v = (ax * (y - c[0, 1]) - ay * (x - c[0, 0])) / area
        if u < -1e-7 or v < -1e-7 or u + v > 1 + 1e-7:
            continue
        az, bz = c[1, 2] - c[0, 2], c[2, 2] - c[0, 2]
        height = c[0, 2] + u * az + v * bz
        if abs(height - z) <= tolerance and not abs(best - z) <= abs(height - z):
            best = height
            p, q = (az * by - bz * ay) / area, (bz * ax - az * bx) / area
    return best, p, q


@njit
def _riser_near(corners, floors, start, member, frame, x, y, z, tolerance, step, tangent, headroom):
    """Height of the riser at (x, y) nearest to z, at most ``tolerance`` away; nan without one.

    Vertical rays along the fall line, uphill and downhill, look for the floors at its head and foot.
    """
    begin, p0, q0 = _steep_near(corners, floors, start, member, frame, x, y, z, tolerance)
    if np.isnan(begin):
        return np.nan
    apart = 0.0
    for way in (1.0, -1.0):
        px, py, height, p, q = x, y, begin, p0, q0
        floor = np.nan
        for _ in range(int(step / tangent / _DOWNHILL) + 2):
            fall = math.hypot(p, q)
            px += way * p / fall * _DOWNHILL
            py += way * q / fall * _DOWNHILL
            ahead = height + way * fall * _DOWNHILL
            floor = _floor_near(
                corners, floors, start, member, frame, px, py, height, step - abs(height - begin), headroom
            )
            if not np.isnan(floor):
                break
            slack = fall * _DOWNHILL + 0.005
            height, p, q = _steep_near(corners, floors, start, member, frame, px, py, ahead, slack)
            if np.isnan(height) or abs(height - begin) > step:
                break
        if np.isnan(floor):
            return np.nan
        apart += abs(floor - begin)
    # samples of the fall line overshoot the edges of floors that slope by as much as a stride
    if apart > step + 2.0 * _DOWNHILL * tangent:
        return np.nan
    return begin if _is_free(corners, start, member, frame, x, y, begin, headroom) else np.nan


@njit
def _wall_on_way(corners, start, member, frame, ax, ay, bx, by, low, high):
    """Whether a horizontal ray from a to b, at one of many heights from low to high, hits a triangle."""
    dx, dy = bx - ax, by - ay
    b = _bin_of(0.5 * (ax + bx), 0.5 * (ay + by), frame)
    for k in range(start[b], start[b + 1]):
        p = corners[member[k]]
        if max(p[0, 2], p[1, 2], p[2, 2]) < low or min(p[0, 2], p[1, 2], p[2, 2]) > high:
            continue
        e1x, e1y, e1z = p[1, 0] - p[0, 0], p[1, 1] - p[0, 1], p[1, 2] - p[0, 2]
        e2x, e2y, e2z = p[2, 0] - p[0, 0], p[2, 1] - p[0, 1], p[2, 2] - p[0, 2]
        # Moeller and Trumbore for the direction (dx, dy, 0)
        hx, hy, hz = dy * e2z, -dx * e2z, dx * e2y - dy * e2x
        det = e1x * hx + e1y * hy + e1z * hz
        if abs(det) < 1e-14:
            continue
        for i in range(_RAYS):
            z = low + (high - low) * i / (_RAYS - 1)
            sx, sy, sz = ax - p[0, 0], ay - p[0, 1], z - p[0, 2]
            u = (sx * hx + sy * hy + sz * hz) / det
            if u < 0.0 or u > 1.0:
                continue
            qx, qy, qz = sy * e1z - sz * e1y, sz * e1x - sx * e1z, sx * e1y - sy * e1x
            v = (dx * qx + dy * qy) / det
            if v < 0.0 or u + v > 1.0:
                continue
            t = (e2x * qx + e2y * qy + e2z * qz) / det
            if 0.0 <= t <= 1.0:
                return True
    return False


@njit
def _walk(corners, floors, start, member, frame, x, y, z, ux, uy, length, stride, rules):
    """How far one gets from the floor at (x, y, z) in direction (ux, uy), at most ``length`` [m]."""
    tangent, step, headroom, gap = rules
    last = 0.0
    here = 0.0
    while last < length:  # a gap that begins before the end may close behind it
        ahead = here + stride
        px, py = x + here * ux, y + here * uy
        qx, qy = x + ahead * ux, y + ahead * uy
        reach = step + (ahead - last) * tangent + 1e-6
        floor = _floor_near(corners, floors, start, member, frame, qx, qy, z, reach, headroom)
        if np.isnan(floor):
            floor = _riser_near(
                corners, floors, start, member, frame, qx, qy, z, reach, step, tangent, headroom
            )
        top = z if np.isnan(floor) else max(z, floor)
        bottom = z if np.isnan(floor) else min(z, floor)
        slack = (ahead - last) * tangent + 0.02
        if _wall_on_way(
            corners, start, member, frame, px, py, qx, qy, top + step + slack, bottom + headroom - slack
        ):
            return min(last, length)
        if np.isnan(floor):
            if ahead - last > gap + stride:
                return last
        else:
            last = ahead
            z = floor
        here = ahead
    return length


@njit
def _walk_all(corners, floors, start, member, frame, points, directions, lengths, stride, rules):
    reached = np.empty(points.shape[0])
    for i in range(points.shape[0]):
        reached[i] = _walk(
            corners, floors, start, member, frame, points[i, 0], points[i, 1], points[i, 2],
            directions[i, 0], directions[i, 1], lengths[i], stride, rules,
        )  # fmt: skip
    return reached


@njit
def _distances(corners, floors, start, member, frame, points, most, directions, stride, rules):
    distance = np.empty(points.shape[0])
    for i in range(points.shape[0]):
        best = most[i]
        for k in range(directions):
            angle = 2.0 * math.pi * k / directions
            best = min(
                best,
                _walk(
                    corners, floors, start, member, frame, points[i, 0], points[i, 1], points[i, 2],
                    math.cos(angle), math.sin(angle), best, stride, rules,
                ),
            )  # fmt: skip
        distance[i] = best
    return distance


class MeshTruth:
    """What the mesh of ``terrain`` says under ``rules``, in world coordinates."""

    def __init__(self, terrain: navmesh.Terrain, rules: navmesh.WalkRules) -> None:
        self._shift = terrain.bounds[0].copy()
        corners = (terrain.vertices - self._shift)[terrain.faces]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        size = np.linalg.norm(normal, axis=1)
        self._floors = normal[:, 2] >= math.cos(rules.max_slope) * size - 1e-9 * size
        self._floors &= size > 0
        self._corners = corners
        nx, ny = (np.ceil((terrain.bounds[1] - terrain.bounds[0])[:2] / _BIN) + 1).astype(int).tolist()
        self._frame = (0.0, 0.0, _BIN, float(nx), float(ny))
        self._start, self._member = _sort_into_bins(corners, 0.0, 0.0, nx, ny, _BIN)
        self._rules = (math.tan(rules.max_slope), rules.max_step, rules.headroom, rules.resolution)

    def _arguments(self, points: np.ndarray) -> tuple:
        return (
            self._corners, self._floors, self._start, self._member, self._frame,
            np.ascontiguousarray(points - self._shift),
        )  # fmt: skip

    def reached(
        self, points: np.ndarray, directions: np.ndarray, lengths: np.ndarray, stride: float = 0.05
    ) -> np.ndarray:
        """How far [m] one walks from ``points`` (k, 3) in ``directions`` (k, 2), at most ``lengths``."""
        return _walk_all(*self._arguments(points), directions, lengths, stride, self._rules)

    def distance(
        self, points: np.ndarray, most: np.ndarray, directions: int = 72, stride: float = 0.01
    ) -> np.ndarray:
        """Horizontal distance [m] from ``points`` (k, 3) to where walking ends, up to ``most``: (k,)."""
        return _distances(*self._arguments(points), most, directions, stride, self._rules)
