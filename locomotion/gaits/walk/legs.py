"""What the legs of a walking person do: a stance leg makes a force, a swing leg is aimed (numba)."""

import math

import numpy as np

from locomotion.body.anatomy import ANKLE, SHANK, SIDE_JOINTS, THIGH
from locomotion.body.leg_dynamics import swing_torques
from locomotion.body.leg_kinematics import solve_leg
from locomotion.body.person import CONTROL_DT
from locomotion.gaits.walk.footholds import SOLE, foot_frame, moved, risen
from locomotion.gaits.walk.layout import (
    CLOCK,
    FOOTHOLD,
    FOOTHOLD_NORMAL,
    FOOTHOLD_YAW,
    GAINS,
    HUMP,
    LIFT,
    LIFT_NORMAL,
    LIFT_YAW,
    STEEPNESS,
    SWING_ANGLES,
    SWING_TIME,
    clamp,
    steep_share,
    wrap,
)
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["height_in_reach", "steady_foot", "support_leg", "swing_leg"]

_I = {name: i for i, name in enumerate(GAINS)}
_CLEARANCE, _LEAD, _FORESEEN = _I["clearance"], _I["swing_lead"], _I["swing_foreseen"]
_SPOT, _NORMAL, _LIFT, _LIFT_NORMAL, _ANGLES = (
    FOOTHOLD.start, FOOTHOLD_NORMAL.start, LIFT.start, LIFT_NORMAL.start, SWING_ANGLES.start,
)  # fmt: skip
_STIFFNESS = np.array([j.stiffness for part in ("thigh", "shank", "foot") for j in SIDE_JOINTS[part]])
_LEAD_TIME = 0.1  # servo damping per stiffness [s], as in locomotion.body.person
_PRESS = 0.01  # [m] below its foothold that the swing foot goes on steep ground, to touch for certain
_AHEAD = 0.015  # [s] until a PD target has worked: it holds for a tick and is compared with after it
_NEARBY = 0.02  # [s] before and after that at which the swing's plan is looked at
_MOST_RATE = 20.0  # [rad/s] of a swing leg's angles
_MOST_CHANGE = 300.0  # [rad/s^2] of a swing leg's angles
_HIP, _KNEE = 0, 3  # of a leg's angles
_REACH = 0.97 * (THIGH + SHANK)  # [m] from hip to ankle when a foot lands, at most


@kernel
def support_leg(hip, damping, force, cop, yaw_moment, anchors, axes, hold, span, qpos, qvel, ctrl):
    """A leg that makes the ground push with ``force`` (3,) at ``cop`` (3,): transposed Jacobian, as PD
    targets. hold (3,): rotation [rad] by which the ankle's servos turn the foot, too; they keep their damping
    about the axes about which the foot does not stand: span (2,)."""
    for j in range(6):
        axis, anchor = axes[j], anchors[j]
        rx, ry, rz = cop[0] - anchor[0], cop[1] - anchor[1], cop[2] - anchor[2]
        moment = axis[0] * (ry * force[2] - rz * force[1])
        moment += axis[1] * (rz * force[0] - rx * force[2])
        moment += axis[2] * (rx * force[1] - ry * force[0] + yaw_moment)
        rate = damping * _LEAD_TIME * qvel[6 + hip + j]
        if j > 3:
            rate *= span[j - 4]
        ctrl[hip + j] = qpos[7 + hip + j] - moment / _STIFFNESS[j] + rate
        if j > 3:
            ctrl[hip + j] += axis[0] * hold[0] + axis[1] * hold[1] + axis[2] * hold[2]


@kernel
def steady_foot(share, span, foot, normal, out):
    """Rotation ``out`` (3,) [rad] that turns a foot (9,) to its ``normal`` (3,) about the axes about which
    it does not stand: along where its width bears nothing, across where its length does."""
    ux, uy, uz = foot[2], foot[5], foot[8]
    rx, ry, rz = (
        uy * normal[2] - uz * normal[1],
        uz * normal[0] - ux * normal[2],
        ux * normal[1] - uy * normal[0],
    )
    about_x = share * (1.0 - span[1]) * (rx * foot[0] + ry * foot[3] + rz * foot[6])
    about_y = share * (1.0 - span[0]) * (rx * foot[1] + ry * foot[4] + rz * foot[7])
    for i in range(3):
        out[i] = about_x * foot[3 * i] + about_y * foot[3 * i + 1]


@allocating_kernel
def height_in_reach(walk, com, velocity, hip):
    """Height [m] of the centre of mass ``com`` (3,) from which the swing leg reaches its foothold when it is
    due. hip (3,): where it is now."""
    left = max(walk[SWING_TIME] - walk[CLOCK], 0.0)
    foot = np.empty((3, 3))
    foot_frame(walk[FOOTHOLD_YAW], walk[_NORMAL : _NORMAL + 3], foot)
    dx = walk[_SPOT] - SOLE * foot[0, 0] + ANKLE * foot[0, 2] - hip[0] - left * velocity[0]
    dy = walk[_SPOT + 1] - SOLE * foot[1, 0] + ANKLE * foot[1, 2] - hip[1] - left * velocity[1]
    up = math.sqrt(max(_REACH * _REACH - dx * dx - dy * dy, 0.25 * _REACH * _REACH))
    return walk[_SPOT + 2] - SOLE * foot[2, 0] + ANKLE * foot[2, 2] + up - hip[2] + com[2]


