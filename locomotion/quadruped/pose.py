"""From the state of an animal to where all its bones are.

Bodies in order: pelvis, the spine's bones, neck, head, three of the tail, and three bones of each leg in the
order of `layout.LEGS`. A body's frame sits at its upper or rear end, x along the bone.
"""

from __future__ import annotations

import math

from locomotion.quadruped import layout as at
from locomotion.quadruped.back import bone_drop, chord_pitch, girdles
from locomotion.quadruped.legs import solve_leg
from surefoot.kernels import kernel

__all__ = ["body_names", "body_parents", "count_bodies", "write_pose"]

_NEAREST = 0.25  # of the length of its two long bones, on top of most of the foot's, that a swinging foot is
# kept below its joint
_LEAST_LIFT = 0.1  # of a lift that is made even there
_NECK_TILT, _NECK_STEADY = 0.4, 0.25  # shares of the trunk's tilt, and of the chest's against it, at the neck
_HEAD_STEADY = 0.6  # share of the neck's dip that the head does not make
_LEG_BONES = ("upper", "lower", "foot")


def count_bodies(bones: int) -> int:
    """How many bodies an animal of so many spine bones has."""
    return 1 + bones + 2 + 3 + 12


def body_names(bones: int) -> tuple[str, ...]:
    """Names of the bodies in order."""
    spine = [f"spine_{k + 1}" for k in range(bones)]
    legs = [f"{leg}_{bone}" for leg in at.LEGS for bone in _LEG_BONES]
    return ("pelvis", *spine, "neck", "head", "tail_1", "tail_2", "tail_3", *legs)


def body_parents(bones: int) -> list[int]:
    """Index of each body's parent, -1 for the root."""
    chest, first_leg = bones, bones + 6
    parents = [-1, *range(bones), chest, bones + 1, 0, bones + 3, bones + 4]
    for leg in range(4):
        parents += [chest if leg < 2 else 0, first_leg + 3 * leg, first_leg + 3 * leg + 1]
    return parents


@kernel(forceinline=True)
def _frame(row, x, y, z, yaw, up):
    """A frame at (x, y, z) whose x axis points to ``yaw`` and ``up`` [rad] over the horizontal."""
    cy, sy = math.cos(0.5 * yaw), math.sin(0.5 * yaw)
    cp, sp = math.cos(0.5 * up), -math.sin(0.5 * up)
    row[0], row[1], row[2] = x, y, z
    row[3], row[4], row[5], row[6] = cy * cp, -sy * sp, cy * sp, sy * cp


@kernel(forceinline=True)
def _roll_frame(row, roll):
    """Turn a frame about its own x axis: the left side up by ``roll`` [rad]."""
    c, s = math.cos(0.5 * roll), math.sin(0.5 * roll)
    w, i, j, k = row[3], row[4], row[5], row[6]
    row[3], row[4], row[5], row[6] = w * c - i * s, i * c + w * s, j * c + k * s, k * c - j * s


@kernel(forceinline=True)
def _leg_frame(row, x, y, z, cy, sy, ca, sa, angle):
    """A frame at (x, y, z): turned by the half angles of yaw and abduction, x along a bone at ``angle``."""
    half = 0.5 * (0.5 * math.pi - angle)
    cb, sb = math.cos(half), math.sin(half)
    w, i, j, k = cy * ca, cy * sa, sy * sa, sy * ca
    row[0], row[1], row[2] = x, y, z
    row[3], row[4], row[5], row[6] = w * cb - j * sb, i * cb - k * sb, w * sb + j * cb, k * cb + i * sb


