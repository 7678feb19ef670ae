"""The walking controller: capture-point steps, stance legs that make forces, a swing leg that is aimed
(numba).

Per control tick of 10 ms the order is *control, physics, observe*, as in `locomotion.controller`, whose
``state`` also holds what was observed::

    gains, walk = load_walk_gains(), new_walk(heading)
    each tick:
        walk_tick(gains, ground, walk, state, command, data.qpos, data.qvel, data.ctrl)
        mujoco.mj_step(model, data, STEPS_PER_TICK)
        observe(index, model, data, state)
        observe_walk(index, data, walk)

A simulation is saved by copying ``mjSTATE_INTEGRATION``, ``state`` and ``walk``.

``command`` (4,) float64 = heading [rad], speed [m/s], sideways speed to the left [m/s], slope of the way
[rise over run]; all may jump. A person told 0 m/s makes its steps small and then stands.

What the body does (S. Coros et al., "Generalized biped walking control", 2010, for the forces;
`locomotion.footholds` for the steps): the stance leg pushes with the force that keeps height and trunk and
that passes near the centre of mass from a centre of pressure chosen under the foot, by the transposed
Jacobian of its joints; the swing foot is moved to its foothold by inverse kinematics. Servos are told
angles: a torque t is asked for as q + t / stiffness, with the servo's damping cancelled.
"""

import math

import mujoco
import numpy as np
from numba import njit

from locomotion import run_layout
from locomotion.anatomy import ANKLE, MASS, SIDE_JOINTS
from locomotion.footholds import foot_frame, plan_foothold, sway
from locomotion.leg_kinematics import solve_leg
from locomotion.person import CONTROL_DT, JOINT_NAMES, PersonIndex
from locomotion.walk_layout import (
    CLOCK,
    DOUBLE,
    FOOTHOLD,
    FOOTHOLD_NORMAL,
    FOOTHOLD_YAW,
    GAINS,
    HUMP,
    LIFT,
    LIFT_NORMAL,
    LIFT_YAW,
    MISSED,
    PHASE,
    SEEN_ANCHORS,
    SEEN_AXES,
    SEEN_FEET,
    SEEN_PELVIS,
    SEEN_SOLES,
    SEEN_TORQUES,
    SETTING_OFF,
    SIDEWAYS,
    SINGLE,
    STANDING,
    STEPPED_AT,
    STEPPED_FROM,
    SWING_ANGLES,
    SWING_TIME,
    WALK_HEADING,
    WALK_SPEED,
    WALK_STANCE,
    WALK_STEPS,
    WALK_TICKS,
    WALK_TRIM,
    WALK_TURN_RATE,
)

__all__ = ["SOLE", "begin_swing", "observe_walk", "walk_tick"]

SOLE = 0.045
"""[m] from below the ankle forward to the middle of the sole."""

