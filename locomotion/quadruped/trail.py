"""A trail: a quadruped's path as a table of evenly spaced rows for kernels.

The path's points become a cubic spline, so that directions and curvatures have no jumps; it is laid onto the
ground, with the highest speed at each place.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from locomotion.errors import LocomotionError
from locomotion.ground.ground import Ground, height_below
from locomotion.paths.tracking import checked_points
from locomotion.quadruped import layout as at
from locomotion.quadruped.body import Body
from locomotion.quadruped.cubic_spline import along_spline, length_along, natural_spline
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["NoTrail", "Trail", "kernel_ground", "lay_trail", "trail_at", "trail_point", "trail_speed"]

SPACING = 0.05
"""[m] between rows, at most."""
_KNOTS = 0.1  # [m] between the spline's knots, at most: stays close at corners that were not smoothed
_GRAVITY = 9.81  # [m/s²]
_CREEP = 0.25  # [m/s] slowest speed of a bend, however tight
_CLIMBING = 0.25  # of √(g · height of the hips): fastest change of height on a slope, up or down
_CLIMB = 0.35  # [m] above the last row's ground from which the next is searched


class NoTrail(LocomotionError):
    """A path that an animal cannot follow."""


@dataclass(frozen=True)
class Trail:
    """rows (n, ROW) float64 as in `layout`, ``step`` [m] apart; ``length`` [m] of all, horizontal."""

    rows: NDArray[np.float64]
    step: float

    @property
    def length(self) -> float:
        return self.step * (len(self.rows) - 1)

    @property
    def points(self) -> NDArray[np.float64]:
        """(n, 3) float64 [m]"""
        return self.rows[:, [at.PX, at.PY, at.PZ]]

    def point(self, arc: float) -> NDArray[np.float64]:
        """(2,) [m] at an arc length [m], also before the start and behind the end."""
        return np.array(trail_point(self.rows, 0, len(self.rows), self.step, arc)[:2])

    def heading(self, arc: float) -> float:
        """[rad] at an arc length [m]."""
        return float(trail_at(self.rows, 0, len(self.rows), self.step, arc)[3])


def lay_trail(points: ArrayLike, body: Body, ground: Ground) -> Trail:
    """The trail along ``points`` (k, 3) [m], near the ground, for a body.

    Raises `LocomotionError` for wrong shapes, coordinates that are not finite, fewer than two points that
    differ in x or y, or a path that leaves the ground.
    """
    knots = _subdivided(checked_points(points))
    arc = _arc(knots)
    pieces = natural_spline(arc, knots[:, :2])
    fine = np.linspace(0.0, arc[-1], max(round(arc[-1] / 0.005), 16))
    along = np.empty(len(fine))
    length_along(arc, pieces, fine, along)
    count = max(int(np.ceil(along[-1] / SPACING)), 2) + 1
    where = np.interp(np.linspace(0.0, along[-1], count), along, fine)
    rows, (place, first, second) = np.zeros((count, at.ROW)), np.empty((3, count, 2))
    along_spline(arc, pieces, where, place, first, second)
    rows[:, at.PX : at.PY + 1] = place
    speed = np.linalg.norm(first, axis=1)
    rows[:, at.PCOS : at.PSIN + 1] = first / speed[:, None]
    rows[:, at.PHEADING] = np.unwrap(np.arctan2(first[:, 1], first[:, 0]))
    rows[:, at.PCURVATURE] = (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / speed**3
    rows[:, at.PZ] = _drape(rows, np.interp(where, arc, knots[:, 2]), ground)
    step = along[-1] / (count - 1)
    _plan_speed(rows, step, body)
    return Trail(rows, float(step))


def _arc(points: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1))])


def _subdivided(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distinct points, with more on long straight stretches."""
    apart = np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1) > 1e-4
    keep = points[np.concatenate([[True], apart])]
    if len(keep) < 2:
        raise NoTrail("a path needs at least two points that differ in x or y")
    parts = np.ceil(np.linalg.norm(np.diff(keep[:, :2], axis=0), axis=1) / _KNOTS).astype(int)
    part = np.arange(1, parts.sum() + 1) - np.repeat(np.cumsum(parts) - parts, parts)
    share = (part / np.repeat(parts, parts))[:, None]
    between = np.repeat(keep[:-1], parts, axis=0) + share * np.repeat(np.diff(keep, axis=0), parts, axis=0)
    return np.concatenate([keep[:1], between])


