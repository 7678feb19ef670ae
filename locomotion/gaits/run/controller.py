"""The running controller: reference motion, reduced-order affine feedback, stance switching (numba kernels).

Per control tick of 10 ms the order is *control, physics, observe*::

    skill = load_run_skill()                         # locomotion.gaits.run.skill
    state = new_state()                              # (STATE_SIZE,) float64: its memory
    reset_running(skill, model, data, index, state, position, yaw, speed)
    each tick:
        run_tick(*skill.tables, state, command, data.qpos, data.qvel, data.ctrl)     # writes data.ctrl
        mujoco.mj_step(model, data, STEPS_PER_TICK)
        observe(index, model, data, state)           # reads contacts, feet, centre of mass into ``state``

``command`` (3,) float64 = desired heading [rad, world, any turn], desired speed [m/s, clipped to the
skill's range] and desired sideways speed [m/s to the left of the heading, clipped to ±0.4]; a fourth
number, if there is one, is the slope of the ground along the heading [rise over run], which is otherwise
felt from the touchdowns, two steps late. All may jump: the controller's own reference heading
and speed follow at the rates that the skill holds. ``data.ctrl`` (39,) are PD targets [rad] in the order of
`locomotion.body.person.JOINT_NAMES`; a skill on top (a jump) may add to them before the physics step.

A simulation is saved by copying ``mjSTATE_INTEGRATION`` and ``state``; restoring both continues it bit for
bit, because `run_tick` reads nothing else: contacts, feet and centre of mass were observed into ``state``.

The control law, in a frame mirrored so that the right leg is the stance leg (all lateral sensors and actions
change sign on the left): with phase p in [0, 1] of a step,

    PD target = reference(p) + rate(p) * damping / stiffness + learned feed-forward(p) + posture servo + da
    da = M_ap · M_sp · (s - s_ref(p)) + a_hat + turn * turn rate + bend * (turn rate * speed)^2
         + climb or descend * slope

where M_ap·M_sp has rank 3.

Sensors s (12,), measured in the frame of the *reference heading*, so that steering is a change of sensors:
see `SENSORS`. Actions a (9,): see `ACTIONS`; the waist's are copied to the chest. The posture servo is
SIMBICON's: the swing hip is aimed in the world, the stance hip holds the pelvis upright; its gains are
learned with the rest.

A step ends when the swing foot touches down after `MIN_PHASE`; the phase waits at 1 in a long flight.
Targets are blended over the switch. Fields of ``state`` are the module's constants `PHASE`, `STANCE`, ...
(index or slice).
"""

import math

import mujoco
import numpy as np

