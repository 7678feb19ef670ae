"""Postures of the body by the names of joints, and the ways from one to another."""

import math

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import JOINT_NAMES
from locomotion.gaits.walk.layout import clamp
from surefoot.kernels import kernel

__all__ = ["mirrored", "move", "posture"]


def posture(**degrees: float) -> NDArray[np.float64]:
    """(39,) joint angles [rad] by name, 0 for those not named; a name without a side is for both."""
    angles = np.zeros(len(JOINT_NAMES))
    for name, angle in degrees.items():
        for i, joint in enumerate(JOINT_NAMES):
            if joint == name or joint in (f"right_{name}", f"left_{name}"):
                angles[i] = math.radians(angle)
    return angles


def mirrored(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """The posture ``angles`` (39,) of the other side."""
    out = angles.copy()
    for i, name in enumerate(JOINT_NAMES):
        if name.startswith("right_"):
            k = JOINT_NAMES.index("left_" + name[6:])
            out[i], out[k] = angles[k], angles[i]
        elif name.endswith(("_roll", "_yaw")):
            out[i] = -angles[i]
    return out


@kernel
def move(begun, target, share, ctrl):
    """From one posture to another (39,), ``share`` of the way in time: write ``ctrl`` (39,)."""
    u = clamp(share, 0.0, 1.0)
    u = u * u * (3.0 - 2.0 * u)
    for j in range(39):
        ctrl[j] = begun[j] + u * (target[j] - begun[j])