_I = {name: i for i, name in enumerate(GAINS)}
_SWING, _TRANSFER, _WIDTH, _HEIGHT = _I["swing_time"], _I["transfer_time"], _I["width"], _I["height"]
_P_GAIN, _P_ALONG, _P_ACROSS, _P_REST = (
    _I["pressure_gain"], _I["pressure_along"], _I["pressure_across"], _I["pressure_rest"],
)  # fmt: skip
_Z_STIFF, _Z_DAMP, _DROP, _Z_SLOPE = (
    _I["height_stiffness"],
    _I["height_damping"],
    _I["drop"],
    _I["height_slope"],
)
_TILT, _TILT_DAMP, _TILT_MOST = _I["tilt_stiffness"], _I["tilt_damping"], _I["tilt_moment"]
_YAW, _YAW_DAMP, _REACTION, _MOMENT = _I["yaw_stiffness"], _I["yaw_damping"], _I["reaction"], _I["moment"]
_LEAN, _LEAN_SLOPE, _LEG_DAMPING = _I["lean"], _I["lean_slope"], _I["leg_damping"]
_CLEARANCE, _LEAD, _ARMS = _I["clearance"], _I["swing_lead"], _I["arm_swing"]
_SPOT, _NORMAL, _LIFT, _LIFT_NORMAL, _ANGLES = (
    FOOTHOLD.start, FOOTHOLD_NORMAL.start, LIFT.start, LIFT_NORMAL.start, SWING_ANGLES.start,
)  # fmt: skip
_SOLES, _FEET, _PELVIS = SEEN_SOLES.start, SEEN_FEET.start, SEEN_PELVIS.start
_STEPPED = STEPPED_FROM.start
_ANCHORS, _AXES, _TORQUES = SEEN_ANCHORS.start, SEEN_AXES.start, SEEN_TORQUES.start
_COM, _VEL, _CONTACT = run_layout.COM.start, run_layout.COM_VELOCITY.start, run_layout.CONTACT.start
_TARGETS = run_layout.LAST_TARGET.start
_R_HIP, _L_HIP = (JOINT_NAMES.index(f"{s}_hip_flexion") for s in ("right", "left"))
_SHOULDER, _ABDUCTION, _ELBOW = (
    np.array([JOINT_NAMES.index(f"{s}_{name}") for s in ("right", "left")])
    for name in ("shoulder_flexion", "shoulder_abduction", "elbow_flexion")
)
_WAIST, _CHEST, _NECK = (JOINT_NAMES.index(f"{part}_pitch") for part in ("waist", "chest", "neck"))
_STIFFNESS = np.array([j.stiffness for part in ("thigh", "shank", "foot") for j in SIDE_JOINTS[part]])
_LEAD_TIME = 0.1  # servo damping per stiffness [s], as in locomotion.person
_PELVIS_BODY = 1
_GRAVITY = 9.81
_TOUCH = 40.0  # [N] under the swing foot that end the step
_LANDING, _NEAR = 0.8, 0.12  # share of the swing after which, or [m] from its foothold where it may land
_TURN_RATE, _TURN_CHANGE = 1.2, 6.0  # [rad/s], [rad/s^2]
_FASTER, _SLOWER, _SIDE_CHANGE = 0.8, 1.0, 0.5  # [m/s^2] of the reference speeds
_STILL, _STRAIGHT, _AWRY = 0.02, 0.2, 0.3  # [m/s], [rad] below which it stands; [rad] above which it sets off
_SETTLED = 0.05  # [m/s] of the reference speed below which it stands
_SET_OFF_LIMIT = 3.0  # [s] after which the first step is made regardless
_UNLOADED = 0.15  # share of the weight on the first stance leg while it is pushed over it
_TRIM_RATE, _MOST_TRIM = 0.05, 0.2  # share of a step's error in speed; [m/s]
_STRAIGHTEN = 0.4  # share of the pelvis's lean that waist and chest take back, each
_FRICTION = 0.75  # sideways per upward force at most
_MAX_SLOPE = 0.8
_YAW_MOMENT = 25.0  # [Nm]


@njit(cache=True)
def _clamp(x, low, high):
    return min(max(x, low), high)


@njit(cache=True)
def _wrap(angle):
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


@njit(cache=True)
def _observe(walk, feet, positions, rotations, anchors, axes, torques):
    for k in range(2):
        foot = rotations[feet[k]]
        for i in range(3):
            sole = positions[feet[k], i] + SOLE * foot[3 * i] - ANKLE * foot[3 * i + 2]
            walk[_SOLES + 3 * k + i] = sole
        for i in range(9):
            walk[_FEET + 9 * k + i] = foot[i]
        hip = _L_HIP if k == 1 else _R_HIP
        for j in range(6):
            walk[_TORQUES + 6 * k + j] = torques[hip + j]
            for i in range(3):
                walk[_ANCHORS + 18 * k + 3 * j + i] = anchors[hip + 1 + j, i]
                walk[_AXES + 18 * k + 3 * j + i] = axes[hip + 1 + j, i]
    for i in range(9):
        walk[_PELVIS + i] = rotations[_PELVIS_BODY, i]


def observe_walk(index: PersonIndex, data: mujoco.MjData, walk: np.ndarray) -> None:
    """Read the frames of feet, pelvis and leg joints and the legs' torques of ``data`` into ``walk``."""
    _observe(walk, index.feet, data.xpos, data.xmat, data.xanchor, data.xaxis, data.actuator_force)


@njit(cache=True)
def begin_swing(gains, walk, qpos):
    """Single support begins: remember where the swing foot leaves the ground and how its leg is bent."""
    swing = 0 if walk[WALK_STANCE] > 0 else 1
    foot = walk[_FEET + 9 * swing : _FEET + 9 * swing + 9]
    walk[PHASE], walk[CLOCK], walk[SWING_TIME] = SINGLE, 0.0, gains[_SWING]
    for k in range(3):
        walk[_LIFT + k] = walk[_SOLES + 3 * swing + k]
        walk[_LIFT_NORMAL + k] = foot[3 * k + 2]
    walk[LIFT_YAW] = math.atan2(foot[3], foot[0])
    hip = _R_HIP if walk[WALK_STANCE] > 0 else _L_HIP
    for k in range(6):
        walk[_ANGLES + k] = qpos[7 + hip + k]