@allocating_kernel
def _swing_angles(gains, walk, pelvis, hip_at, side, clock, angles):
    """Angles (6,) [rad] of a leg from a hip at ``hip_at`` (3,) whose foot is where it is to be at
    ``clock``."""
    share = clock / walk[SWING_TIME]
    move = moved(share)
    spot, normal = np.empty(3), np.empty(3)
    for i in range(3):
        spot[i] = walk[_LIFT + i] + move * (walk[_SPOT + i] - walk[_LIFT + i])
        turned = clamp(2.0 * share - 0.7, 0.0, 1.0)
        normal[i] = walk[_LIFT_NORMAL + i] + turned * (walk[_NORMAL + i] - walk[_LIFT_NORMAL + i])
    normal /= math.sqrt(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2)
    spot[2] = walk[_LIFT + 2] + risen(share, walk[_SPOT + 2] - walk[_LIFT + 2])
    spot[2] += (gains[_CLEARANCE] + walk[HUMP]) * math.sin(math.pi * min(share, 1.0))
    spot[2] -= steep_share(walk[STEEPNESS]) * _PRESS * clamp(5.0 * share - 4.0, 0.0, 1.0)
    if share > 1.0:  # the ground is lower than thought: reach for it
        spot[2] -= 0.35 * (clock - walk[SWING_TIME])
    foot = np.empty((3, 3))
    foot_frame(walk[LIFT_YAW] + move * wrap(walk[FOOTHOLD_YAW] - walk[LIFT_YAW]), normal, foot)
    ankle = np.empty(3)
    for i in range(3):
        ankle[i] = spot[i] - SOLE * foot[i, 0] + ANKLE * foot[i, 2]
    solve_leg(pelvis, hip_at, foot, ankle, side, angles)


@allocating_kernel
def swing_leg(gains, walk, pelvis, hip_at, velocity, hip, side, ctrl):
    """A leg whose foot moves to its foothold: PD targets by inverse kinematics. hip_at (3,), velocity (2,):
    of its hip."""
    frame = pelvis.copy().reshape(3, 3)
    angles = np.empty(6)
    _swing_angles(gains, walk, frame, hip_at, side, walk[CLOCK], angles)
    for j in range(6):
        rate = clamp((angles[j] - walk[_ANGLES + j]) / CONTROL_DT, -12.0, 12.0)
        walk[_ANGLES + j] = angles[j]
        ctrl[hip + j] = angles[j] + gains[_LEAD] * rate
    if gains[_FORESEEN] > 0.0:
        wanted = np.empty(6)
        _foresee(gains, walk, frame, hip_at, velocity, side, wanted)
        for j in range(6):
            ctrl[hip + j] += gains[_FORESEEN] * (wanted[j] - ctrl[hip + j])


@allocating_kernel
def _foresee(gains, walk, frame, hip_at, velocity, side, wanted):
    """PD targets (6,) with which the leg is where it is planned to be when they have worked: from the plan a
    little ahead, from a hip that goes on as it does, its rates, and the torques that moving so takes."""
    plan, place = np.empty((3, 6)), hip_at.copy()
    for k in range(3):
        later = _AHEAD + (k - 1) * _NEARBY
        for i in range(2):
            place[i] = hip_at[i] + later * velocity[i]
        _swing_angles(gains, walk, frame, place, side, max(walk[CLOCK] + later, 0.0), plan[k])
    rates, changes = np.empty(6), np.empty(6)
    for j in range(6):
        rates[j] = clamp((plan[2, j] - plan[0, j]) / (2.0 * _NEARBY), -_MOST_RATE, _MOST_RATE)
        change = (plan[2, j] - 2.0 * plan[1, j] + plan[0, j]) / (_NEARBY * _NEARBY)
        changes[j] = clamp(change, -_MOST_CHANGE, _MOST_CHANGE)
        wanted[j] = plan[1, j] + _LEAD_TIME * rates[j]
    thigh = plan[1, _HIP] - math.atan2(-frame[2, 0], frame[2, 2])
    about_hip, about_knee = swing_torques(
        thigh, thigh - plan[1, _KNEE], rates[_HIP], rates[_HIP] - rates[_KNEE],
        changes[_HIP], changes[_HIP] - changes[_KNEE],
    )  # fmt: skip
    wanted[_HIP] += about_hip / _STIFFNESS[_HIP]
    wanted[_KNEE] -= about_knee / _STIFFNESS[_KNEE]
