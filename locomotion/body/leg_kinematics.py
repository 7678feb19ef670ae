"""Analytic inverse kinematics of a leg of the person: hip flexion, abduction, rotation; knee; ankle (numba).

The three hip axes meet in the hip, the two ankle axes in the ankle, so that the knee follows from the
distance of the two points, the ankle's angles from where the hip is seen from the foot, and the hip's from
the rotation that is left (S. Kajita et al., "Introduction to Humanoid Robotics", section 2.5.2, with this
figure's order of axes).
"""

import math

import numpy as np

from locomotion.body.anatomy import SHANK, THIGH
from surefoot.kernels import allocating_kernel

__all__ = ["solve_leg"]

_LONGEST = 0.998 * (THIGH + SHANK)
_SHORTEST = 0.35


@allocating_kernel
def solve_leg(pelvis, hip, foot, ankle, side, out):
    """Angles ``out`` (6,) [rad] that put the ankle at ``ankle`` (3,) [m] with the foot turned as ``foot``.

    pelvis, foot: (3, 3) rotation matrices, columns are the bodies' axes in the world. hip (3,) [m].
    side: -1 right, +1 left. An ankle out of reach is approached as far as the leg allows, on the line to it.
    Returns whether it was in reach. Angles are not clipped to the joints' ranges.
    """
    d = hip - ankle
    distance = math.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
    reach = min(max(distance, _SHORTEST), _LONGEST)
    # the hip seen from the foot
    x = foot[0, 0] * d[0] + foot[1, 0] * d[1] + foot[2, 0] * d[2]
    y = foot[0, 1] * d[0] + foot[1, 1] * d[1] + foot[2, 1] * d[2]
    z = foot[0, 2] * d[0] + foot[1, 2] * d[1] + foot[2, 2] * d[2]
    cosine = (THIGH * THIGH + SHANK * SHANK - reach * reach) / (2.0 * THIGH * SHANK)
    knee = math.pi - math.acos(min(max(cosine, -1.0), 1.0))
    # between shank and the line from ankle to hip
    alpha = math.asin(min(max(THIGH * math.sin(knee) / reach, -1.0), 1.0))
    side_on = math.copysign(1.0, z)  # -1 in a deep squat: the hip is below the plane of the sole
    roll = math.atan2(side_on * y, side_on * z)
    pitch = -math.atan2(x, side_on * math.sqrt(y * y + z * z)) - alpha
    # foot = pelvis * hip rotation * Ry(knee) * Ry(pitch) * Rx(roll), so hip = pelvis' foot (Ry(q) Rx(roll))'
    q = knee + pitch
    cq, sq, cr, sr = math.cos(q), math.sin(q), math.cos(roll), math.sin(roll)
    thigh = np.empty((3, 3))  # pelvis' foot, then its rows times (Ry(q) Rx(roll))'
    for i in range(3):
        for j in range(3):
            thigh[i, j] = pelvis[0, i] * foot[0, j] + pelvis[1, i] * foot[1, j] + pelvis[2, i] * foot[2, j]
    side_x, side_y, side_z = thigh[1]
    # h = Ry(a) Rx(b) Rz(c)
    h12 = -sq * side_x + cq * (sr * side_y + cr * side_z)
    b = math.asin(min(max(-h12, -1.0), 1.0))
    h02 = -sq * thigh[0, 0] + cq * (sr * thigh[0, 1] + cr * thigh[0, 2])
    h22 = -sq * thigh[2, 0] + cq * (sr * thigh[2, 1] + cr * thigh[2, 2])
    a = math.atan2(h02, h22)
    c = math.atan2(cq * side_x + sq * (sr * side_y + cr * side_z), cr * side_y - sr * side_z)
    out[0] = -a
    out[1] = side * b
    out[2] = -side * c
    out[3] = knee
    out[4] = -pitch
    out[5] = -side * roll
    return distance <= _LONGEST and distance >= _SHORTEST
