"""Analytic inverse kinematics of a leg of the person: hip flexion, abduction, rotation; knee; ankle (numba).

The three hip axes meet in the hip, the two ankle axes in the ankle, so that the knee follows from the
distance of the two points, the ankle's angles from where the hip is seen from the foot, and the hip's from
the rotation that is left (S. Kajita et al., "Introduction to Humanoid Robotics", section 2.5.2, with this
figure's order of axes).
"""

import math

from locomotion.body.anatomy import SHANK, THIGH
from surefoot.kernels import kernel

__all__ = ["solve_leg", "solve_plain_leg"]

_LONGEST = 0.998 * (THIGH + SHANK)
_SHORTEST = 0.35


@kernel
def _across(pelvis, foot, axis):
    """The axes of a foot along one of the pelvis."""
    return (
        pelvis[0, axis] * foot[0, 0] + pelvis[1, axis] * foot[1, 0] + pelvis[2, axis] * foot[2, 0],
        pelvis[0, axis] * foot[0, 1] + pelvis[1, axis] * foot[1, 1] + pelvis[2, axis] * foot[2, 1],
        pelvis[0, axis] * foot[0, 2] + pelvis[1, axis] * foot[1, 2] + pelvis[2, axis] * foot[2, 2],
    )


@kernel
def solve_leg(pelvis, hip, foot, ankle, side, out):
    """Angles ``out`` (6,) [rad] that put the ankle at ``ankle`` (3,) [m] with the foot turned as ``foot``.

    pelvis, foot: (3, 3) rotation matrices, columns are the bodies' axes in the world. hip (3,) [m].
    side: -1 right, +1 left. An ankle out of reach is approached as far as the leg allows, on the line to it.
    Returns whether it was in reach. Angles are not clipped to the joints' ranges.
    """
    dx, dy, dz = hip[0] - ankle[0], hip[1] - ankle[1], hip[2] - ankle[2]
    distance = math.sqrt(dx * dx + dy * dy + dz * dz)
    reach = min(max(distance, _SHORTEST), _LONGEST)
    # the hip seen from the foot
    x = foot[0, 0] * dx + foot[1, 0] * dy + foot[2, 0] * dz
    y = foot[0, 1] * dx + foot[1, 1] * dy + foot[2, 1] * dz
    z = foot[0, 2] * dx + foot[1, 2] * dy + foot[2, 2] * dz
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
    # rows of pelvis' foot, which are to be multiplied by (Ry(q) Rx(roll))'
    ahead_x, ahead_y, ahead_z = _across(pelvis, foot, 0)
    side_x, side_y, side_z = _across(pelvis, foot, 1)
    up_x, up_y, up_z = _across(pelvis, foot, 2)
    # h = Ry(a) Rx(b) Rz(c)
    h12 = -sq * side_x + cq * (sr * side_y + cr * side_z)
    b = math.asin(min(max(-h12, -1.0), 1.0))
    h02 = -sq * ahead_x + cq * (sr * ahead_y + cr * ahead_z)
    h22 = -sq * up_x + cq * (sr * up_y + cr * up_z)
    a = math.atan2(h02, h22)
    c = math.atan2(cq * side_x + sq * (sr * side_y + cr * side_z), cr * side_y - sr * side_z)
    out[0] = -a
    out[1] = side * b
    out[2] = -side * c
    out[3] = knee
    out[4] = -pitch
    out[5] = -side * roll
    return distance <= _LONGEST and distance >= _SHORTEST


@kernel
def solve_plain_leg(pelvis, hip, foot, ankle, side, out):
    """Of a leg whose hip does not turn and whose ankle does not turn in or out, the angles ``out`` (6,) [rad]
    of `solve_leg` that put the ankle at ``ankle`` (3,) [m], with the foot's front as high over its rear as
    that of ``foot`` (3, 3), which becomes how the foot then is turned.

    The rest as of `solve_leg`.
    """
    dx, dy, dz = ankle[0] - hip[0], ankle[1] - hip[1], ankle[2] - hip[2]
    distance = math.sqrt(dx * dx + dy * dy + dz * dz)
    reach = min(max(distance, _SHORTEST), _LONGEST)
    x = pelvis[0, 0] * dx + pelvis[1, 0] * dy + pelvis[2, 0] * dz
    y = pelvis[0, 1] * dx + pelvis[1, 1] * dy + pelvis[2, 1] * dz
    z = pelvis[0, 2] * dx + pelvis[1, 2] * dy + pelvis[2, 2] * dz
    # the ankle seen from the hip, of a leg that bends its knee but is not turned at the hip
    bent = (reach * reach - THIGH * THIGH - SHANK * SHANK) / (2.0 * THIGH * SHANK)  # the knee's cosine
    straight = math.sqrt(max(1.0 - bent * bent, 0.0))
    behind, under = SHANK * straight, THIGH + SHANK * bent
    sb = min(max(reach / distance * y / under, -1.0), 1.0)
    cb = math.sqrt(1.0 - sb * sb)
    # the hip turns that direction, and the foot's x axis up to its height; both as cosines and sines
    size = math.sqrt((x * x + z * z) * (behind * behind + cb * cb * under * under))
    ca, sa = -(x * behind + z * cb * under) / size, (z * behind - x * cb * under) / size
    ahead = ca * pelvis[2, 0] - sa * pelvis[2, 2]
    up = -sb * pelvis[2, 1] + cb * (sa * pelvis[2, 0] + ca * pelvis[2, 2])
    most = math.sqrt(ahead * ahead + up * up)
    cu = min(max(foot[2, 0] / most, -1.0), 1.0)
    su = math.sqrt(1.0 - cu * cu)
    ct, st = (ahead * cu + up * su) / most, (ahead * su - up * cu) / most
    for k in range(3):
        px, py, pz = pelvis[k, 0], pelvis[k, 1], pelvis[k, 2]
        hx, hz = ca * px - sa * pz, -sb * py + cb * (sa * px + ca * pz)
        foot[k, 0], foot[k, 1] = ct * hx - st * hz, cb * py + sb * (sa * px + ca * pz)
        foot[k, 2] = st * hx + ct * hz
    knee = math.atan2(straight, bent)
    out[0], out[1], out[2] = -math.atan2(sa, ca), side * math.asin(sb), 0.0
    out[3], out[4], out[5] = knee, knee - math.atan2(st, ct), 0.0
    return distance <= _LONGEST and distance >= _SHORTEST
