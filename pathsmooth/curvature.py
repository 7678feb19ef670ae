"""Curvature of polylines, and the bound on it that a speed allows."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pathsmooth.errors import PathSmoothError


def curvature(points: ArrayLike) -> NDArray[np.float64]:
    """(n,) float64 [1/m] curvature at each vertex of the horizontal polyline through points (n, 2) or (n, 3).

    It is the angle turned at the vertex over the mean length of the two segments there, so that a kink counts
    in full; 0 at both ends. A polygon inscribed in a circle of radius R has slightly more than 1 / R.
    """
    xy = np.asarray(points, dtype=np.float64)
    if xy.ndim != 2 or xy.shape[1] not in (2, 3):
        raise PathSmoothError(f"points has shape {xy.shape}, not (n, 2) or (n, 3)")
    step = xy[1:, :2] - xy[:-1, :2]
    length = np.hypot(step[:, 0], step[:, 1])
    a, b = step[:-1], step[1:]
    turn = np.abs(np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(axis=1)))
    result = np.zeros(len(xy))
    result[1:-1] = turn / np.maximum(0.5 * (length[:-1] + length[1:]), 1e-300)
    return result


def curvature_bound(speed: float, lateral_acceleration: float = 4.0) -> float:
    """[1/m] greatest curvature at a speed [m/s] > 0 with a greatest lateral acceleration [m/s^2] > 0: a /
    v^2."""
    for name, value, unit in (
        ("speed", speed, "m/s"),
        ("lateral_acceleration", lateral_acceleration, "m/s^2"),
    ):
        if not (np.isfinite(value) and value > 0.0):
            raise PathSmoothError(f"{name} must be a positive number [{unit}], not {value!r}")
    return lateral_acceleration / speed**2