@njit(cache=True)
def _follow(walk, command):
    """Let the reference heading and speeds follow the command; gives what is left of the heading [rad]."""
    error = _wrap(command[0] - walk[WALK_HEADING])
    rate = _clamp(error / 0.3, -_TURN_RATE, _TURN_RATE)
    change = _TURN_CHANGE * CONTROL_DT
    walk[WALK_TURN_RATE] += _clamp(rate - walk[WALK_TURN_RATE], -change, change)
    walk[WALK_HEADING] = _wrap(walk[WALK_HEADING] + walk[WALK_TURN_RATE] * CONTROL_DT)
    walk[WALK_SPEED] += _clamp(command[1] - walk[WALK_SPEED], -_SLOWER * CONTROL_DT, _FASTER * CONTROL_DT)
    change = _SIDE_CHANGE * CONTROL_DT
    walk[SIDEWAYS] += _clamp(command[2] - walk[SIDEWAYS], -change, change)
    return error


@njit(cache=True)
def _trim(walk, x, y, ch, sh):
    """At a touchdown with the centre of mass at (x, y): correct the speed asked for by that of the last
    step."""
    if walk[WALK_STEPS] > 1.0:
        time = (walk[WALK_TICKS] - walk[STEPPED_AT]) * CONTROL_DT
        made = (ch * (x - walk[_STEPPED]) + sh * (y - walk[_STEPPED + 1])) / time
        trim = walk[WALK_TRIM] + _TRIM_RATE * (walk[WALK_SPEED] - made)
        walk[WALK_TRIM] = _clamp(trim, -_MOST_TRIM, _MOST_TRIM)
    walk[STEPPED_AT], walk[_STEPPED], walk[_STEPPED + 1] = walk[WALK_TICKS], x, y


@njit(cache=True)
def _step(gains, walk, command, error, soles, contact, com, capture, omega, qpos):
    """Which feet bear the person now: phases and their ends."""
    stance = 1 if walk[WALK_STANCE] > 0 else 0
    swing = 1 - stance
    ch, sh = math.cos(walk[WALK_HEADING]), math.sin(walk[WALK_HEADING])
    still = abs(command[1]) < _STILL and abs(command[2]) < _STILL
    if walk[PHASE] == STANDING:
        if still and abs(error) < _AWRY:
            walk[CLOCK] = walk[SETTING_OFF] = 0.0
            return
        # push the capture point over to the first stance foot
        walk[SETTING_OFF] = 1.0
        outside = -sh * (capture[0] - soles[stance, 0]) + ch * (capture[1] - soles[stance, 1])
        inside = sway(gains, omega, 0.0)[1]
        if -walk[WALK_STANCE] * outside < 2.0 * inside or walk[CLOCK] > _SET_OFF_LIMIT:
            begin_swing(gains, walk, qpos)
    elif walk[PHASE] == SINGLE:
        # a foot that only brushes the ground on its way has not landed
        dx, dy = soles[swing, 0] - walk[_SPOT], soles[swing, 1] - walk[_SPOT + 1]
        there = walk[CLOCK] > _LANDING * walk[SWING_TIME] or dx * dx + dy * dy < _NEAR * _NEAR
        if walk[CLOCK] > 0.5 * walk[SWING_TIME] and contact[swing] > _TOUCH and there:
            missed = ch * (soles[swing, 0] - walk[_SPOT]) + sh * (soles[swing, 1] - walk[_SPOT + 1])
            walk[MISSED] = _clamp(walk[MISSED] + 0.3 * missed, -0.1, 0.1)
            walk[PHASE], walk[CLOCK] = DOUBLE, 0.0
            walk[WALK_STANCE] = -walk[WALK_STANCE]
            walk[WALK_STEPS] += 1.0
            _trim(walk, com[0], com[1], ch, sh)
    elif walk[CLOCK] >= gains[_TRANSFER]:
        if still and abs(walk[WALK_SPEED]) < _SETTLED and abs(error) < _STRAIGHT:
            walk[PHASE], walk[WALK_TRIM] = STANDING, 0.0
            walk[CLOCK] = walk[SETTING_OFF] = 0.0
        else:
            begin_swing(gains, walk, qpos)


