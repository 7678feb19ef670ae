"""Legs that give way as they land (numba).

Servos that hold a pose stop a fall of 5 m/s within 60 ms, with ten times the body's weight. Legs that give
way do what a person's do:

    before the touchdown  they reach down, and begin to fold a moment before it, so that the feet meet the
                          ground with little speed;
    after it              they bear the force that brings the centre of mass evenly to a wanted speed at a
                          wanted height, ``f = m (g + (vz^2 - v_end^2) / (2 (z - z_end)))``. The force along
                          the ground makes the body turn forward as fast as wanted, within the grip;
    past an angle         they change over to the pose of the roll.

A force at the sole is made as the walk does it: by the transposed Jacobian of hip, knee and ankle (all in
the plane of the approach), with the servos' damping cancelled. Servos stay within their torques.
"""

import math

import numpy as np

from locomotion.body.anatomy import ANKLE, MASS, SHANK, SIDE_JOINTS, THIGH
from locomotion.body.person import CONTROL_DT, JOINT_NAMES
from locomotion.gaits.run import layout
from surefoot.kernels import kernel

__all__ = ["GIVE", "GIVING_SIZE", "HOLDS", "fold_legs", "give_way", "sole_force"]

REACH, FOLDING, END_HEIGHT, END_SPEED, TURNING, TURNING_GAIN, BALL, END_ANGLE, BLEND = range(9)
GIVE = 9
"""Parameters: time before the touchdown at which the legs begin to fold [s]; rate of the knees then [rad/s];
height of the centre of mass [m] to slow down by, 0 for legs that hold their pose; vertical speed there [m/s];
rate of turning forward [rad/s], and moment per rate that is missing [Nms/rad]; how far ahead of the ankle the
sole bears [m]; angle of the pelvis [rad] at which the roll's pose takes over, and how long that takes [s]."""

HOLDS = 0
"""What legs that give way remember: share of their targets, 1 from the touchdown on, that fades to 0; then
the last rates of hip, knee and ankle, right and left [rad/s]."""
_RATES = 1
GIVING_SIZE = 7

HIPS = (JOINT_NAMES.index("right_hip_flexion"), JOINT_NAMES.index("left_hip_flexion"))
LEG = (0, 3, 4)
"""Hip, knee and ankle from a hip's place on."""
_JOINTS = (SIDE_JOINTS["thigh"][0], SIDE_JOINTS["shank"][0], SIDE_JOINTS["foot"][0])
STIFFNESS = np.array([joint.stiffness for joint in _JOINTS])
MOST_TORQUE = np.array([joint.torque for joint in _JOINTS])
LEAD = 0.1
"""[s] servo damping per stiffness, as in `locomotion.body.person`."""
FOLDS_AHEAD = 0.12
"""[s] by which the targets of folding legs are ahead: what the damping holds back, and two ticks."""
_GRAVITY = 9.81
_LEAST_STROKE = 0.04  # [m] over which it slows down at least
_MOST_WEIGHTS = 9.0
_GRIP = 0.6  # force along the ground per force upwards
_LEAST_DEPTH = 0.2  # [m] of the feet below the centre of mass
_TOUCHES = 1.0  # [N] of a foot on the ground
_IN_THE_AIR = 0.3, 0.1  # share of the force of each foot while both are in the air, of one beside the other
_LONGEST = 45.0  # ticks
_MOST_JERK = 400.0  # [rad/s^2] of a joint's rate, by which the next rate is foreseen


@kernel
def fold_legs(p, qpos, ctrl):
    """In the fall, a moment before the touchdown: knees and hips begin to fold. p (GIVE,)."""
    for leg in range(2):
        hip = HIPS[leg]
        ctrl[hip] = qpos[7 + hip] + 0.5 * FOLDS_AHEAD * p[FOLDING]
        ctrl[hip + 3] = qpos[7 + hip + 3] + FOLDS_AHEAD * p[FOLDING]


