"""Analytic inverse kinematics of a limb of two links with a hinge between (numba kernels).

The middle joint follows from the distance of the ends by the law of cosines, and lies in the plane that the
hinge's axis is upright on, on the side to which the joint bends.
"""

import math

import numpy as np

from locomotion.characters.quaternions import from_axes
from surefoot.kernels import allocating_kernel

__all__ = ["reach"]

_SOFT = 0.985
"""Share of the limb's length from where on it stretches ever less, and never fully: near full length, a joint
would turn by many degrees for a millimetre. What is at 0.993 is missed by 0.002 of the length."""


@allocating_kernel
def reach(start, target, upper, lower, hinge, side, upper_turn, lower_turn):
    """Turn a limb from ``start`` (3,) so that it ends at ``target`` (3,), or nearly if it is nearly out of
    reach.

    upper, lower: lengths of the links [m]. hinge: (3,) unit axis of the middle joint. side: +1 if the joint
    goes ahead when it bends, as a knee, -1 if it goes back, as an elbow: ahead is where x is if the limb
    hangs down and the hinge is y. upper_turn, lower_turn: (4,) become the links' rotations from hanging
    down, -z.
    """
    d = np.empty(3)
    length = 0.0
    for k in range(3):
        d[k] = target[k] - start[k]
        length += d[k] * d[k]
    length = math.sqrt(length)
    if length < 1e-6:
        d[0], d[1], d[2], length = 0.0, 0.0, -1.0, 1e-6
    else:
        for k in range(3):
            d[k] /= length
    length = max(length, abs(upper - lower) + 1e-6)
    soft, left = _SOFT * (upper + lower), (1.0 - _SOFT) * (upper + lower)
    if length > soft:
        length = soft + left * (1.0 - math.exp((soft - length) / left))
    along = hinge[0] * d[0] + hinge[1] * d[1] + hinge[2] * d[2]
    axis = np.empty(3)
    size = 0.0
    for k in range(3):
        axis[k] = hinge[k] - along * d[k]
        size += axis[k] * axis[k]
    size = math.sqrt(size)
    if size < 1e-6:  # along the hinge: any direction beside it
        least = 0
        for k in range(1, 3):
            if abs(d[k]) < abs(d[least]):
                least = k
        for k in range(3):
            axis[k] = (1.0 if k == least else 0.0) - d[least] * d[k]
        size = math.sqrt(axis[0] ** 2 + axis[1] ** 2 + axis[2] ** 2)
    for k in range(3):
        axis[k] /= size
    # ahead = d × axis: hanging down, -z × y = x
    ahead = np.array([
        d[1] * axis[2] - d[2] * axis[1], d[2] * axis[0] - d[0] * axis[2], d[0] * axis[1] - d[1] * axis[0],
    ])  # fmt: skip
    cosine = (upper * upper + length * length - lower * lower) / (2.0 * upper * length)
    cosine = min(max(cosine, -1.0), 1.0)
    sine = side * math.sqrt(1.0 - cosine * cosine)
    x, z = np.empty(3), np.empty(3)
    for k in range(3):
        z[k] = -(cosine * d[k] + sine * ahead[k])
    _turned(axis, z, x, upper_turn)
    size = 0.0
    for k in range(3):
        z[k] = -(length * d[k] + upper * z[k])
        size += z[k] * z[k]
    size = math.sqrt(size)
    for k in range(3):
        z[k] /= size
    _turned(axis, z, x, lower_turn)


@allocating_kernel
def _turned(y, z, x, out):
    x[0] = y[1] * z[2] - y[2] * z[1]
    x[1] = y[2] * z[0] - y[0] * z[2]
    x[2] = y[0] * z[1] - y[1] * z[0]
    from_axes(x, y, z, out)
