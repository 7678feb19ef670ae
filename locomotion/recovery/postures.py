"""Postures of the body by the names of joints."""

import math

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import JOINT_NAMES

__all__ = ["mirrored", "posture"]


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
