"""The table of a path: its course, and the speed and gait along it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "BRAKE",
    "CURVATURE",
    "FAST_WALK",
    "GAIT",
    "HEADING",
    "RUN",
    "SLOPE",
    "SPACING",
    "SPEED",
    "WALK",
    "PathTable",
    "TrackingLimits",
    "X",
    "Y",
    "Z",
]  # fmt: skip

SPACING = 0.1
"""Spacing of a path's table [m]."""
X, Y, Z, HEADING, CURVATURE, SLOPE, SPEED, GAIT = range(8)
"""Columns of a path's table; `GAIT` is one of the following."""
BRAKE, FAST_WALK, WALK, RUN = -2.0, -1.0, 0.0, 1.0
"""Gaits of a path. Brake: runners stop, walkers walk on; walk as fast as the path's speed; walk at usual
speed at most, or slow down to it; run."""


@dataclass(frozen=True)
class TrackingLimits:
    """What a body can follow.

    Attributes:
      speeds: lowest and highest speed [m/s].
      sideways: [m/s^2] highest sideways acceleration in a bend.
      acceleration, deceleration: [m/s^2] of the planned speed along the path.
      uphill, downhill: [m/s per unit of slope] subtracted from the wanted speed on a slope.
      sharpest: curvature [1/m] and steepest: slope [rise over run] above which this gait is not used.
      slowing: [m/s^2] of slowing from a run to a walk. rest: [m] at the end that are walked.
      foresight: [m] before a slope at which it already moves as slowly as on it.
      usual: [m/s] walking speed at most, unless a faster walk is asked for on straight, level ground away
      from
        runs.
      tight: [m/s] speed in a bend on level ground that turns it by no more than the second number [rad/s],
        whatever the sideways acceleration.
      steps: [m/s] where the ground steps up or down; 0: this gait is not used there.
    """

    speeds: tuple[float, float]
    sideways: float = 2.5
    acceleration: float = 1.5
    deceleration: float = 0.8
    uphill: float = 2.0
    downhill: float = 4.0
    sharpest: float = math.inf
    steepest: float = math.inf
    slowing: float = 0.6
    rest: float = 2.0
    foresight: float = 0.0
    usual: float = math.inf
    tight: tuple[float, float] = (0.0, 0.0)
    steps: float = math.inf

    @property
    def calm(self) -> float:
        """[m/s] fastest walk unless a faster one is asked for."""
        return min(self.usual, self.speeds[1])


@dataclass(frozen=True)
class PathTable:
    """A path resampled every 0.1 m of horizontal length.

    Attributes:
        table: (n, 8) float64: x, y, z [m], heading [rad, unwrapped], curvature [1/m, left positive], slope
            (rise per length), planned speed [m/s], gait.
        length: horizontal length [m].
        goal: (3,) float64, its last point.
    """

    table: NDArray[np.float64]
    length: float
    goal: NDArray[np.float64]

    def runs(self, arc: float) -> bool:
        """Whether to run at this arc length [m]."""
        return bool(self._gait(arc) == RUN)

    def brakes(self, arc: float) -> bool:
        """Whether a runner must stop there."""
        return bool(self._gait(arc) == BRAKE)

    def changed(self, arc: float, within: float) -> bool:
        """Whether the gait has changed less than ``within`` [m] before this arc length [m]."""
        return arc < within or self._gait(arc) != self._gait(arc - within)

    def walks_fast(self, arc: float) -> bool:
        """Whether it may walk faster than usual there."""
        return bool(self._gait(arc) == FAST_WALK)

    def _gait(self, arc: float) -> float:
        last = len(self.table) - 1
        return self.table.item(min(max(round(arc / self.length * last), 0), last), GAIT)
