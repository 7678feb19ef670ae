"""The walking controller: capture-point steps, stance legs that make forces, a swing leg that is aimed
(numba).

Per control tick of 10 ms the order is *control, physics, observe*, as in `locomotion.gaits.run.controller`.
Of that controller's ``state`` the walk reads what was observed (`locomotion.body.observed`), and writes
nothing::

    tables, walk = load_walk_skill().tables, new_walk(heading)
    each tick:
        walk_tick(tables, ground, walk, state[OBSERVED], command, data.qpos, data.qvel, data.ctrl)
        mujoco.mj_step(model, data, STEPS_PER_TICK)
        observe(index, model, data, state)
        observe_walk(index, data, walk)

A simulation is saved by copying ``mjSTATE_INTEGRATION``, ``state`` and ``walk``.

``command`` (4,) float64 = heading [rad], speed [m/s], sideways speed to the left [m/s], slope of the way
[rise over run]; all may jump. A person told 0 m/s makes its steps small and then stands.

What the body does (S. Coros et al., "Generalized biped walking control", 2010, for the forces;
`locomotion.gaits.walk.footholds` for the steps): the stance leg pushes with the force that keeps height and
trunk and that passes near the centre of mass from a centre of pressure chosen under the foot, by the
transposed Jacobian of its joints; the swing foot is moved to its foothold by inverse kinematics. Servos are
told angles: a torque t is asked for as q + t / stiffness, with the servo's damping cancelled.
"""

import math

import mujoco
import numpy as np

from locomotion.body import observed as seen
from locomotion.body.anatomy import ANKLE, MASS
from locomotion.body.leg_dynamics import STRAIGHT_LEG, leg_momentum
from locomotion.body.person import CONTROL_DT, JOINT_NAMES, PersonIndex
from locomotion.gaits.walk.footholds import SOLE, bearing, lowest_gap, plan_foothold, sway
from locomotion.gaits.walk.layout import (
    ATTITUDES,
    BODY_HEIGHT,
    CLOCK,
    DOUBLE,
    FAST,
    FOOTHOLD,
    FOOTHOLD_NORMAL,
    GAINS,
    LEVEL,
    LIFT,
    LONGER,
    PHASE,
    REST,
    SEEN_ANCHORS,
    SEEN_AXES,
    SEEN_FEET,
    SEEN_PELVIS,
    SEEN_SOLES,
    SEEN_TORQUES,
    SETTING_OFF,
    SINGLE,
    STAIRS,
    STAIRS_AHEAD,
    STEEP,
    STEEPNESS,
    SWING_TIME,
    TILTED,
    UNEVEN,
    WALK_HEADING,
    WALK_SPEED,
    WALK_STANCE,
    WALK_TICKS,
    WALK_TRIM,
    WALK_TURN_RATE,
    clamp,
    fast_share,
    pace_of,
    steep_share,
    step_share,
    wrap,
)
from locomotion.gaits.walk.legs import height_in_reach, steady_foot, support_leg, swing_leg
from locomotion.gaits.walk.steps import advance_step, follow
from locomotion.paths.command import HEADING_ASKED, SIDEWAYS_ASKED, SLOPE_THERE, SPEED_ASKED
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["legs_momentum", "observe_walk", "walk_tick"]