from locomotion.body.contacts import contacts_of
from locomotion.body.person import CONTROL_DT, JOINT_NAMES, PersonIndex
from locomotion.gaits.run.layout import (
    ACTIONS,
    BLEND,
    CLIMB,
    COM,
    COM_AT_SWITCH,
    COM_VELOCITY,
    COM_X,
    COM_Y,
    COM_Z,
    CONTACT,
    FALLEN,
    FEET,
    FIRST_SENSOR,
    HEADING,
    LAST_TARGET,
    LEFT_CONTACT,
    LEFT_FOOT,
    LEFT_PLANTED,
    MIN_PHASE,
    N_KNOTS,
    OBSERVED,
    PARAMETERS,
    PHASE,
    PLANTED,
    RANK,
    RIGHT_CONTACT,
    RIGHT_FOOT,
    RIGHT_PLANTED,
    SENSOR_VALUES,
    SENSORS,
    SLOPE,
    SPEED,
    STANCE,
    STATE_SIZE,
    STEP_LENGTH,
    STEP_SPEED,
    STEP_TIME,
    STEPS,
    SWITCH_X,
    SWITCH_Y,
    TICKS,
    TRIM,
    TURN_RATE,
    VELOCITY_X,
    VELOCITY_Y,
    VELOCITY_Z,
    new_state,
    parameter_slices,
)  # fmt: skip
from locomotion.paths.command import HEADING_ASKED, SIDEWAYS_ASKED, SLOPE_THERE, SPEED_ASKED
from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "ACTIONS", "CLIMB", "COM", "COM_AT_SWITCH", "COM_VELOCITY", "CONTACT", "FALLEN", "FEET", "HEADING",
    "LAST_TARGET", "LEAST_UPRIGHT", "LOWEST", "MIN_PHASE", "OBSERVED", "PARAMETERS", "PHASE", "PLANTED",
    "SENSORS", "SENSOR_VALUES", "SLOPE", "SPEED", "STANCE", "STATE_SIZE", "STEPS", "STEP_LENGTH",
    "STEP_SPEED", "STEP_TIME", "TICKS",
    "TRIM", "TURN_RATE", "new_state", "observe", "parameter_slices", "run_tick",
]  # fmt: skip
LOWEST, LEAST_UPRIGHT = 0.45, 0.35
"""[m] of the centre of mass above the lower foot, and share of the chest's axis upward: a body with less than
either has fallen."""
_SP = parameter_slices()
_M_AP, _M_SP, _POSTURE, _A_HAT = (_SP[k].start for k in ("m_ap", "m_sp", "posture", "a_hat"))
_FF, _TURN, _CLIMB, _TIMING = (_SP[k].start for k in ("feed_forward", "turn", "climb", "timing"))
_ARMS, _DESCEND = (_SP[k].start for k in ("arms", "descend"))
_CLIMB_LEGS, _DESCEND_LEGS = _SP["climb_legs"].start, _SP["descend_legs"].start
_BEND = _SP["bend"].start
_CLIMB_TIMING, _DESCEND_TIMING = _SP["climb_timing"].start, _SP["descend_timing"].start
_WAIST, _CHEST, _NECK = (JOINT_NAMES.index(n) for n in ("waist_pitch", "chest_pitch", "neck_pitch"))
_R_ARM = JOINT_NAMES.index("right_clavicle_elevation")
_R_HIP, _L_HIP = (JOINT_NAMES.index(f"{s}_hip_flexion") for s in ("right", "left"))
_N = len(JOINT_NAMES)
_RATE_LEAD = 0.1  # servo damping per stiffness [s], as in locomotion.body.person
_BLEND_TIME = 0.03  # [s] within which a jump of the targets at a switch decays
_ACCELERATION = 1.5  # [m/s^2] of the reference speed
_MAX_SIDE = 0.4  # [m/s]
_MAX_SLOPE = 0.4
_TOUCH = 20.0  # [N] under a foot that counts as contact
_PITCH, _PITCH_RATE, _HEIGHT, _AHEAD_SPEED, _RISE_SPEED, _AHEAD = range(6)
_ROLL, _YAW, _ROLL_RATE, _YAW_RATE, _LEFT_SPEED, _LEFT = range(6, 12)  # places in `SENSORS`
_SWING_HIP, _STANCE_HIP, _TRUNK, _SWING_KNEE, _STANCE_KNEE, _STANCE_ANKLE = 0, 3, 6, 9, 10, 11
# places in `CLIMB`; hips: flexion, abduction, rotation; trunk: pitch, roll, yaw
_CLIP = np.array([0.6, 5.0, 0.2, 1.5, 2.0, 0.5, 0.6, 0.6, 5.0, 5.0, 1.5, 0.4])
_BLEND, _TARGETS = BLEND.start, LAST_TARGET.start


@kernel
def _wrap(angle: float) -> float:
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


@kernel
def _lookup(table, share, out):
    """Row of the periodic ``table`` (n, k) at ``share`` of the cycle, linear between rows, into ``out``
    (k,)."""
    n = table.shape[0]
    at = (share - math.floor(share)) * n
    low = int(at)
    weight = at - low
    low = low % n
    high = (low + 1) % n
    for j in range(table.shape[1]):
        out[j] = (1.0 - weight) * table[low, j] + weight * table[high, j]


@kernel
def _periodic_spline(values, start, n, share):
    """Uniform periodic cubic (Catmull-Rom) through ``values[start:start+n]`` at ``share`` of the cycle."""
    at = (share - math.floor(share)) * n
    low = int(at)
    t = at - low
    a = values[start + (low - 1) % n]
    b = values[start + low % n]
    c = values[start + (low + 1) % n]
    d = values[start + (low + 2) % n]
    return b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))


@allocating_kernel
def _parameters_at(knots, table, speed, out):
    """Parameters at ``speed``: linear between the rows of ``table`` (k, p), held beyond the ends."""
    k = knots.shape[0]
    if k == 1 or speed <= knots[0]:
        out[:] = table[0]
    elif speed >= knots[k - 1]:
        out[:] = table[k - 1]
    else:
        i = 0
        while speed > knots[i + 1]:
            i += 1
        weight = (speed - knots[i]) / (knots[i + 1] - knots[i])
        for j in range(out.shape[0]):
            out[j] = (1.0 - weight) * table[i, j] + weight * table[i + 1, j]