@njit(cache=True)
def _pressures(gains, walk, soles, feet, capture, omega, cop, share):
    """Centre of pressure ``cop`` (2, 3) under each foot and its ``share`` (2,) of the load."""
    stance = 1 if walk[WALK_STANCE] > 0 else 0
    ch, sh = math.cos(walk[WALK_HEADING]), math.sin(walk[WALK_HEADING])
    rest = gains[_P_REST]
    along, across = np.full(2, rest), np.zeros(2)
    share[:] = 0.0
    if walk[PHASE] == SINGLE:
        share[stance] = 1.0
        # where the capture point would be in a steady walk
        growth = math.exp(omega * (walk[CLOCK] + 0.5 * gains[_TRANSFER]))
        ahead, inside = sway(gains, omega, walk[WALK_SPEED] + walk[WALK_TRIM])
        ahead, inside = ahead * growth + rest, inside * growth * walk[WALK_STANCE]
        ex = gains[_P_GAIN] * (capture[0] - soles[stance, 0] - ch * ahead - sh * inside)
        ey = gains[_P_GAIN] * (capture[1] - soles[stance, 1] - sh * ahead + ch * inside)
        foot = feet[stance]
        n = math.sqrt(foot[0] * foot[0] + foot[3] * foot[3])
        fx, fy = foot[0] / n, foot[3] / n
        along[stance] += _clamp(fx * ex + fy * ey, -gains[_P_ALONG], gains[_P_ALONG])
        across[stance] = _clamp(-fy * ex + fx * ey, -gains[_P_ACROSS], gains[_P_ACROSS])
    elif walk[PHASE] == DOUBLE:
        share[stance] = min(walk[CLOCK] / gains[_TRANSFER], 1.0)
        share[1 - stance] = 1.0 - share[stance]
    elif walk[SETTING_OFF] > 0.0:
        share[stance], share[1 - stance] = _UNLOADED, 1.0 - _UNLOADED
    else:
        # hold the capture point over the middle of the feet
        mx, my = 0.5 * (soles[0, 0] + soles[1, 0]) + rest * ch, 0.5 * (soles[0, 1] + soles[1, 1]) + rest * sh
        px, py = 2.0 * (capture[0] - mx), 2.0 * (capture[1] - my)
        apart = -sh * (soles[1, 0] - soles[0, 0]) + ch * (soles[1, 1] - soles[0, 1])
        share[1] = _clamp(0.5 + (-sh * px + ch * py) / max(apart, 0.08), 0.05, 0.95)
        share[0] = 1.0 - share[1]
        along += _clamp(ch * px + sh * py, -0.08, 0.09)
    for k in range(2):
        foot = feet[k]
        for i in range(3):
            cop[k, i] = soles[k, i] + along[k] * foot[3 * i] + across[k] * foot[3 * i + 1]


@njit(cache=True)
def _upright(gains, walk, slope, pelvis, qvel, out):
    """Moment ``out`` (3,) [Nm] about the world's axes that turns the pelvis upright and towards the
    heading."""
    ch, sh = math.cos(walk[WALK_HEADING]), math.sin(walk[WALK_HEADING])
    gx = pelvis[0] * qvel[3] + pelvis[1] * qvel[4] + pelvis[2] * qvel[5]
    gy = pelvis[3] * qvel[3] + pelvis[4] * qvel[4] + pelvis[5] * qvel[5]
    gz = pelvis[6] * qvel[3] + pelvis[7] * qvel[4] + pelvis[8] * qvel[5]
    lean = gains[_LEAN] + gains[_LEAN_SLOPE] * slope
    ex, ey = pelvis[2] - lean * ch, pelvis[5] - lean * sh
    most = gains[_TILT_MOST]
    out[0] = _clamp(gains[_TILT] * ey - gains[_TILT_DAMP] * gx, -most, most)
    out[1] = _clamp(-gains[_TILT] * ex - gains[_TILT_DAMP] * gy, -most, most)
    yaw = _wrap(walk[WALK_HEADING] - math.atan2(pelvis[3], pelvis[0]))
    turn = gains[_YAW] * yaw - gains[_YAW_DAMP] * (gz - walk[WALK_TURN_RATE])
    out[2] = _clamp(turn, -_YAW_MOMENT, _YAW_MOMENT)


