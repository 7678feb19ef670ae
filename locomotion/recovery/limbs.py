"""Arms and legs of a person on hands and feet: angles that place them, torques that carry weight (numba)."""

import math

import numpy as np

from locomotion.body.anatomy import ANKLE, MASS, SIDE_JOINTS, TRUNK_JOINTS
from locomotion.body.arm_reach import ARM_START, _turn
from locomotion.body.leg_kinematics import solve_leg
from locomotion.body.person import JOINT_NAMES
from locomotion.gaits.walk.footholds import foot_frame
from locomotion.gaits.walk.layout import clamp
from locomotion.recovery.layout import ANCHORS, AXES, BIAS, LOADS, SEEN_COM, SEEN_FORCES
from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "ARMS", "BALL", "GRAVITY", "HIGHEST", "LEGS", "LOWEST", "STIFFNESS", "SWIVEL", "WAIST_CHEST_NECK",
    "attitude", "bear", "leg_angles", "turned",
]  # fmt: skip

_trunk = [j for p in ("waist", "chest", "head") for j in TRUNK_JOINTS[p]]
_arm = [j for p in ("clavicle", "upper_arm", "forearm", "hand") for j in SIDE_JOINTS[p]]
_leg = [j for p in ("thigh", "shank", "foot", "toes") for j in SIDE_JOINTS[p]]
_JOINTS = [*_trunk, *_arm, *_arm, *_leg, *_leg]
STIFFNESS = np.array([j.stiffness for j in _JOINTS])
"""[Nm/rad] of the 39 servos."""
LOWEST, HIGHEST = (np.radians([getattr(j, end) for j in _JOINTS]) for end in ("low", "high"))
"""Ends of the 39 joints' ranges [rad]."""
LEGS = tuple(JOINT_NAMES.index(f"{s}_hip_flexion") for s in ("right", "left"))
ARMS = ARM_START
"""Numbers of the first joints of the right and the left leg and arm."""
WAIST_CHEST_NECK = tuple(JOINT_NAMES.index(f"{part}_pitch") for part in ("waist", "chest", "neck"))
"""Numbers of the joints that bend the trunk forward."""
BALL = np.array([0.115, 0.0, 0.024 - ANKLE])
"""Middle of the sphere with which a foot on its ball touches, in the foot's frame [m]."""
SWIVEL = -0.3
"""[rad] of the upper arms: elbows out."""
_HIP_OUT = 0.085  # [m] from the middle
_ANKLE_UP, _INVERT = 0.42, 0.36  # [rad] that ankles bend before the heel comes up, and sideways
_GRASP = 40.0  # [N] with which a limb presses that bears nothing yet
GRAVITY = 9.81
"""[m/s2]"""


@kernel
def attitude(yaw, lean, roll, qref):
    """Writes the pelvis's rotation into ``qref`` (46,)."""
    a, b, c = 0.5 * yaw, 0.5 * lean, 0.5 * roll
    ca, sa, cb, sb, cc, sc = math.cos(a), math.sin(a), math.cos(b), math.sin(b), math.cos(c), math.sin(c)
    qref[3] = ca * cb * cc + sa * sb * sc
    qref[4] = ca * cb * sc - sa * sb * cc
    qref[5] = ca * sb * cc + sa * cb * sc
    qref[6] = sa * cb * cc - ca * sb * sc


@kernel
def turned(q, out):
    w, x, y, z = q
    out[0, 0], out[1, 0], out[2, 0] = 1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)
    out[0, 1], out[1, 1], out[2, 1] = 2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)
    out[0, 2], out[1, 2], out[2, 2] = 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)


@allocating_kernel
def leg_angles(qref, pelvis, ball, yaw, pitch, side, out):
    """Angles (7,) of a leg whose ball is at ``ball`` (3,), the heel raised as far as the ankle needs it."""
    hip, frame, ankle, six = np.empty(3), np.empty((3, 3)), np.empty(3), np.empty(6)
    for i in range(3):
        hip[i] = qref[i] + side * _HIP_OUT * pelvis[i, 1]
    level = np.array([0.0, 0.0, 1.0])
    heel = pitch
    for _ in range(4):
        foot_frame(yaw, level, frame)
        _turn(frame, 1, heel)
        for i in range(3):
            ankle[i] = ball[i] - BALL[0] * frame[i, 0] - BALL[2] * frame[i, 2]
        solve_leg(pelvis, hip, frame, ankle, side, six)
        if six[4] <= _ANKLE_UP:
            break
        heel += six[4] - _ANKLE_UP
    out[:6] = six
    out[5] = clamp(six[5], -_INVERT, _INVERT)
    out[6] = clamp(heel - pitch, 0.0, 1.0)


@allocating_kernel
def bear(memory, limbs, push, torques):
    """Torques (39,) [Nm] with which the limbs that are down carry the weight and accelerate the body by
    ``push`` (2,) [m/s2], by forces that pass through the centre of mass."""
    com = memory[SEEN_COM].copy()
    sx, sy = push[0] / GRAVITY, push[1] / GRAVITY
    low = 0.25 * (limbs[0, 2] + limbs[1, 2] + limbs[2, 2] + limbs[3, 2])
    com[0] -= (com[2] - low) * sx
    com[1] -= (com[2] - low) * sy
    a, force, multiplier = np.zeros((3, 3)), np.zeros(4), np.empty(3)
    loads = memory[LOADS]
    row = np.empty(3)
    for k in range(4):
        row[0], row[1], row[2] = 1.0, 2.0 * (limbs[k, 0] - com[0]), 2.0 * (limbs[k, 1] - com[1])
        for i in range(3):
            for j in range(3):
                a[i, j] += loads[k] * row[i] * row[j]
    for i in range(3):
        a[i, i] += 0.02
    # a x = (weight, 0, 0) by the first row of a's cofactors
    multiplier[0] = a[1, 1] * a[2, 2] - a[1, 2] * a[2, 1]
    multiplier[1] = a[1, 2] * a[2, 0] - a[1, 0] * a[2, 2]
    multiplier[2] = a[1, 0] * a[2, 1] - a[1, 1] * a[2, 0]
    multiplier *= MASS * GRAVITY / (a[0] @ multiplier)
    total = 0.0
    for k in range(4):
        f = multiplier[0]
        f += 2.0 * (limbs[k, 0] - com[0]) * multiplier[1] + 2.0 * (limbs[k, 1] - com[1]) * multiplier[2]
        force[k] = clamp(loads[k] * f, 0.0, 500.0)
        total += force[k]
    anchors, axes = memory[ANCHORS].reshape(39, 3), memory[AXES].reshape(39, 3)
    torques[:] = memory[BIAS]
    for k in range(4):
        f = force[k] * min(MASS * GRAVITY / max(total, 1.0), 1.5)
        f = min(f, _GRASP + 2.0 * memory[SEEN_FORCES.start + k])
        first, last = (9 + 8 * k, 17 + 8 * k) if k < 2 else (25 + 7 * (k - 2), 32 + 7 * (k - 2))
        for j in range(39):
            if not (first <= j < last or (k < 2 and j < 6)):
                continue
            rx, ry = limbs[k, 0] - anchors[j, 0], limbs[k, 1] - anchors[j, 1]
            rz = limbs[k, 2] - anchors[j, 2]
            torques[j] -= f * (
                axes[j, 0] * (ry - rz * sy) + axes[j, 1] * (rz * sx - rx) + axes[j, 2] * (rx * sy - ry * sx)
            )