@kernel
def _follow_command(limits, state, command):
    """Let the reference heading and speed follow the command at the skill's rates."""
    low, high = limits[0], limits[1]
    max_turn = limits[2] / max(state[SPEED], 1.0)
    wanted = min(max(command[SPEED_ASKED], low), high)
    step = _ACCELERATION * CONTROL_DT
    state[SPEED] += min(max(wanted - state[SPEED], -step), step)
    error = _wrap(command[HEADING_ASKED] - state[HEADING])
    rate = min(max(error / 0.15, -max_turn), max_turn)
    change = 4.0 * max_turn * CONTROL_DT
    state[TURN_RATE] += min(max(rate - state[TURN_RATE], -change), change)
    state[HEADING] = _wrap(state[HEADING] + state[TURN_RATE] * CONTROL_DT)


@kernel
def _switch_stance(state):
    """End the step: the swing foot becomes the stance foot; measure the step and the slope."""
    new_side = -state[STANCE]
    foot = LEFT_FOOT if new_side > 0 else RIGHT_FOOT
    planted = LEFT_PLANTED if new_side > 0 else RIGHT_PLANTED
    ch, sh = math.cos(state[HEADING]), math.sin(state[HEADING])
    if state[STEPS] >= 2.0:
        along = (state[foot] - state[planted]) * ch + (state[foot + 1] - state[planted + 1]) * sh
        if along > 0.5:
            slope = (state[foot + 2] - state[planted + 2]) / along
            state[SLOPE] += 0.5 * (min(max(slope, -_MAX_SLOPE), _MAX_SLOPE) - state[SLOPE])
    elapsed = max(state[STEP_TIME], CONTROL_DT)
    moved = (state[COM_X] - state[SWITCH_X]) * ch + (state[COM_Y] - state[SWITCH_Y]) * sh
    if state[STEPS] >= 1.0:
        state[STEP_LENGTH] = moved
        state[STEP_SPEED] = moved / elapsed
        trim = state[TRIM] + 0.08 * (state[SPEED] - state[STEP_SPEED])
        state[TRIM] = min(max(trim, -0.6), 0.6)
    for k in range(3):
        state[planted + k] = state[foot + k]
        state[SWITCH_X + k] = state[COM_X + k]
    state[STANCE] = new_side
    state[PHASE] = 0.0
    state[STEP_TIME] = 0.0
    state[STEPS] += 1.0


@kernel
def _sense(state, side, command, qpos, qvel, out):
    """Sensors in the frame of the reference heading, mirrored so that the stance leg is the right one."""
    w, x, y, z = qpos[3], qpos[4], qpos[5], qpos[6]
    ch, sh = math.cos(state[HEADING]), math.sin(state[HEADING])
    # columns of the root's rotation matrix, turned into the heading frame
    r00, r10, r20 = 1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)
    r01, r11, r21 = 2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)
    r02, r12, r22 = 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)
    fx, fy = ch * r00 + sh * r10, -sh * r00 + ch * r10
    ux, uy = ch * r02 + sh * r12, -sh * r02 + ch * r12
    gx = r00 * qvel[3] + r01 * qvel[4] + r02 * qvel[5]
    gy = r10 * qvel[3] + r11 * qvel[4] + r12 * qvel[5]
    gz = r20 * qvel[3] + r21 * qvel[4] + r22 * qvel[5]
    foot = LEFT_FOOT if side > 0 else RIGHT_FOOT
    dx, dy = state[COM_X] - state[foot], state[COM_Y] - state[foot + 1]
    mirror = -side
    out[_PITCH] = math.atan2(ux, r22)
    out[_PITCH_RATE] = -sh * gx + ch * gy
    out[_HEIGHT] = state[COM_Z] - state[foot + 2]
    out[_AHEAD_SPEED] = ch * state[VELOCITY_X] + sh * state[VELOCITY_Y]
    out[_RISE_SPEED] = state[VELOCITY_Z]
    out[_AHEAD] = ch * dx + sh * dy
    # above the ground under the centre of mass, not above the foot
    out[_HEIGHT] -= state[SLOPE] * out[_AHEAD]
    out[_RISE_SPEED] -= state[SLOPE] * out[_AHEAD_SPEED]
    out[_ROLL] = mirror * math.atan2(-uy, r22)
    out[_YAW] = mirror * math.atan2(fy, fx)
    out[_ROLL_RATE] = mirror * (ch * gx + sh * gy)
    out[_YAW_RATE] = mirror * (gz - state[TURN_RATE])
    out[_LEFT_SPEED] = mirror * (
        -sh * state[VELOCITY_X]
        + ch * state[VELOCITY_Y]
        - min(max(command[SIDEWAYS_ASKED], -_MAX_SIDE), _MAX_SIDE)
    )
    out[_LEFT] = mirror * (-sh * dx + ch * dy)


