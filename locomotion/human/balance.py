"""Whether a person on its feet has lost its balance (numba)."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.observed import COM_Z, LEFT_FOOT, RIGHT_FOOT, VELOCITY_Z
from locomotion.body.person import PersonIndex
from locomotion.gaits.run.controller import LEAST_UPRIGHT, LOWEST
from surefoot.kernels import kernel

__all__ = ["loses_balance"]

_AHEAD = 0.1  # [s] that it is seen coming
_CROUCHED = 0.6
# [m] of the centre of mass above a foot, below which nobody comes up from such a tilt; behind obstacles
# people lean as far, but are higher


@kernel
def _loses_balance(observed, frames, spins, chest):
    low = min(observed[RIGHT_FOOT + 2], observed[LEFT_FOOT + 2])
    height = observed[COM_Z] - low + _AHEAD * min(observed[VELOCITY_Z], 0.0)
    if height < LOWEST:
        return True
    frame, spin = frames[chest], spins[chest]
    tips = spin[0] * frame[5] - spin[1] * frame[2]
    return height < _CROUCHED and frame[8] + _AHEAD * min(tips, 0.0) < LEAST_UPRIGHT


def loses_balance(index: PersonIndex, data: mujoco.MjData, observed: NDArray[np.float64]) -> bool:
    """Whether it will have fallen within 0.1 s as it moves now: then it cannot catch itself any more.
    ``observed``: see `locomotion.body.observed`."""
    return bool(_loses_balance(observed, data.xmat, data.cvel, index.chest))
