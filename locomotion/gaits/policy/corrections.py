"""What is added to the targets of a walk, besides what the network decides: it misses some figures by itself.

For n people at once, and as kernels for one.
"""

import math

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import JOINT_NAMES
from locomotion.gaits.policy.layout import ANKLES, ARMS_ASIDE, FAST, JOINTS, RUNNING, SPREADING
from surefoot.kernels import kernel

__all__ = ["KEEPS_OFF", "correct_one", "corrections", "kept_off", "kept_off_one"]

KEEPS_OFF = math.radians(10.0)
"""[rad] by which arms are held farther aside than the reference holds them. The network has learned without
contacts between limbs: it swings arms inwards, too, and hands would go through thighs. It does not see this
angle: otherwise it makes steps twice as wide."""
WIDENS_FROM, WIDENS = 1.25, 0.05
"""[m/s] of the reference motion above which legs are spread, and by how many rad per m/s: the faster the
walk, the narrower are the network's steps."""
TOES_UP, SLOWER_THAN, IN_PLACE = 0.12, (1.1, 0.6), (0.1, 0.4)
"""[rad] by which toes are raised before the heel strikes; [m/s] below which this begins, and is complete: in
slow steps the network puts down the whole foot. Between the last two speeds it ends again: steps in place
are flat."""
_RAISED, _RAISES = 0.8, 0.08  # shares of the foot's cycle: where toes begin to be raised, and for how long

_COLUMNS = np.array([JOINT_NAMES.index(name) for name in JOINTS])
_ARMS, _SPREADS, _ANKLES = _COLUMNS[ARMS_ASIDE], _COLUMNS[SPREADING], _COLUMNS[ANKLES]


def _walks(memory: NDArray[np.float64]) -> NDArray[np.bool_]:
    return (memory[:, RUNNING] > 0.0) & (memory[:, FAST] == 0.0)


def kept_off(memory: NDArray[np.float64]) -> NDArray[np.float64]:
    """How much farther aside arms are held, (n, 1) [rad]."""
    return np.where(_walks(memory)[:, None], KEEPS_OFF, 0.0)


def corrections(
    memory: NDArray[np.float64], speed: NDArray[np.float64], phase: NDArray[np.float64]
) -> NDArray[np.float64]:
    """What is added to the targets of `layout.JOINTS`, (n, 24) [rad], besides `kept_off`. ``speed`` (n,)
    [m/s] of the reference motion, ``phase`` (n,) of the right foot."""
    found = np.zeros((len(memory), len(JOINTS)))
    found[:, SPREADING] = (WIDENS * np.maximum(speed - WIDENS_FROM, 0.0))[:, None]
    (slow, full), (still, steps) = SLOWER_THAN, IN_PLACE
    up = np.clip((slow - speed) / (slow - full), 0.0, 1.0)
    up *= np.clip((speed - still) / (steps - still), 0.0, 1.0)
    share = (phase[:, None] + [0.0, 0.5]) % 1.0
    found[:, ANKLES] = TOES_UP * up[:, None] * np.clip((share - _RAISED) / _RAISES, 0.0, 1.0)
    return found * _walks(memory)[:, None]


@kernel
def kept_off_one(memory):
    """How much farther aside arms are held [rad]."""
    return KEEPS_OFF if memory[RUNNING] > 0.0 and not memory[FAST] > 0.0 else 0.0


@kernel
def correct_one(memory, speed, phase, ctrl):
    """Add `kept_off` and `corrections` to the targets ``ctrl`` (39,)."""
    off = kept_off_one(memory)
    if off == 0.0:
        return
    wide = WIDENS * max(speed - WIDENS_FROM, 0.0)
    for k in range(_ARMS.shape[0]):
        ctrl[_ARMS[k]] += off
    for k in range(_SPREADS.shape[0]):
        ctrl[_SPREADS[k]] += wide
    up = min(max((SLOWER_THAN[0] - speed) / (SLOWER_THAN[0] - SLOWER_THAN[1]), 0.0), 1.0)
    up *= min(max((speed - IN_PLACE[0]) / (IN_PLACE[1] - IN_PLACE[0]), 0.0), 1.0)
    for side in range(2):
        share = phase + 0.5 * side
        share -= math.floor(share)
        ctrl[_ANKLES[side]] += TOES_UP * up * min(max((share - _RAISED) / _RAISES, 0.0), 1.0)
