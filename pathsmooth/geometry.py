"""Small planar geometry on polylines and discs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from surefoot.kernels import kernel


def steps_along(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n - 1,) horizontal distances between ``points`` (n, 2) or (n, 3)."""
    return np.hypot(points[1:, 0] - points[:-1, 0], points[1:, 1] - points[:-1, 1])


def arc_along(steps: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) arc lengths, from 0, of points that lie ``steps`` (n - 1,) apart."""
    arc = np.zeros(len(steps) + 1)
    np.cumsum(steps, out=arc[1:])
    return arc


def interpolated(
    at: NDArray[np.float64], places: NDArray[np.float64], rows: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(n, k): what `numpy.interp` gives for each column of ``rows`` (m, k) at ``places`` (m,), read ``at``
    (n,); both not decreasing."""
    result = np.empty((len(at), rows.shape[1]))
    _interpolate(at, places, np.ascontiguousarray(rows), result)
    return result


@kernel
def _interpolate(at, places, rows, result):
    last = len(places) - 1
    j = 0
    for i in range(len(at)):
        while j < last and places[j + 1] <= at[i]:
            j += 1
        for column in range(rows.shape[1]):
            value = rows[j, column]
            if j < last and at[i] > places[j]:
                slope = (rows[j + 1, column] - value) / (places[j + 1] - places[j])
                value = slope * (at[i] - places[j]) + value
            result[i, column] = value


@kernel(forceinline=True)
def lens_corners(ax, ay, ra, bx, by, rb):
    """The two points where the rims of two discs meet; of no meaning where they do not."""
    dx = bx - ax
    dy = by - ay
    distance = max(np.sqrt(dx * dx + dy * dy), 1e-300)
    along = (distance * distance + ra * ra - rb * rb) / (2.0 * distance)
    across = np.sqrt(max(ra * ra - along * along, 0.0))
    ux = dx / distance
    uy = dy / distance
    x = ax + along * ux
    y = ay + along * uy
    return x - across * uy, y + across * ux, x + across * uy, y - across * ux


@kernel
def nearest_in_lens(x, y, ax, ay, ra, bx, by, rb):
    """The point nearest to (x, y) in two overlapping discs, which may be equal or one inside the other."""
    rounding = 1.0 + 1e-12
    a = np.sqrt((x - ax) ** 2 + (y - ay) ** 2)
    b = np.sqrt((x - bx) ** 2 + (y - by) ** 2)
    if a <= ra * rounding and b <= rb * rounding:
        return x, y
    if a > ra:
        px = ax + ra / a * (x - ax)
        py = ay + ra / a * (y - ay)
        if (px - bx) ** 2 + (py - by) ** 2 <= rb * rb * rounding:
            return px, py
    if b > rb:
        px = bx + rb / b * (x - bx)
        py = by + rb / b * (y - by)
        if (px - ax) ** 2 + (py - ay) ** 2 <= ra * ra * rounding:
            return px, py
    px, py, qx, qy = lens_corners(ax, ay, ra, bx, by, rb)
    if (px - x) ** 2 + (py - y) ** 2 <= (qx - x) ** 2 + (qy - y) ** 2:
        return px, py
    return qx, qy
