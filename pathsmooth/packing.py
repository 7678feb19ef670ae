"""The arrays that the compiled loops read, made once per problem."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pathsmooth import kernels as k
from pathsmooth.geometry import lens_corners, nearest_in_lens
from surefoot.kernels import kernel

# Step sizes of the solver. They change its speed, never its answer; found by trial on random corridors.
NORM_STEP = 60.0  # [1/m] of the distance term, per weight
DISC_STEP = 10.0  # [1/m] of the discs, per weight of an evenly placed waypoint
RIM_STEP = 80.0  # [1/m] in addition where the target lies on a rim, as the corners of a pulled path do
DISC_STIFFNESS = 0.3  # of a disc as stiff as the path bent within the disc's size
CLOSE_STIFFNESS = 0.02  # of a waypoint as stiff as the path bent between it and a close neighbour
CURVE_STEP = 2.0  # of the bound on curvature, per weight of the bending term
BOUNDED_NORM_STEP = 0.3  # of the distance term under a bound on curvature, of that without
_RIM = 0.02  # [m]
_SMALLEST_SIZE = 0.1  # [m]
_ROUNDING = 1e-11  # [m]
_CLOSE = 0.5  # of the greatest spacing


def pack(
    targets, arc, segment_disc, centers, radii, smoothness: float, first: int, last: int
) -> NDArray[np.float64]:
    """(ROWS, n): see the names of the rows in `kernels`. Arguments as the fields of `Problem`."""
    packed = np.zeros((k.ROWS, len(arc)))
    _pack(packed, targets, arc, segment_disc, centers, radii, smoothness)
    k.factorise(packed, first, last)
    return packed


def with_bound(packed: NDArray[np.float64], first: int, last: int) -> NDArray[np.float64]:
    """A copy of the packed arrays for the loops of `bounded_kernels`."""
    packed = packed.copy()
    packed[k.CURVE_STEP] = CURVE_STEP * 2.0 * packed[k.BEND]
    packed[k.NORM_STEP] *= BOUNDED_NORM_STEP
    k.factorise(packed, first, last)
    return packed


@kernel
def keep_near(packed, reach):
    """Hold waypoints that are in one disc within `reach` [m] of their targets as well, in place."""
    for i in range(1, packed.shape[1] - 1):
        same = packed[k.AX, i] == packed[k.BX, i] and packed[k.AY, i] == packed[k.BY, i]
        if same and packed[k.AR, i] == packed[k.BR, i]:
            packed[k.BX, i] = 0.0
            packed[k.BY, i] = 0.0
            packed[k.BR, i] = reach
            packed[k.PX, i], packed[k.PY, i], packed[k.QX, i], packed[k.QY, i] = lens_corners(
                packed[k.AX, i], packed[k.AY, i], packed[k.AR, i], 0.0, 0.0, reach
            )


@kernel
def into_discs(targets, segment_disc, centers, radii):
    """Move the inner targets (n, 2) that lie outside their discs to the nearest place inside, in place."""
    for i in range(1, len(targets) - 1):
        a = segment_disc[i - 1]
        b = segment_disc[i]
        targets[i, 0], targets[i, 1] = nearest_in_lens(
            targets[i, 0], targets[i, 1],
            centers[a, 0], centers[a, 1], radii[a], centers[b, 0], centers[b, 1], radii[b],
        )  # fmt: skip


@kernel
def _pack(packed, targets, arc, segment_disc, centers, radii, smoothness):
    n = len(arc)
    widest = 0.0
    for i in range(n):
        for row in (k.AX, k.BX):
            disc = segment_disc[max(i - 1, 0)] if row == k.AX else segment_disc[min(i, n - 2)]
            x = centers[disc, 0] - targets[i, 0]
            y = centers[disc, 1] - targets[i, 1]
            packed[row, i] = x
            packed[row + 1, i] = y
            packed[row + 2, i] = radii[disc]
            distance = np.sqrt(x * x + y * y)
            if radii[disc] < distance < radii[disc] + _ROUNDING:  # then it counts as on the rim
                packed[row + 2, i] = distance
        packed[k.PX, i], packed[k.PY, i], packed[k.QX, i], packed[k.QY, i] = lens_corners(
            packed[k.AX, i],
            packed[k.AY, i],
            packed[k.AR, i],
            packed[k.BX, i],
            packed[k.BY, i],
            packed[k.BR, i],
        )
        before = arc[i] - arc[i - 1] if i > 0 else 0.0
        after = arc[i + 1] - arc[i] if i < n - 1 else 0.0
        mean = 0.5 * (before + after)
        widest = max(widest, before, after)
        packed[k.WEIGHT, i] = mean
        if 0 < i < n - 1:
            left = 1.0 / (before * mean)
            right = 1.0 / (after * mean)
            packed[k.LEFT, i] = left
            packed[k.RIGHT, i] = right
            packed[k.BEND, i] = smoothness * mean
            for axis in range(2):
                back = targets[i - 1, axis] - targets[i, axis]
                ahead = targets[i + 1, axis] - targets[i, axis]
                packed[k.EX + axis, i] = left * back + right * ahead
    for i in range(n):
        for axis in range(2):
            e, g = k.EX + axis, k.GX + axis
            value = -(packed[k.LEFT, i] + packed[k.RIGHT, i]) * 2.0 * packed[k.BEND, i] * packed[e, i]
            if i > 0:
                value += packed[k.RIGHT, i - 1] * 2.0 * packed[k.BEND, i - 1] * packed[e, i - 1]
            if i < n - 1:
                value += packed[k.LEFT, i + 1] * 2.0 * packed[k.BEND, i + 1] * packed[e, i + 1]
            packed[g, i] = value
        between = np.sqrt((packed[k.AX, i] - packed[k.BX, i]) ** 2 + (packed[k.AY, i] - packed[k.BY, i]) ** 2)
        thickness = 0.5 * (packed[k.AR, i] + packed[k.BR, i] - between)
        size = max(min(packed[k.AR, i], packed[k.BR, i], thickness), _SMALLEST_SIZE)
        inside = min(
            packed[k.AR, i] - np.sqrt(packed[k.AX, i] ** 2 + packed[k.AY, i] ** 2),
            packed[k.BR, i] - np.sqrt(packed[k.BX, i] ** 2 + packed[k.BY, i] ** 2),
        )
        disc_step = (DISC_STEP + (RIM_STEP if inside < _RIM else 0.0)) * widest
        disc_step += DISC_STIFFNESS * smoothness / size**3
        if 0 < i < n - 1:
            close = min(arc[i] - arc[i - 1], arc[i + 1] - arc[i])
            if close < _CLOSE * widest:
                disc_step += CLOSE_STIFFNESS * smoothness / close**3
        packed[k.NORM_STEP, i] = NORM_STEP * packed[k.WEIGHT, i]
        packed[k.DISC_STEP, i] = disc_step
