"""A motion of the full figure on its way into a set."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import JOINT_NAMES
from locomotion.recorded.motion_set import Clip

__all__ = ["RATE", "Take", "Told", "mirrored", "spread"]

RATE = 60.0
"""[Hz] of the frames of a take."""
Told = Callable[[float, str], None]
"""Is told the share of the work that is done, and what comes next."""


@dataclass(frozen=True, eq=False)
class Take:
    """A ``clip`` and its frames: ``qpos`` (n, 46) of the person with roots as in
    `locomotion.recorded.motion_set.LevelFrames`, and whether each foot bears, ``stance`` (n, 2). ``held``:
    the hands that hold something, such as "right_hand"."""

    clip: Clip
    qpos: NDArray[np.float64]
    stance: NDArray[np.bool_]
    held: tuple[str, ...] = ()


def _other(name: str) -> str:
    for side, other in (("right_", "left_"), ("left_", "right_")):
        if name.startswith(side):
            return other + name.removeprefix(side)
    return name


_MIRROR = np.array([JOINT_NAMES.index(_other(name)) for name in JOINT_NAMES])
_SIGN = np.array([-1.0 if name.endswith(("roll", "yaw")) else 1.0 for name in JOINT_NAMES])


def mirrored(qpos: NDArray[np.float64]) -> NDArray[np.float64]:
    """Frames (n, 46) with left and right swapped."""
    out = qpos.copy()
    out[:, [1, 4, 6]] *= -1.0
    out[:, 7:] = qpos[:, 7:][:, _MIRROR] * _SIGN
    return out


def spread(qpos: NDArray[np.float64], shares: NDArray[np.float64], cyclic: bool) -> NDArray[np.float64]:
    """Frames (m, 46) at ``shares`` (m,), 0 to 1, of the frames ``qpos`` (n, 46), linear between them."""
    rows = np.vstack([qpos, qpos[:1]]) if cyclic else qpos
    at = np.asarray(shares) * (len(rows) - 1)
    low = np.minimum(at.astype(int), max(len(rows) - 2, 0))
    high = np.minimum(low + 1, len(rows) - 1)
    after = rows[high].copy()
    after[:, 3:7] *= np.where((rows[low, 3:7] * after[:, 3:7]).sum(axis=1, keepdims=True) < 0.0, -1.0, 1.0)
    t = (at - low)[:, None]
    out = (1.0 - t) * rows[low] + t * after
    out[:, 3:7] /= np.linalg.norm(out[:, 3:7], axis=1, keepdims=True)
    return out