@kernel
def _feedback(p, delta, turn, speed, slope, raw, out):
    """Actions ``out`` (12,) [rad] as `CLIMB` names them, from the deviations ``delta`` (12,) and raw
    sensors, while turning at ``turn`` [rad/s] at ``speed`` [m/s]."""
    by_slope = _CLIMB if slope >= 0.0 else _DESCEND
    sideways = (turn * speed) ** 2
    for i in range(12):
        out[i] = p[by_slope + i] * slope + p[_BEND + i] * sideways
    for i in range(9):
        out[i] += p[_A_HAT + i] + p[_TURN + i] * turn
    for r in range(RANK):
        latent = 0.0
        for j in range(12):
            latent += p[_M_SP + r * 12 + j] * delta[j]
        for i in range(9):
            out[i] += p[_M_AP + i * RANK + r] * latent
    g = _POSTURE
    out[_SWING_HIP] += p[g] * raw[_PITCH]
    out[_SWING_HIP + 1] -= p[g + 1] * raw[_ROLL]
    out[_SWING_HIP + 2] += p[g + 2] * raw[_YAW]
    out[_STANCE_HIP] -= p[g + 3] * raw[_PITCH] + p[g + 4] * raw[_PITCH_RATE]
    out[_STANCE_HIP + 1] -= p[g + 5] * raw[_ROLL] + p[g + 6] * raw[_ROLL_RATE]
    out[_STANCE_HIP + 2] += p[g + 7] * raw[_YAW] + p[g + 8] * raw[_YAW_RATE]


@allocating_kernel
def run_tick(knots, table, reference, rates, mean, state_reference, limits, state, command, qpos, qvel, ctrl):
    """One control tick: advance phase and stance in ``state`` and write the PD targets ``ctrl`` (39,) [rad].

    knots (k,), table (k, p): parameters by speed. reference, rates (n, 39): the clip over a cycle that
    starts with the right foot's touchdown, and its rates [rad/s] at the clip's own duration times that
    duration [rad per cycle].
    mean (39,): mean of the reference. state_reference (b, 12): s_ref over a step. limits (3,): lowest and
    highest speed [m/s], highest lateral acceleration [m/s^2] in turns. All float64.
    """
    _follow_command(limits, state, command)
    if command.shape[0] > 3:
        state[SLOPE] = min(max(command[SLOPE_THERE], -_MAX_SLOPE), _MAX_SLOPE)
    p = np.empty(table.shape[1])
    _parameters_at(knots, table, state[SPEED], p)
    slope = state[SLOPE]
    legs, timing = (_CLIMB_LEGS, _CLIMB_TIMING) if slope >= 0.0 else (_DESCEND_LEGS, _DESCEND_TIMING)
    step_time = max(p[_TIMING] + slope * p[timing], 0.2)
    state[PHASE] += CONTROL_DT / step_time
    state[STEP_TIME] += CONTROL_DT
    state[TICKS] += 1.0
    switched = False
    swing_contact = LEFT_CONTACT if state[STANCE] < 0 else RIGHT_CONTACT
    if state[PHASE] >= MIN_PHASE and state[swing_contact] > _TOUCH:
        _switch_stance(state)
        switched = True
    if state[PHASE] > 1.0:
        state[PHASE] = 1.0
    side = state[STANCE]
    phase = state[PHASE]

    raw = np.empty(12)
    _sense(state, side, command, qpos, qvel, raw)
    delta = np.empty(12)
    bins = state_reference.shape[0] - 1
    at = phase * bins
    low = min(int(at), bins - 1)
    weight = at - low
    speed = state[SPEED] + state[TRIM]
    for j in range(12):
        expected = (1.0 - weight) * state_reference[low, j] + weight * state_reference[low + 1, j]
        if j == _AHEAD_SPEED:
            expected += speed
        elif j == _AHEAD:
            expected *= speed
        delta[j] = min(max(raw[j] - expected, -_CLIP[j]), _CLIP[j])
        state[FIRST_SENSOR + j] = delta[j]
    for j in (_ROLL, _YAW, _ROLL_RATE):
        raw[j] = min(max(raw[j], -_CLIP[j]), _CLIP[j])
    action = np.empty(12)
    # turning left (positive) is towards the stance side on the left
    _feedback(p, delta, state[TURN_RATE] * side, state[SPEED], slope, raw, action)

    share = 0.5 * phase + (0.5 if side > 0 else 0.0)
    pose, rate = np.empty(_N), np.empty(_N)
    _lookup(reference, share, pose)
    _lookup(rates, share, rate)
    cycle_rate = 0.5 / step_time * _RATE_LEAD
    if phase >= 1.0:
        cycle_rate = 0.0
    target = np.empty(_N)
    amplitude, arms = p[_TIMING + 1] + slope * p[timing + 1], p[_ARMS]
    feed_forward = p[_FF : _FF + 3 * N_KNOTS] + slope * p[legs : legs + 3 * N_KNOTS]
    for j in range(_N):
        scale = 1.0
        if j >= _R_HIP:
            scale = amplitude
        elif j >= _R_ARM:
            scale = arms
        target[j] = mean[j] + scale * (pose[j] - mean[j] + rate[j] * cycle_rate)
    for leg in range(2):
        hip = _R_HIP if leg == 0 else _L_HIP
        leg_share = share if leg == 0 else share + 0.5
        target[hip] += _periodic_spline(feed_forward, 0, N_KNOTS, leg_share)
        target[hip + 3] += _periodic_spline(feed_forward, N_KNOTS, N_KNOTS, leg_share)
        target[hip + 4] += _periodic_spline(feed_forward, 2 * N_KNOTS, N_KNOTS, leg_share)
    stance = _L_HIP if side > 0 else _R_HIP
    swing = _R_HIP if side > 0 else _L_HIP
    mirror = -side
    for k in range(3):
        target[swing + k] += action[_SWING_HIP + k]
        target[stance + k] += action[_STANCE_HIP + k]
        sign = 1.0 if k == 0 else mirror
        target[_WAIST + k] += sign * action[_TRUNK + k]
        target[_CHEST + k] += sign * action[_TRUNK + k]
    target[swing + 3] += action[_SWING_KNEE]
    target[stance + 3] += action[_STANCE_KNEE]
    target[stance + 4] += action[_STANCE_ANKLE]
    # the head looks ahead whatever the trunk does
    target[_NECK] += 0.1 - raw[_PITCH] - qpos[7 + _WAIST] - qpos[7 + _CHEST]
    target[_NECK + 1] += -mirror * raw[_ROLL] - qpos[8 + _WAIST] - qpos[8 + _CHEST]
    target[_NECK + 2] += -mirror * raw[_YAW] - qpos[9 + _WAIST] - qpos[9 + _CHEST]

    if switched:
        for j in range(_N):
            state[_BLEND + j] = state[_TARGETS + j] - target[j]
    decay = math.exp(-CONTROL_DT / _BLEND_TIME)
    for j in range(_N):
        state[_BLEND + j] *= decay
        target[j] += state[_BLEND + j]
        state[_TARGETS + j] = target[j]
        ctrl[j] = target[j]