_I = {name: i for i, name in enumerate(GAINS)}
_SWING, _TRANSFER, _HEIGHT = _I["swing_time"], _I["transfer_time"], _I["height"]
_P_GAIN, _P_ALONG, _P_ACROSS, _P_REST = (
    _I["pressure_gain"], _I["pressure_along"], _I["pressure_across"], _I["pressure_rest"],
)  # fmt: skip
_Z_STIFF, _Z_DAMP, _DROP, _Z_SLOPE, _Z_UPHILL = (
    _I["height_stiffness"],
    _I["height_damping"],
    _I["drop"],
    _I["height_slope"],
    _I["height_uphill"],
)
_TILT, _TILT_DAMP, _TILT_MOST = _I["tilt_stiffness"], _I["tilt_damping"], _I["tilt_moment"]
_TILT_INTEGRAL = _I["tilt_integral"]
_YAW, _YAW_DAMP, _REACTION, _MOMENT = _I["yaw_stiffness"], _I["yaw_damping"], _I["reaction"], _I["moment"]
_LEAN, _LEAN_SLOPE, _LEG_DAMPING = _I["lean"], _I["lean_slope"], _I["leg_damping"]
_HOLD, _MOMENTUM = _I["foot_hold"], _I["momentum"]
_CLIMB = _I["climb_rate"]
_ARMS = _I["arm_swing"]
_SPOT, _NORMAL, _LIFT = FOOTHOLD.start, FOOTHOLD_NORMAL.start, LIFT.start
_SOLES, _FEET, _PELVIS = SEEN_SOLES.start, SEEN_FEET.start, SEEN_PELVIS.start
_ATTITUDES, _LONGER = ATTITUDES.start, LONGER.start
_ANCHORS, _AXES, _TORQUES = SEEN_ANCHORS.start, SEEN_AXES.start, SEEN_TORQUES.start
_R_HIP, _L_HIP = (JOINT_NAMES.index(f"{s}_hip_flexion") for s in ("right", "left"))
_SHOULDER, _ABDUCTION, _ELBOW = (
    np.array([JOINT_NAMES.index(f"{s}_{name}") for s in ("right", "left")])
    for name in ("shoulder_flexion", "shoulder_abduction", "elbow_flexion")
)
_WAIST, _CHEST, _NECK = (JOINT_NAMES.index(f"{part}_pitch") for part in ("waist", "chest", "neck"))
_PELVIS_BODY = 1
_LEAST, _TREAD = 0.2, 0.3  # [m/s] above which it goes over stairs a tread a step; [m] of a usual one
_DOWN = 0.03  # [m] above a tread at which a corner of a foot has come down on it
_GRAVITY = 9.81
_HIPS = 0.85  # [m] above the ground
_UNLOADED = 0.15  # share of the weight on the first stance leg while it is pushed over it
_STRAIGHTEN = 0.4  # share of the pelvis's lean that waist and chest take back, each
_FRICTION = 0.75  # sideways per upward force at most
_MAX_SLOPE = 0.8
_MOST_TILTED = 0.2  # [rad s]
_YAW_MOMENT = 25.0  # [Nm]
_SLOW, _RESTING = 0.4, 0.1  # [m/s] of the reference speed below which it begins to rest; with which it rests


@kernel
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


@allocating_kernel
def _bear_steep(ground, steep, soles, feet, points, spans):
    """Where the feet bear: ``points`` (2, 3), and ``spans`` (2, 2), how much of their length and width does.
    On level ground a foot that comes up at the heel is flat again at the next step: it counts as flat."""
    bears = np.empty(4)
    for k in range(2):
        bearing(ground, soles[k], feet[k], bears)
        ahead, left = steep * bears[0], steep * bears[1]
        for i in range(3):
            points[k, i] = soles[k, i] + ahead * feet[k, 3 * i] + left * feet[k, 3 * i + 1]
            if i < 2:
                spans[k, i] = 1.0 - steep * (1.0 - bears[2 + i])