def _drape(rows: NDArray[np.float64], wanted: NDArray[np.float64], ground: Ground) -> NDArray[np.float64]:
    """Heights [m] of the ground under the rows, followed from the first point on."""
    heights = np.empty(len(rows))
    _follow_ground(kernel_ground(ground), rows, wanted - ground.origin[2], ground.origin, heights)
    lost = np.flatnonzero(~np.isfinite(heights))
    if len(lost):
        x, y = rows[lost[0], at.PX : at.PY + 1]
        raise NoTrail(f"there is no ground under the path at ({x:.2f}, {y:.2f})")
    return heights + ground.origin[2]


def kernel_ground(ground: Ground) -> tuple:
    """Arguments of `locomotion.ground.ground.height_below`."""
    a = ground.arrays
    return a.rows, a.cell_start, a.cell_triangles, a.grid, a.shape


@allocating_kernel
def _follow_ground(ground, rows, wanted, origin, heights):
    last = wanted[0]
    for i in range(len(rows)):
        x, y = rows[i, at.PX] - origin[0], rows[i, at.PY] - origin[1]
        h = height_below(ground[0], ground[1], ground[2], ground[3], ground[4], x, y, last + _CLIMB)[0]
        if not abs(h - last) < 3.0 * _CLIMB:  # crack in a scan, or jump of the path: the path's height
            h = height_below(ground[0], ground[1], ground[2], ground[3], ground[4], x, y, wanted[i] + _CLIMB)[
                0
            ]
            if not abs(h - wanted[i]) < 3.0 * _CLIMB:
                h = wanted[i]
        heights[i] = h
        last = h


def _plan_speed(rows: NDArray[np.float64], step: float, body: Body) -> None:
    """Highest speed at each row: by the bends between rear and front feet, then by braking ahead of them."""
    bend = uniform_filter1d(np.abs(rows[:, at.PCURVATURE]), max(round(0.15 / step), 1), mode="nearest")
    reach = max(round(body.spine.length / step), 1)
    bend = maximum_filter1d(bend, reach + 1, origin=-(reach // 2), mode="nearest")
    rise = np.abs(
        uniform_filter1d(np.gradient(rows[:, at.PZ], step), max(round(0.4 / step), 1), mode="nearest")
    )
    climbing = _CLIMBING * np.sqrt(_GRAVITY * body.rear_legs.height)
    steep = (climbing / np.maximum(rise, climbing / body.top_speed)) ** 2
    squares = np.maximum(np.minimum(body.movement.sideways / np.maximum(bend, 1e-6), steep), _CREEP**2)
    brake = 1.2 * body.movement.braking * step
    braked = brake * np.arange(len(squares))  # from the end to the beginning: limited by braking
    least = np.minimum.accumulate((squares + braked)[::-1])[::-1] - braked
    rows[:, at.PSPEED] = np.sqrt(np.maximum(least, _CREEP**2))


@kernel(forceinline=True)
def _place(count, step, arc):
    """Row and share of the way to the next for an arc length on the trail."""
    along = min(max(arc / step, 0.0), count - 1.0)
    i = min(int(along), count - 2)
    return i, along - i


@kernel
def trail_point(pool, first, count, step, arc):
    """(x, y, z) [m] at an arc length [m]; straight on before the start and behind the end."""
    i, w = _place(count, step, arc)
    a, b = pool[first + i], pool[first + i + 1]
    v = 1.0 - w
    pa, pb = v * v * (1.0 + 2.0 * w), w * w * (3.0 - 2.0 * w)
    ta, tb = step * w * v * v, -step * w * w * v
    x = pa * a[0] + pb * b[0] + ta * a[3] + tb * b[3]
    y = pa * a[1] + pb * b[1] + ta * a[4] + tb * b[4]
    z = v * a[2] + w * b[2]
    over = arc - (i + w) * step
    if over != 0.0:
        end = a if over < 0.0 else b
        x += over * end[3]
        y += over * end[4]
    return x, y, z


@kernel
def trail_at(pool, first, count, step, arc):
    """(x, y, z, heading) [m, m, m, rad] at an arc length [m], like `trail_point`."""
    x, y, z = trail_point(pool, first, count, step, arc)
    i, w = _place(count, step, arc)
    a, b = pool[first + i], pool[first + i + 1]
    v = 1.0 - w
    heading = (
        v * v * (1.0 + 2.0 * w) * a[5] + w * w * (3.0 - 2.0 * w) * b[5]
        + step * w * v * v * a[6] - step * w * w * v * b[6]
    )  # fmt: skip
    return x, y, z, heading


@kernel
def trail_speed(pool, first, count, step, arc):
    """[m/s] at which the place at an arc length [m] may be passed."""
    i, w = _place(count, step, arc)
    return (1.0 - w) * pool[first + i, 7] + w * pool[first + i + 1, 7]