@kernel
def write_pose(st, pr, feet, out, joints):
    """Write the bodies' frames (m, 7) and the joint angles (JOINTS,) of one animal."""
    bones = int(pr[at.BONES])
    bone, bend = pr[at.BONE], st[at.BEND] + st[at.SIDE_BEND] / pr[at.BONES]
    pitch, tilt = st[at.PITCH], chord_pitch(st, pr) + st[at.TILT]
    rear_x, rear_y, rear, _, _, _ = girdles(st, pr)
    x, y, z, yaw, up = rear_x, rear_y, st[at.Z_REAR], rear, tilt + st[at.BACK] * pr[at.SACRAL]
    _frame(out[0], x, y, z, yaw, up)
    _roll_frame(out[0], st[at.ROLL_REAR])
    for k in range(bones):
        yaw += bend
        up = tilt - st[at.BACK] * bone_drop(k + 1.0, pr[at.BONES], pr[at.SACRAL])
        _frame(out[1 + k], x, y, z, yaw, up)
        share = (k + 1.0) / bones
        _roll_frame(out[1 + k], (1.0 - share) * st[at.ROLL_REAR] + share * st[at.ROLL_FRONT])
        flat = bone * math.cos(up)
        x += flat * math.cos(yaw)
        y += flat * math.sin(yaw)
        z += bone * math.sin(up)
    front_x, front_y, front_z, chest = x, y, z, yaw
    dip = st[at.NECK_DIP] + st[at.DIP]
    up = pr[at.NECK_RISE] + _NECK_TILT * pitch + _NECK_STEADY * (up - pitch) - dip
    yaw += 0.5 * st[at.GAZE]
    _frame(out[1 + bones], x, y, z, yaw, up)
    flat = pr[at.NECK] * math.cos(up)
    _frame(
        out[2 + bones], x + flat * math.cos(yaw), y + flat * math.sin(yaw), z + pr[at.NECK] * math.sin(up),
        chest + st[at.GAZE],
        _NECK_TILT * pitch - pr[at.HEAD_DROP] - (1.0 - _HEAD_STEADY) * st[at.NECK_DIP] - st[at.DIP],
    )  # fmt: skip
    x, y, z = rear_x, rear_y, st[at.Z_REAR]
    for k in range(3):
        yaw, up = rear + math.pi + st[at.TAIL_YAW + k], st[at.TAIL_UP + k]
        _frame(out[3 + bones + k], x, y, z, yaw, up)
        flat = pr[at.TAIL] * math.cos(up)
        x += flat * math.cos(yaw)
        y += flat * math.sin(yaw)
        z += pr[at.TAIL] * math.sin(up)
    first = 6 + bones
    for leg in range(4):
        if leg < 2:
            _leg(
                st, pr, feet[leg], out[first + 3 * leg : first + 3 * leg + 3], joints, leg,
                front_x, front_y, front_z, chest, pr[at.WIDTH_FRONT], st[at.ROLL_FRONT], at.UPPER_FRONT,
                pr[at.CURL_FRONT], -1.0,
            )  # fmt: skip
        else:
            _leg(
                st, pr, feet[leg], out[first + 3 * leg : first + 3 * leg + 3], joints, leg,
                rear_x, rear_y, st[at.Z_REAR], rear, pr[at.WIDTH_REAR], st[at.ROLL_REAR], at.UPPER_REAR,
                pr[at.CURL_REAR], 1.0,
            )  # fmt: skip
    joints[at.JOINTS - 5], joints[at.JOINTS - 4], joints[at.JOINTS - 3] = bend, st[at.GAZE], pitch
    joints[at.JOINTS - 2], joints[at.JOINTS - 1] = st[at.BACK], dip


@kernel
def _leg(st, pr, foot, out, joints, leg, x, y, z, yaw, width, roll, sizes, curl, side):
    upper, lower, last, lean = pr[sizes], pr[sizes + 1], pr[sizes + 2], pr[sizes + 3]
    c, s = math.cos(yaw), math.sin(yaw)
    across = 0.5 * width if leg % 2 == 0 else -0.5 * width
    z += across * math.sin(roll)
    jx, jy = x - across * s, y + across * c
    dx, dy, dz = foot[at.FX] - jx, foot[at.FY] - jy, foot[at.FZ] - z
    curled = 0.0
    if foot[at.IN_SWING] > 0.0:
        lift = foot[at.FZ] - foot[at.BASE]
        room = max(-0.8 * last - _NEAREST * (upper + lower) - dz + lift, _LEAST_LIFT * st[at.LIFT_NOW])
        dz += room * (1.0 - math.exp(-lift / room)) - lift
        curled = curl * math.tanh(lift / max(st[at.LIFT_NOW], 1e-3))
    ahead, beside = c * dx + s * dy, c * dy - s * dx
    down = math.sqrt(beside * beside + dz * dz)
    spread = math.atan2(beside, -dz)
    first, second, third = solve_leg(ahead, -down, upper, lower, last, lean, curled, side)
    cy, sy = math.cos(0.5 * yaw), math.sin(0.5 * yaw)
    ca, sa = math.cos(0.5 * spread), math.sin(0.5 * spread)
    cs, ss = math.cos(spread), math.sin(spread)
    px, pz = 0.0, 0.0
    for k in range(3):
        angle = first if k == 0 else (second if k == 1 else third)
        across = -pz * ss
        _leg_frame(
            out[k], jx + c * px - s * across, jy + s * px + c * across, z + pz * cs, cy, sy, ca, sa, angle
        )
        length = upper if k == 0 else lower
        px += length * math.sin(angle)
        pz -= length * math.cos(angle)
    own = leg * at.JOINTS_PER_LEG
    joints[own], joints[own + 1], joints[own + 2], joints[own + 3] = spread, first, second, third
