"""Where a hand is and how an arm reaches a point, in closed form from the person's coordinates (numba
kernels).

The arm is a chain of two links. Its elbow angle follows from the distance (law of cosines), the shoulder's
abduction and flexion from the direction, for a given rotation of the upper arm, which decides where the elbow
points. Everything is computed from ``qpos``, so that a controller that uses it depends on nothing else.
"""

import math

import numpy as np

from locomotion.body.anatomy import FOREARM, UPPER_ARM
from locomotion.body.hand_hold import HAND_POINT
from locomotion.body.person import JOINT_NAMES
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["ARM_START", "HAND_RADIUS", "hand_place", "reach", "shoulder_frame"]

HAND_RADIUS = 0.028
"""[m] of the hand's capsule."""
ARM_START = (JOINT_NAMES.index("right_shoulder_flexion"), JOINT_NAMES.index("left_shoulder_flexion"))
"""Number of the first of the four joints that reach: shoulder flexion, abduction, rotation, elbow flexion."""

_R_CLAVICLE, _L_CLAVICLE = ARM_START[0] - 1, ARM_START[1] - 1
_R_ARM, _L_ARM = ARM_START
_LINK = FOREARM - HAND_POINT[2]  # elbow to the hand's point, wrist straight
_WAIST_UP, _CHEST_UP = 0.12, 0.20  # [m] as in locomotion.body.person
_CLAVICLE_OUT, _CLAVICLE_UP, _SHOULDER_OUT = 0.035, 0.165, 0.150
_MAX_REACH = 0.995  # share of the arm's length


@kernel
def _turn(frame, axis, angle):
    """``frame`` (3, 3) times the rotation by ``angle`` about its own coordinate axis."""
    c, s = math.cos(angle), math.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    for k in range(3):
        a, b = frame[k, i], frame[k, j]
        frame[k, i] = c * a + s * b
        frame[k, j] = c * b - s * a


@allocating_kernel
def shoulder_frame(qpos, side):
    """Place (3,) [m] and frame (3, 3) of the shoulder of ``side`` (-1 right, +1 left), before its own
    joints."""
    w, x, y, z = qpos[3], qpos[4], qpos[5], qpos[6]
    f = np.empty((3, 3))
    f[0, 0], f[1, 0], f[2, 0] = 1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)
    f[0, 1], f[1, 1], f[2, 1] = 2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)
    f[0, 2], f[1, 2], f[2, 2] = 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)
    p = np.empty(3)
    for k in range(3):
        p[k] = qpos[k] + _WAIST_UP * f[k, 2]
    for first in (7, 10):  # waist, chest: pitch, roll, yaw
        _turn(f, 1, qpos[first])
        _turn(f, 0, qpos[first + 1])
        _turn(f, 2, qpos[first + 2])
        for k in range(3):
            if first == 7:
                p[k] += _CHEST_UP * f[k, 2]
            else:
                p[k] += side * _CLAVICLE_OUT * f[k, 1] + _CLAVICLE_UP * f[k, 2]
    _turn(f, 0, side * qpos[7 + (_L_CLAVICLE if side > 0 else _R_CLAVICLE)])
    for k in range(3):
        p[k] += side * _SHOULDER_OUT * f[k, 1]
    return p, f


@allocating_kernel
def hand_place(qpos, side):
    """The hand's point (3,) [m] of ``side`` (-1 right, +1 left)."""
    p, f = shoulder_frame(qpos, side)
    a = 7 + (_L_ARM if side > 0 else _R_ARM)
    _turn(f, 1, -qpos[a])
    _turn(f, 0, side * qpos[a + 1])
    _turn(f, 2, -side * qpos[a + 2])
    for k in range(3):
        p[k] -= UPPER_ARM * f[k, 2]
    _turn(f, 1, -qpos[a + 3])
    _turn(f, 2, -side * qpos[a + 4])
    for k in range(3):
        p[k] -= FOREARM * f[k, 2]
    _turn(f, 0, side * qpos[a + 5])
    _turn(f, 1, -qpos[a + 6])
    for k in range(3):
        p[k] += HAND_POINT[0] * f[k, 0] + HAND_POINT[2] * f[k, 2]
    return p


@allocating_kernel
def reach(qpos, side, target, rotation, out):
    """Angles [rad] of shoulder flexion, abduction, rotation and elbow flexion into ``out`` (4,) that bring
    the hand of ``side`` to ``target`` (3,) [m], or as near as the arm is long; the upper arm is turned
    inward by ``rotation`` [rad]. Points sideways of a strongly bent arm are out of reach too: without
    turning the upper arm its hand lies in front. Returns the distance from the shoulder to the target over
    the arm's length."""
    p, f = shoulder_frame(qpos, side)
    t = np.zeros(3)
    for k in range(3):
        for j in range(3):
            t[j] += f[k, j] * (target[k] - p[k])
    t[1] *= side
    distance = max(math.sqrt(t[0] ** 2 + t[1] ** 2 + t[2] ** 2), 1e-6)
    length = UPPER_ARM + _LINK
    wanted = min(max(distance, 0.15), _MAX_REACH * length)
    for j in range(3):
        t[j] *= wanted / distance
    bend = (UPPER_ARM**2 + _LINK**2 - wanted**2) / (2.0 * UPPER_ARM * _LINK)
    elbow = math.pi - math.acos(min(max(bend, -1.0), 1.0))
    forward, down = _LINK * math.sin(elbow), UPPER_ARM + _LINK * math.cos(elbow)
    wx, wy = forward * math.cos(rotation), -forward * math.sin(rotation)
    radius = math.hypot(wy, down)
    abduction = math.asin(min(max(t[1] / radius, -1.0), 1.0)) - math.atan2(wy, down)
    wz = wy * math.sin(abduction) - down * math.cos(abduction)
    out[0] = math.atan2(t[0], -t[2]) - math.atan2(wx, -wz)
    out[0] = (out[0] + math.pi) % (2.0 * math.pi) - math.pi
    out[1], out[2], out[3] = abduction, rotation, elbow
    return distance / length