@allocating_kernel
def _pressures(gains, walk, feet, points, spans, capture, omega, cop, share):
    """Centre of pressure ``cop`` (2, 3) under each foot and its ``share`` (2,) of the load.

    points (2, 3), spans (2, 2): where each foot bears, and how much of its length and width does.
    """
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
        ex = gains[_P_GAIN] * (capture[0] - points[stance, 0] - ch * ahead - sh * inside)
        ey = gains[_P_GAIN] * (capture[1] - points[stance, 1] - sh * ahead + ch * inside)
        foot = feet[stance]
        n = math.sqrt(foot[0] * foot[0] + foot[3] * foot[3])
        fx, fy = foot[0] / n, foot[3] / n
        most = gains[_P_ALONG] * spans[stance, 0]
        along[stance] += clamp(fx * ex + fy * ey, -most, most)
        most = gains[_P_ACROSS] * spans[stance, 1]
        across[stance] = clamp(-fy * ex + fx * ey, -most, most)
    elif walk[PHASE] == DOUBLE:
        share[stance] = min(walk[CLOCK] / gains[_TRANSFER], 1.0)
        share[1 - stance] = 1.0 - share[stance]
    elif walk[SETTING_OFF] > 0.0:
        share[stance], share[1 - stance] = _UNLOADED, 1.0 - _UNLOADED
    else:
        # hold the capture point over the middle of the feet
        mx, my = (
            0.5 * (points[0, 0] + points[1, 0]) + rest * ch,
            0.5 * (points[0, 1] + points[1, 1]) + rest * sh,
        )
        px, py = 2.0 * (capture[0] - mx), 2.0 * (capture[1] - my)
        apart = -sh * (points[1, 0] - points[0, 0]) + ch * (points[1, 1] - points[0, 1])
        share[1] = clamp(0.5 + (-sh * px + ch * py) / max(apart, 0.08), 0.05, 0.95)
        share[0] = 1.0 - share[1]
        for k in range(2):
            along[k] += clamp(ch * px + sh * py, -0.08 * spans[k, 0], 0.09 * spans[k, 0])
    for k in range(2):
        foot = feet[k]
        for i in range(3):
            cop[k, i] = points[k, i] + along[k] * foot[3 * i] + across[k] * foot[3 * i + 1]


@kernel
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
    out[0] = clamp(gains[_TILT] * ey - gains[_TILT_DAMP] * gx, -most, most)
    out[1] = clamp(-gains[_TILT] * ex - gains[_TILT_DAMP] * gy, -most, most)
    tilted = walk[TILTED] + (ch * ex + sh * ey) * CONTROL_DT
    walk[TILTED] = clamp(tilted, -_MOST_TILTED, _MOST_TILTED)
    out[0] += gains[_TILT_INTEGRAL] * walk[TILTED] * sh
    out[1] -= gains[_TILT_INTEGRAL] * walk[TILTED] * ch
    yaw = wrap(walk[WALK_HEADING] - math.atan2(pelvis[3], pelvis[0]))
    turn = gains[_YAW] * yaw - gains[_YAW_DAMP] * (gz - walk[WALK_TURN_RATE])
    out[2] = clamp(turn, -_YAW_MOMENT, _YAW_MOMENT)


@kernel
def legs_momentum(pelvis, speed, qpos, qvel):
    """Angular momentum [kg m^2/s] of the legs, forward, beyond what they have at a touchdown, when both turn
    back below a body of this ``speed`` [m/s]."""
    pitch = math.atan2(-pelvis[6], pelvis[8])
    momentum = 2.0 * STRAIGHT_LEG * speed / _HIPS
    for hip in (_R_HIP, _L_HIP):
        thigh, rate = qpos[7 + hip] - pitch, qvel[6 + hip] - qvel[4]
        momentum += leg_momentum(thigh, thigh - qpos[10 + hip], rate, rate - qvel[9 + hip])
    return momentum