@kernel
def _shares(state):
    """Share of the force that each foot bears, right and left."""
    right = state[layout.RIGHT_CONTACT] > _TOUCHES
    left = state[layout.LEFT_CONTACT] > _TOUCHES
    if right and left:
        return 0.5, 0.5
    if right:
        return 1.0, _IN_THE_AIR[1]
    if left:
        return _IN_THE_AIR[1], 1.0
    return _IN_THE_AIR[0], _IN_THE_AIR[0]


@kernel
def sole_force(p, state, ahead_x, ahead_y, low, rate):
    """Force on both soles together, along the approach and upwards [N]. low: height of the ground [m];
    rate: of turning forward [rad/s]."""
    vz = state[layout.VELOCITY_Z]
    up = _GRAVITY
    if vz < p[END_SPEED]:
        stroke = max(state[layout.COM_Z] - low - p[END_HEIGHT], _LEAST_STROKE)
        up += (vz * vz - p[END_SPEED] * p[END_SPEED]) / (2.0 * stroke)
    upward = MASS * min(max(up, 0.0), _MOST_WEIGHTS * _GRAVITY)
    right, left = _shares(state)
    ahead = below = 0.0  # of the centre of mass
    for leg in range(2):
        share = (right if leg == 0 else left) / (right + left)
        foot = layout.RIGHT_FOOT if leg == 0 else layout.LEFT_FOOT
        x, y = state[foot] - state[layout.COM_X], state[foot + 1] - state[layout.COM_Y]
        ahead += share * (x * ahead_x + y * ahead_y + p[BALL])
        below += share * (state[layout.COM_Z] - state[foot + 2] + ANKLE)
    moment = p[TURNING_GAIN] * (p[TURNING] - rate)
    along = -(moment + ahead * upward) / max(below, _LEAST_DEPTH)
    return min(max(along, -_GRIP * upward), _GRIP * upward), upward


@kernel
def give_way(p, giving, ticks, angle, force, state, qpos, qvel, ctrl):
    """A tick on the ground: targets of hips, knees and ankles with which the soles bear ``force``, mixed
    into ``ctrl`` (39,) as far as the law still holds.

    p (GIVE,). giving (GIVING_SIZE,): changed. ticks: since the touchdown. angle: of the pelvis, forward
    [rad]. force: of `sole_force`.
    """
    if angle > p[END_ANGLE] or ticks > _LONGEST or giving[HOLDS] < 1.0:
        giving[HOLDS] = max(giving[HOLDS] - CONTROL_DT / max(p[BLEND], CONTROL_DT), 0.0)
    holds = giving[HOLDS]
    if holds <= 0.0:
        return
    along, upward = force
    shares = _shares(state)
    for leg in range(2):
        hip = HIPS[leg]
        thigh = qpos[7 + hip] - angle  # of each part to the vertical, forward [rad]
        shank = thigh - qpos[7 + hip + 3]
        foot = shank + qpos[7 + hip + 4]
        # the point of the sole from ankle, knee and hip
        x = p[BALL] * math.cos(foot) + ANKLE * math.sin(foot)
        z = p[BALL] * math.sin(foot) - ANKLE * math.cos(foot)
        at_ankle = z * along - x * upward
        x, z = x + SHANK * math.sin(shank), z - SHANK * math.cos(shank)
        at_knee = x * upward - z * along
        x, z = x + THIGH * math.sin(thigh), z - THIGH * math.cos(thigh)
        at_hip = z * along - x * upward
        torques = (at_hip, at_knee, at_ankle)
        share = shares[leg]
        for k in range(3):
            joint = hip + LEG[k]
            rate, last = qvel[6 + joint], giving[_RATES + 3 * leg + k]
            giving[_RATES + 3 * leg + k] = rate
            if ticks > 0.5:  # the rate in the middle of the tick
                jerk = min(max((rate - last) / CONTROL_DT, -_MOST_JERK), _MOST_JERK)
                rate += 0.4 * CONTROL_DT * jerk
            torque = min(max(share * torques[k], -MOST_TORQUE[k]), MOST_TORQUE[k])
            target = qpos[7 + joint] + (0.5 * CONTROL_DT + LEAD) * rate + torque / STIFFNESS[k]
            ctrl[joint] += holds * (target - ctrl[joint])
