"""How near to a fall a person is that walks on slopes or stairs, as a foot comes down.

Such a fall nearly always shows seconds before: the body is too fast or too slow, or moves sideways. On a
steeper way it takes less. A strained person rehearses its next step (`locomotion.rehearsal`).
"""

import math

import numpy as np
from numpy.typing import NDArray

from locomotion.body import observed as seen
from locomotion.gaits.walk.layout import (
    CLOCK,
    DOUBLE,
    PHASE,
    SIDEWAYS,
    STAIRS_AHEAD,
    STRAINS,
    WALK_HEADING,
    WALK_SPEED,
    WALK_STANCE,
)
from locomotion.paths.command import SLOPE_THERE

__all__ = ["FORESEEN", "STRAINED", "USUAL", "note_strain", "slope_ahead", "strain"]

STRAINED = 0.55
"""Strain above which a step is rehearsed."""
FORESEEN, USUAL = 0.4, 0.2
"""Strain above which one of the next steps may have to be; that of a steady walk on level ground."""
_SLOWER, _OUTWARD, _SINKING = 0.17, 0.11, 0.03
# [m/s] of the centre of mass as a foot of a steady walk comes down: below its reference, towards it, down


def strain(walk: NDArray[np.float64], observed: NDArray[np.float64], command: NDArray[np.float64]) -> float:
    """How far [m/s] the velocity of the centre of mass is off that of a steady walk as a foot has just come
    down, and 1 m/s more per unit of slope of the way, or of stairs.

    walk: (WALK_SIZE,). observed: as in `locomotion.body.observed`. command: as in `walk_tick`.
    """
    ch, sh = math.cos(walk[WALK_HEADING]), math.sin(walk[WALK_HEADING])
    x, y, z = observed[seen.COM_VELOCITY].tolist()
    ahead = ch * x + sh * y - walk[WALK_SPEED] + _SLOWER
    outward = walk[WALK_STANCE] * (ch * y - sh * x - walk[SIDEWAYS]) - _OUTWARD
    off = math.sqrt(ahead * ahead + outward * outward + (z + _SINKING) ** 2)
    return off + slope_ahead(walk, command)


def slope_ahead(walk: NDArray[np.float64], command: NDArray[np.float64]) -> float:
    """Slope [rise over run] of the way or of the stairs where it walks, at least 0; arguments as of
    `strain`."""
    return float(max(abs(command[SLOPE_THERE]), walk[STAIRS_AHEAD]))


def note_strain(
    walk: NDArray[np.float64], observed: NDArray[np.float64], command: NDArray[np.float64]
) -> None:
    """After a tick: if a foot has just come down, write into ``walk`` how strained it is; arguments as of
    `strain`."""
    if walk.item(PHASE) == DOUBLE and walk.item(CLOCK) == 0.0:
        walk[STRAINS] = strain(walk, observed, command), walk[STRAINS][0]