@kernel
def _lift(gains, walk, steep, slope, soles, observed, hip):
    """Acceleration [m/s^2] upward that takes the body to its height: above the line between the feet, and on
    steep ground no higher than the swing leg reaches from its ``hip`` (3,), no faster than it may climb."""
    stance = 1 if walk[WALK_STANCE] > 0 else 0
    other = soles[1 - stance, 2]
    low = min(soles[0, 2], soles[1, 2])
    if walk[PHASE] == SINGLE:
        done = min(walk[CLOCK] / walk[SWING_TIME], 1.0)
        other = walk[_LIFT + 2] + done * (walk[_SPOT + 2] - walk[_LIFT + 2])
        low = min(soles[stance, 2], walk[_SPOT + 2])
    height = min(0.5 * (soles[stance, 2] + other), low + gains[_DROP]) + gains[_HEIGHT]
    height -= max(gains[_Z_UPHILL] * slope, -gains[_Z_SLOPE] * slope)
    if walk[PHASE] == SINGLE:
        reach = height_in_reach(walk, observed[seen.COM], observed[seen.VELOCITY_X : seen.VELOCITY_Z], hip)
        late = walk[CLOCK] > walk[SWING_TIME]
        height += (1.0 if late else steep) * min(reach - height, 0.0)
    if walk[BODY_HEIGHT] != walk[BODY_HEIGHT]:
        walk[BODY_HEIGHT] = observed[seen.COM_Z]
    climb = clamp((height - walk[BODY_HEIGHT]) / CONTROL_DT, -gains[_CLIMB], gains[_CLIMB])
    walk[BODY_HEIGHT] += climb * CONTROL_DT
    height += steep * (walk[BODY_HEIGHT] - height)
    return gains[_Z_STIFF] * (height - observed[seen.COM_Z]) + gains[_Z_DAMP] * (
        steep * climb - observed[seen.VELOCITY_Z]
    )