@kernel
def _observe(
    state, coms, places, frames, root, feet, chest, ncon, geoms, addresses, forces, geom_side, fresh
):  # fmt: skip
    com, right, left = coms[root], places[feet[0]], places[feet[1]]
    for k in range(3):
        state[VELOCITY_X + k] = state[VELOCITY_X + k] if fresh else (com[k] - state[COM_X + k]) / CONTROL_DT
        state[COM_X + k] = com[k]
        state[RIGHT_FOOT + k] = right[k]
        state[LEFT_FOOT + k] = left[k]
    state[RIGHT_CONTACT] = 0.0
    state[LEFT_CONTACT] = 0.0
    for c in range(ncon):
        side = geom_side[geoms[c, 0]] + geom_side[geoms[c, 1]]
        if side != 0 and addresses[c] >= 0:
            total = 0.0
            for k in range(4):
                total += forces[addresses[c] + k]
            state[RIGHT_CONTACT if side < 0 else LEFT_CONTACT] += total
    lowest = min(right[2], left[2])
    if com[2] - lowest < LOWEST or frames[chest, 8] < LEAST_UPRIGHT:
        state[FALLEN] = 1.0


def observe(
    index: PersonIndex, model: mujoco.MjModel, data: mujoco.MjData, state: np.ndarray, fresh: bool = False
) -> None:
    """Read centre of mass, feet and contact forces of ``data`` into ``state``; sets `FALLEN` after a fall.

    ``fresh``: this is the first look at a pose that was put there, so the velocity already in ``state``
    stays.
    """
    pairs, addresses = contacts_of(data)
    _observe(
        state, data.subtree_com, data.xpos, data.xmat, index.root, index.feet, index.chest, data.ncon,
        pairs, addresses, data.efc_force, index.geom_side, fresh,
    )  # fmt: skip