@njit(cache=True)
def _support(hip, damping, force, cop, yaw_moment, anchors, axes, qpos, qvel, ctrl):
    """A leg that makes the ground push with ``force`` (3,) at ``cop`` (3,): transposed Jacobian, as PD
    targets."""
    for j in range(6):
        axis, anchor = axes[j], anchors[j]
        rx, ry, rz = cop[0] - anchor[0], cop[1] - anchor[1], cop[2] - anchor[2]
        moment = axis[0] * (ry * force[2] - rz * force[1])
        moment += axis[1] * (rz * force[0] - rx * force[2])
        moment += axis[2] * (rx * force[1] - ry * force[0] + yaw_moment)
        rate = damping * _LEAD_TIME * qvel[6 + hip + j]
        ctrl[hip + j] = qpos[7 + hip + j] - moment / _STIFFNESS[j] + rate


@njit(cache=True)
def _swing(gains, walk, pelvis, hip_at, hip, side, ctrl):
    """A leg whose foot moves to its foothold: PD targets by inverse kinematics."""
    share = walk[CLOCK] / walk[SWING_TIME]
    u = min(share / 0.92, 1.0)
    move = u * u * u * (10.0 + u * (-15.0 + 6.0 * u))
    spot, normal = np.empty(3), np.empty(3)
    for i in range(3):
        spot[i] = walk[_LIFT + i] + move * (walk[_SPOT + i] - walk[_LIFT + i])
        turned = _clamp(2.0 * share - 0.7, 0.0, 1.0)
        normal[i] = walk[_LIFT_NORMAL + i] + turned * (walk[_NORMAL + i] - walk[_LIFT_NORMAL + i])
    normal /= math.sqrt(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2)
    # early up to a higher foothold, late down to a lower one
    rise = walk[_SPOT + 2] - walk[_LIFT + 2]
    if rise > 0.0:
        done = math.sin(0.5 * math.pi * min(2.0 * share, 1.0))
    else:
        done = 1.0 - math.cos(0.5 * math.pi * _clamp(2.0 * share - 1.0, 0.0, 1.0))
    spot[2] = (
        walk[_LIFT + 2] + rise * done + (gains[_CLEARANCE] + walk[HUMP]) * math.sin(math.pi * min(share, 1.0))
    )
    if share > 1.0:  # the ground is lower than thought: reach for it
        spot[2] -= 0.35 * (walk[CLOCK] - walk[SWING_TIME])
    foot = np.empty((3, 3))
    foot_frame(walk[LIFT_YAW] + move * _wrap(walk[FOOTHOLD_YAW] - walk[LIFT_YAW]), normal, foot)
    ankle, angles = np.empty(3), np.empty(6)
    for i in range(3):
        ankle[i] = spot[i] - SOLE * foot[i, 0] + ANKLE * foot[i, 2]
    solve_leg(pelvis.copy().reshape(3, 3), hip_at, foot, ankle, side, angles)
    for j in range(6):
        rate = _clamp((angles[j] - walk[_ANGLES + j]) / CONTROL_DT, -12.0, 12.0)
        walk[_ANGLES + j] = angles[j]
        ctrl[hip + j] = angles[j] + gains[_LEAD] * rate


