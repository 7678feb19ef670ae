"""Whether the ground along a path is as level as that on which the policy has learned to walk."""

import math

from locomotion.gaits.walk.footholds import ground_at
from locomotion.paths.table import HEADING, X, Y
from surefoot.kernels import kernel

__all__ = ["floor_at", "is_level", "is_level_around"]

_STEEPEST = 0.05  # rise over run
_UNEVEN = 0.015  # [m] by which the ground may be off its slope within `_APART`
_APART = 0.1  # [m] between the places looked at, along the path
_ASIDE = 0.22  # [m] from the middle of the path to its sides, where feet are put and turned
_NEAR = 0.6  # [m] from where the height is known to the first places looked at
_AROUND, _SIDES = 0.8, 12  # [m] of a place where a person stands, and directions in which it is looked at
_REACH = 0.5  # [m] above and below the last height in which the ground is looked for


@kernel
def floor_at(ground, x, y, z):
    """Height of the ground [m] at (x, y), within 0.5 m of ``z``; NaN where there is none. ``ground``: as in
    `locomotion.gaits.walk.footholds.ground_at`."""
    height, _, _, _ = ground_at(ground, x, y, z + _REACH)
    return height if abs(height - z) <= _REACH else math.nan


@kernel
def is_level(ground, table, length, begin, end, z):
    """Whether the ground between the arc lengths ``begin`` and ``end`` [m] of a path is level, as wide as a
    person walks. table, length: of a `PathTable`; ``z`` [m]: height of the ground near ``begin``."""
    step = length / (table.shape[0] - 1)
    count = int((min(end, length) - begin) / _APART) + 1
    for side in range(-1, 2):
        before = z
        for k in range(count):
            row = min(max(int((begin + k * _APART) / step + 0.5), 0), table.shape[0] - 1)
            heading = table[row, HEADING]
            x = table[row, X] - side * _ASIDE * math.sin(heading)
            y = table[row, Y] + side * _ASIDE * math.cos(heading)
            height, nx, ny, nz = ground_at(ground, x, y, before + _REACH)
            most = _STEEPEST * (_APART if k > 0 else _NEAR) + _UNEVEN
            if not abs(height - before) <= most or math.hypot(nx, ny) > _STEEPEST * nz:
                return False
            before = height
    return True


@kernel
def is_level_around(ground, x, y, z):
    """Whether the ground is level where a person stands, around (x, y, z) [m]."""
    for k in range(_SIDES):
        angle = 2.0 * math.pi * k / _SIDES
        px, py = x + _AROUND * math.cos(angle), y + _AROUND * math.sin(angle)
        height, nx, ny, nz = ground_at(ground, px, py, z + _REACH)
        if not abs(height - z) <= _STEEPEST * _AROUND + _UNEVEN or math.hypot(nx, ny) > _STEEPEST * nz:
            return False
    return True