@allocating_kernel
def walk_tick(tables, ground, walk, observed, command, qpos, qvel, ctrl):
    """One control tick: advance ``walk`` (WALK_SIZE,), write the PD targets ``ctrl`` (39,) [rad].

    tables (5, len(GAINS)): rows of gains as named in `walk_layout`; ground as in `footholds.ground_at`;
    observed: as in `locomotion.body.observed`. All float64.
    """
    steep = steep_share(walk[STEEPNESS])
    stairs = steep_share(max(abs(command[SLOPE_THERE]), walk[STAIRS_AHEAD]) - walk[STEEPNESS])
    stairs = (1.0 - steep) * max(stairs, step_share(walk[STAIRS_AHEAD]))
    asked = command[SPEED_ASKED]
    if stairs > 0.0 and asked > _LEAST:  # a step is a tread: who goes more slowly stops on each
        asked = max(asked, stairs * _TREAD / (tables[STAIRS, _SWING] + tables[STAIRS, _TRANSFER]))
    error = follow(walk, command[HEADING_ASKED], asked, command[SIDEWAYS_ASKED])
    rests = clamp((_SLOW - abs(walk[WALK_SPEED])) / (_SLOW - _RESTING), 0.0, 1.0)
    gains = tables[LEVEL] + steep * (tables[STEEP] - tables[LEVEL] + rests * (tables[REST] - tables[STEEP]))
    gains += stairs * (tables[STAIRS] - tables[LEVEL])
    gains += fast_share(pace_of(walk)) * (1.0 - max(steep, stairs)) * (tables[FAST] - tables[LEVEL])
    gains[_TRANSFER] = max(gains[_TRANSFER] + walk[_LONGER], CONTROL_DT)
    gains[_SWING] += walk[_LONGER + 1]
    walk[WALK_TICKS] += 1.0
    walk[CLOCK] += CONTROL_DT
    soles = walk[_SOLES : _SOLES + 6].reshape(2, 3)
    feet = walk[_FEET : _FEET + 18].reshape(2, 9)
    pelvis = walk[_PELVIS : _PELVIS + 9]
    anchors = walk[_ANCHORS : _ANCHORS + 36].reshape(2, 6, 3)
    axes = walk[_AXES : _AXES + 36].reshape(2, 6, 3)
    torques = walk[_TORQUES : _TORQUES + 12].reshape(2, 6)
    stance = 1 if walk[WALK_STANCE] > 0 else 0
    omega = math.sqrt(_GRAVITY / max(observed[seen.COM_Z] - soles[stance, 2], 0.5))
    capture = np.array(
        [
            observed[seen.COM_X] + observed[seen.VELOCITY_X] / omega,
            observed[seen.COM_Y] + observed[seen.VELOCITY_Y] / omega,
        ]
    )
    if gains[_MOMENTUM] > 0.0:
        ch, sh = math.cos(walk[WALK_HEADING]), math.sin(walk[WALK_HEADING])
        along = ch * observed[seen.VELOCITY_X] + sh * observed[seen.VELOCITY_Y]
        # what swings ahead now brakes the body until it lands: its momentum does not count
        momentum = gains[_MOMENTUM] * legs_momentum(pelvis, along, qpos, qvel)
        too_far = momentum * omega / (MASS * _GRAVITY)
        capture[0] -= ch * too_far
        capture[1] -= sh * too_far
    contact = observed[seen.CONTACT]
    points, spans = soles.copy(), np.ones((2, 2))
    uneven = steep + stairs
    walk[UNEVEN] = uneven
    if uneven > 0.0:
        _bear_steep(ground, uneven, soles, feet, points, spans)
    swing = 1 - stance
    down = stairs == 0.0 or lowest_gap(ground, soles[swing], feet[swing]) < _DOWN
    advance_step(
        gains,
        walk,
        command,
        error,
        soles,
        points,
        spans,
        contact,
        down,
        observed[seen.COM_X : seen.COM_Z],
        capture,
        omega,
        qpos,
    )
    stance = 1 if walk[WALK_STANCE] > 0 else 0
    swinging = walk[PHASE] == SINGLE
    planning = walk[CLOCK] < 0.8 * walk[SWING_TIME] and (walk[WALK_TICKS] % 3.0 == 0.0 or walk[CLOCK] == 0.0)
    if swinging and planning:
        hip_at = anchors[1 - stance, 0].copy()
        hip_at[:2] += max(walk[SWING_TIME] - walk[CLOCK], 0.0) * observed[seen.VELOCITY_X : seen.VELOCITY_Z]
        plan_foothold(gains, ground, walk, capture[0], capture[1], omega, points[stance], hip_at, stairs)
        for i in range(3):
            walk[_ATTITUDES + 3 * (1 - stance) + i] = walk[_NORMAL + i]
    cop, share = np.empty((2, 3)), np.empty(2)
    _pressures(gains, walk, feet, points, spans, capture, omega, cop, share)

    # force of the ground: height, then the line from the centre of pressure past the centre of mass
    slope = clamp(command[SLOPE_THERE], -_MAX_SLOPE, _MAX_SLOPE)
    lift = _lift(gains, walk, uneven, slope, soles, observed, anchors[1 - stance, 0])
    force, moment = np.empty(3), np.empty(3)
    force[2] = MASS * (_GRAVITY + clamp(lift, -6.0, 8.0))
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
        moment[i] = clamp(moment[i], -gains[_MOMENT], gains[_MOMENT])
    px, py, pz = share[0] * cop[0] + share[1] * cop[1]
    arm = max(observed[seen.COM_Z] - pz, 0.4)
    force[0] = -(moment[1] + (px - observed[seen.COM_X]) * force[2]) / arm
    force[1] = (moment[0] - (py - observed[seen.COM_Y]) * force[2]) / arm
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
    hold = np.empty(3)
    for k in range(2):
        ctrl[_SHOULDER[k]] = gains[_ARMS] * (qpos[7 + hips[1 - k]] - 0.25)
        ctrl[_ABDUCTION[k]], ctrl[_ELBOW[k]] = 0.12, 0.35
        hip = hips[k]
        ctrl[hip + 6] = 0.0
        if swinging and k != stance:
            swing_leg(
                gains,
                walk,
                pelvis,
                anchors[k, 0].copy(),
                observed[seen.VELOCITY_X : seen.VELOCITY_Z],
                hip,
                2.0 * k - 1.0,
                ctrl,
            )
        else:
            attitude = walk[_ATTITUDES + 3 * k : _ATTITUDES + 3 * k + 3]
            steady_foot(gains[_HOLD], spans[k], feet[k], attitude, hold)
            support_leg(
                hip, gains[_LEG_DAMPING], share[k] * force, cop[k], share[k] * moment[2], anchors[k],
                axes[k], hold, spans[k], qpos, qvel, ctrl,
            )  # fmt: skip