@njit(cache=True)
def walk_tick(gains, ground, walk, state, command, qpos, qvel, ctrl):
    """One control tick: advance ``walk`` (WALK_SIZE,), write the PD targets ``ctrl`` (39,) [rad].

    gains (len(GAINS),); ground as in `footholds.ground_at`; state: a running controller's, with what was
    observed; its heading, speed, stance and steps are kept up to date. All float64.
    """
    error = _follow(walk, command)
    walk[WALK_TICKS] += 1.0
    walk[CLOCK] += CONTROL_DT
    soles = walk[_SOLES : _SOLES + 6].reshape(2, 3)
    feet = walk[_FEET : _FEET + 18].reshape(2, 9)
    pelvis = walk[_PELVIS : _PELVIS + 9]
    anchors = walk[_ANCHORS : _ANCHORS + 36].reshape(2, 6, 3)
    axes = walk[_AXES : _AXES + 36].reshape(2, 6, 3)
    torques = walk[_TORQUES : _TORQUES + 12].reshape(2, 6)
    stance = 1 if walk[WALK_STANCE] > 0 else 0
    omega = math.sqrt(_GRAVITY / max(state[_COM + 2] - soles[stance, 2], 0.5))
    capture = np.array([state[_COM] + state[_VEL] / omega, state[_COM + 1] + state[_VEL + 1] / omega])
    contact = state[_CONTACT : _CONTACT + 2]
    _step(gains, walk, command, error, soles, contact, state[_COM : _COM + 2], capture, omega, qpos)
    stance = 1 if walk[WALK_STANCE] > 0 else 0
    swinging = walk[PHASE] == SINGLE
    planning = walk[CLOCK] < 0.8 * walk[SWING_TIME] and (walk[WALK_TICKS] % 3.0 == 0.0 or walk[CLOCK] == 0.0)
    if swinging and planning:
        plan_foothold(gains, ground, walk, capture[0], capture[1], omega, soles[stance])
    cop, share = np.empty((2, 3)), np.empty(2)
    _pressures(gains, walk, soles, feet, capture, omega, cop, share)

    # force of the ground: height, then the line from the centre of pressure past the centre of mass
    slope = _clamp(command[3], -_MAX_SLOPE, _MAX_SLOPE)
    if swinging:
        low = min(soles[stance, 2], walk[_SPOT + 2])
        done = 0.5 * min(walk[CLOCK] / walk[SWING_TIME], 1.0)
        base = soles[stance, 2] + done * (walk[_SPOT + 2] - soles[stance, 2])
    else:
        low = min(soles[0, 2], soles[1, 2])
        base = 0.5 * (soles[0, 2] + soles[1, 2])
    height = min(base, low + gains[_DROP]) + gains[_HEIGHT] - gains[_Z_SLOPE] * abs(slope)
    lift = gains[_Z_STIFF] * (height - state[_COM + 2]) - gains[_Z_DAMP] * state[_VEL + 2]
    force, moment = np.empty(3), np.empty(3)
    force[2] = MASS * (_GRAVITY + _clamp(lift, -6.0, 8.0))
    _upright(gains, walk, slope, pelvis, qvel, moment)
    hips = (_R_HIP, _L_HIP)
    if swinging:
        # the swing hip's torques push the pelvis the other way
        for i in range(3):
            push = 0.0
            for j in range(3):
                push += axes[1 - stance, j, i] * torques[1 - stance, j]
            moment[i] += gains[_REACTION] * push
    for i in range(2):
        moment[i] = _clamp(moment[i], -gains[_MOMENT], gains[_MOMENT])
    px, py, pz = share[0] * cop[0] + share[1] * cop[1]
    arm = max(state[_COM + 2] - pz, 0.4)
    force[0] = -(moment[1] + (px - state[_COM]) * force[2]) / arm
    force[1] = (moment[0] - (py - state[_COM + 1]) * force[2]) / arm
    sideways = math.sqrt(force[0] * force[0] + force[1] * force[1])
    if sideways > _FRICTION * force[2]:
        force[:2] *= _FRICTION * force[2] / sideways

    ctrl[:_R_HIP] = 0.0
    # the trunk above a leaning pelvis is held upright, the head too
    pitch = math.atan2(
        math.cos(walk[WALK_HEADING]) * pelvis[2] + math.sin(walk[WALK_HEADING]) * pelvis[5], pelvis[8]
    )
    ctrl[_WAIST] = ctrl[_CHEST] = -_STRAIGHTEN * pitch
    ctrl[_NECK] = -pitch - qpos[7 + _WAIST] - qpos[7 + _CHEST]
    for k in range(2):
        ctrl[_SHOULDER[k]] = gains[_ARMS] * (qpos[7 + hips[1 - k]] - 0.25)
        ctrl[_ABDUCTION[k]], ctrl[_ELBOW[k]] = 0.12, 0.35
        hip = hips[k]
        ctrl[hip + 6] = 0.0
        if swinging and k != stance:
            _swing(gains, walk, pelvis, anchors[k, 0].copy(), hip, 2.0 * k - 1.0, ctrl)
        else:
            _support(
                hip, gains[_LEG_DAMPING], share[k] * force, cop[k], share[k] * moment[2], anchors[k],
                axes[k], qpos, qvel, ctrl,
            )  # fmt: skip
    for j in range(ctrl.shape[0]):
        state[_TARGETS + j] = ctrl[j]
    state[run_layout.HEADING], state[run_layout.SPEED] = walk[WALK_HEADING], walk[WALK_SPEED]
    state[run_layout.STANCE], state[run_layout.STEPS] = walk[WALK_STANCE], walk[WALK_STEPS]
    state[run_layout.TURN_RATE], state[run_layout.SLOPE] = walk[WALK_TURN_RATE], slope
