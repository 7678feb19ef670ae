"""Vaulting over a wall from the run, one hand on its top: the control law on top of the running layout.

A vault takes four steps, counted by the stance switches of `controller.run_tick`:

    0  transIn   the last running step; it begins with the stance foot ``mark`` before the wall
    1  clear     the take-off foot pushes off, the hand on its side plants, both legs pass beside the hand
    2  clear     the leading foot has landed behind the wall and carries on
    3  transOut  the recovery step; then the run goes on alone

and has the paper's three phases: 1 until the centre of mass has passed the hand, 2 until a foot lands, 3 to
the end. As in `locomotion.skills.jump.kernel` every tick adds an offset to the PD targets of the run,

    offset = alpha * (clip - run reference) + a_hat(h) + G e + M_ap M_k (s - s_ref)      (rank 3, phase k)

and scales the pace by beta; everything is mirrored when the take-off foot is the left one. ``s`` (18,) are
the run's sensors, the swing foot and the supporting hand, both relative to the centre of mass; the hand
counts in phase 1 only.

The supporting arm aims at a point on the top (`locomotion.body.arm_reach`). Where its hand touches the top it
stays (`HOLD`) until the centre of mass has passed it or the arm is stretched out, and meanwhile the arm
pushes: its elbow aims further out than that point is. The palm sticks by friction only; the paper's hand is
held by a ball joint there (4.2.1), which the body may switch on.

Over a wall thicker than usual it takes off nearer to the edge (`nearer`).
"""

import math

import numpy as np

from locomotion.body.arm_reach import ARM_START, HAND_RADIUS, hand_place, reach, shoulder_frame
from locomotion.body.person import CONTROL_DT, JOINT_NAMES
from locomotion.gaits.run import layout
from locomotion.skills.kernel import (
    ACTIVE,
    AHEAD_X,
    AHEAD_Y,
    EDGE_X,
    EDGE_Y,
    ENTRY,
    ERROR_DISTANCE,
    ERROR_SPEED,
    FIRST_STEP,
    LAST_STEP,
    RANK,
    SHARED_MEMORY,
    SWING_FOOT,
    TRIM,
    add_actions,
    add_clip,
    add_feedback,
    advance_pace,
    apply_offset,
    hold_course,
    measure_errors,
    sense_swing_foot,
)  # fmt: skip
from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "ACTIVE", "ANCHOR", "BINS", "ERROR_DISTANCE", "ERROR_SPEED", "HELD", "HOLD", "KNOTS", "LAST_STEP",
    "MEMORY_SIZE", "PARAMETERS", "PHASES", "RANK", "SENSED", "SENSORS", "SIDE", "STEPS", "TOP",
    "nearer", "parameter_slices", "start_vault", "vault_fell", "vault_tick",
]  # fmt: skip

STEPS, PHASES, KNOTS, SENSORS, BINS = 4, 3, 5, 18, 6
SAGITTAL = ("swing_hip", "swing_knee", "stance_hip", "stance_knee", "stance_ankle", "waist_pitch")
LATERAL = (
    "swing_hip_abduction", "swing_hip_rotation", "stance_hip_abduction", "stance_hip_rotation",
    "waist_roll", "waist_yaw",
)  # fmt: skip

PARAMETERS: dict[str, int] = {
    "a_hat": STEPS * KNOTS * 6,   # (4, 5, 6) offsets of the sagittal actions [rad]
    "lateral": STEPS * 3 * 6,     # (4, 3, 6) offsets of the lateral actions, mirrored [rad]
    "beta": STEPS,                # (4,) pace of each step relative to the run's
    "alpha": 2,                   # (2,) share of the clip in steps 1 and 2
    "marks": 2,                   # (2,) distance to the edge of the stance foot when steps 0 and 1 begin [m]
    "arm": 8,                     # see `_ARM`
    "gains": 3 * 2 * 7,           # (3, 2, 7) per step: change of the sagittal actions and of beta per error
    "m_sp": PHASES * RANK * SENSORS,  # (3, 3, 18)
    "m_ap": 9 * RANK,             # (9, 3), actions in the order of `controller.ACTIONS`
    "entry": 1,                   # wanted entry speed [m/s]
}  # fmt: skip
"""Blocks of a parameter vector, in order, with their lengths. ``arm``: phase of step 1 at which the hand
begins to reach; point aimed at, as share of the depth, and [m] outward from the shoulder; rotation of the
upper arm [rad]; while held: push of the elbow [rad], of the shoulder backward [rad] and outward [rad]; lift
of the clavicle [rad]."""


def parameter_slices() -> dict[str, slice]:
    """Where each block of `PARAMETERS` lies in a parameter vector."""
    result, start = {}, 0
    for name, size in PARAMETERS.items():
        result[name] = slice(start, start + size)
        start += size
    return result


_SP = parameter_slices()
_A_HAT, _LATERAL, _BETA, _ALPHA, _MARKS, _ARM, _GAINS, _M_SP, _M_AP, _ENTRY = (
    _SP[k].start for k in PARAMETERS
)

# --- what a vault remembers, after what `locomotion.skills.kernel` says
TOP, DEPTH, HOLD, HELD, SIDE, REACH, PHASE, STRETCH, FLOOR = range(SHARED_MEMORY, SHARED_MEMORY + 9)
"""Height of the top in the world [m]; thickness [m]; hand: 0 free, 1 on it, 2 let go; ticks on it; side of
the supporting hand (-1 right, +1 left); how far the arm has gone over to reaching [0 to 1]; phase 0, 1, 2;
distance of the point from the shoulder over the arm's length; height of the floor before the wall [m]."""
_N = len(JOINT_NAMES)
_ANCHOR = SHARED_MEMORY + 9
ANCHOR = slice(_ANCHOR, _ANCHOR + 3)
"""Where the hand came to the top (3,) [m]."""
_LAST_ARM = ANCHOR.stop  # angles (4,) [rad] of the supporting arm that were aimed at last
_OFFSET = _LAST_ARM + 4  # (39,) [rad] of the targets, low-passed
_SENSED = _OFFSET + _N
SENSED = slice(_SENSED, _SENSED + SENSORS)
"""Sensors of the last tick."""
MEMORY_SIZE = _SENSED + SENSORS
_R_ARM, _L_ARM = ARM_START
_HAND = SWING_FOOT + 3  # first of the supporting hand's three sensors
_LEAD = 0.1  # servo damping per stiffness [s], as in locomotion.body.person
_REACH_TIME, _RETURN_TIME = 0.10, 0.15  # [s] in which the arm goes over to reaching, and back
_TOUCH = 0.006  # [m] above the top at which the hand touches it
_STRETCHED = 0.985  # share of the arm's length at which a hand lets go that the shoulder moves away from
_LONGEST = 60  # ticks that a hand stays at most
_LOWEST = 0.5
# [m] of the centre of mass above the floor; lower counts as a fall even while it passes the wall
_USUAL_DEPTH = 0.3  # [m] of the walls that vaults are learned on, on average
_NEARER = 0.45  # [m] nearer per metre of thickness beyond that: the wall stays under the middle of the flight


@kernel
def nearer(depth):
    """By how much [m] nearer to the edge of a wall ``depth`` [m] thick a vault begins."""
    return _NEARER * max(depth - _USUAL_DEPTH, 0.0)


@allocating_kernel
def start_vault(p, memory, state, edge, ahead, top, height, depth):
    """Begin a vault at the stance switch that has just been made (its tick's `vault_tick` comes next).

    p: parameters. memory (MEMORY_SIZE,). state: the run's. edge (2,): a point of the edge [m]. ahead (2,):
    unit vector over the wall. top: its height in the world, height: above the floor, depth: thickness [m].
    """
    memory[:] = 0.0
    memory[ACTIVE] = 1.0
    memory[FIRST_STEP] = state[layout.STEPS]
    memory[ENTRY] = p[_ENTRY]
    memory[TRIM] = state[layout.TRIM]
    memory[EDGE_X], memory[EDGE_Y], memory[AHEAD_X], memory[AHEAD_Y] = edge[0], edge[1], ahead[0], ahead[1]
    memory[TOP], memory[DEPTH], memory[FLOOR] = top, depth, top - height
    memory[SIDE] = -state[layout.STANCE]  # the next stance foot takes off, on the side of the hand
    measure_errors(p[_MARKS] - nearer(depth), memory, state)


@kernel
def vault_fell(memory, state):
    """Whether a body that `controller.observe` takes for fallen has fallen: over the wall it lies and tucks
    its legs."""
    if memory[ACTIVE] == 0.0 or memory[LAST_STEP] != 1.0:
        return state[layout.FALLEN] > 0.0
    return state[layout.COM_Z] < memory[FLOOR] + _LOWEST


@allocating_kernel
def _hand(p, memory, step, phase, qpos):
    """Let the hand touch and stay."""
    ax, ay = memory[AHEAD_X], memory[AHEAD_Y]
    if memory[HOLD] == 0.0 and step == 1 and memory[REACH] > 0.0:
        hand = hand_place(qpos, memory[SIDE])
        into = (hand[0] - memory[EDGE_X]) * ax + (hand[1] - memory[EDGE_Y]) * ay
        if hand[2] < memory[TOP] + HAND_RADIUS + _TOUCH and 0.0 < into < memory[DEPTH]:
            memory[HOLD] = 1.0
            for k in range(3):
                memory[_ANCHOR + k] = hand[k]
    elif memory[HOLD] == 1.0:
        memory[HELD] += 1.0


@allocating_kernel
def _arm(p, memory, step, phase, qpos, ctrl):
    """The supporting arm's targets: from the run's to reaching for the top, holding and pushing, and back."""
    if step == 1 and phase >= p[_ARM] and memory[HOLD] < 2.0:
        memory[REACH] = min(memory[REACH] + CONTROL_DT / _REACH_TIME, 1.0)
    else:
        memory[REACH] = max(memory[REACH] - CONTROL_DT / _RETURN_TIME, 0.0)
    weight = memory[REACH]
    if weight == 0.0:
        return
    side, ax, ay = memory[SIDE], memory[AHEAD_X], memory[AHEAD_Y]
    arm = _L_ARM if side > 0 else _R_ARM
    target, angles = np.empty(3), np.empty(4)
    if memory[HOLD] == 0.0:
        shoulder, _ = shoulder_frame(qpos, side)
        across = (
            (shoulder[1] - memory[EDGE_Y]) * ax - (shoulder[0] - memory[EDGE_X]) * ay + side * p[_ARM + 2]
        )
        into = p[_ARM + 1] * memory[DEPTH]
        target[0] = memory[EDGE_X] + into * ax - across * ay
        target[1] = memory[EDGE_Y] + into * ay + across * ax
        target[2] = memory[TOP] + HAND_RADIUS - 0.02
    else:
        for k in range(3):
            target[k] = memory[_ANCHOR + k]
    if memory[HOLD] < 2.0:
        stretched = reach(qpos, side, target, p[_ARM + 3], angles)
        if memory[HOLD] == 1.0 and stretched > _STRETCHED and stretched > memory[STRETCH]:
            memory[HOLD] = 2.0
        memory[STRETCH] = stretched
        for k in range(4):
            last = memory[_LAST_ARM + k]
            memory[_LAST_ARM + k] = angles[k]
            if weight > CONTROL_DT / _REACH_TIME * 1.5:  # not in the first tick
                angles[k] += min(max((angles[k] - last) / CONTROL_DT * _LEAD, -0.8), 0.8)
        if memory[HOLD] == 1.0:
            angles[3] -= p[_ARM + 4]
            angles[0] -= p[_ARM + 5]
            angles[1] += p[_ARM + 6]
        for k in range(4):
            ctrl[arm + k] += weight * (angles[k] - ctrl[arm + k])
        ctrl[arm - 1] += weight * p[_ARM + 7]
        for k in range(4, 7):
            ctrl[arm + k] *= 1.0 - weight
    else:
        for k in range(4):  # from where it let go back to the run
            ctrl[arm + k] += weight * (memory[_LAST_ARM + k] - ctrl[arm + k])


@allocating_kernel
def vault_tick(p, knots, timing, difference, rate, reference, mirror, sign, memory, state, qpos, ctrl):
    """One tick of a vault, after `run_tick` and before the physics: adds to ``ctrl`` (39,), changes the
    pace, says in ``memory`` whether the hand is on the top (`HOLD`) and where (`ANCHOR`).

    p: parameters at this height. knots, timing (k,): the run's speeds [m/s] and step times [s]. difference,
    rate (n, 39): clip less run reference over a cycle that begins with the right foot's take-off step, and
    its rate per cycle. reference (4, 6, 18): expected sensors. mirror, sign (39,). memory (MEMORY_SIZE,),
    state: changed. qpos (46,): read.
    """
    if memory[ACTIVE] == 0.0:
        return
    step = int(state[layout.STEPS] - memory[FIRST_STEP])
    if step != int(memory[LAST_STEP]):
        memory[LAST_STEP] = step
        if step == 1:
            measure_errors(p[_MARKS + 1] - nearer(memory[DEPTH]), memory, state)
    side, phase = state[layout.STANCE], state[layout.PHASE]
    hold_course(memory, state)
    _hand(p, memory, step, phase, qpos)
    past = (state[layout.COM_X] - memory[_ANCHOR]) * memory[AHEAD_X] + (
        state[layout.COM_Y] - memory[_ANCHOR + 1]
    ) * memory[AHEAD_Y]
    if memory[HOLD] == 1.0 and (past > 0.0 or step > 1 or memory[HELD] > _LONGEST):
        memory[HOLD] = 2.0
    if step > 1:
        memory[PHASE] = 2.0
    elif memory[HOLD] == 2.0:
        memory[PHASE] = 1.0
    wanted = np.zeros(_N)
    sensed = memory[_SENSED : _SENSED + SENSORS]
    sense_swing_foot(state, sensed)
    for j in range(_HAND, _HAND + 3):
        sensed[j] = 0.0
    if memory[PHASE] == 0.0 and step == 1:
        hand = hand_place(qpos, memory[SIDE])
        ch, sh = math.cos(state[layout.HEADING]), math.sin(state[layout.HEADING])
        dx, dy = hand[0] - state[layout.COM_X], hand[1] - state[layout.COM_Y]
        sensed[_HAND] = ch * dx + sh * dy
        sensed[_HAND + 1] = hand[2] - state[layout.COM_Z]
        sensed[_HAND + 2] = -side * (-sh * dx + ch * dy)
    if step < STEPS:
        at = phase * (KNOTS - 1)
        low = min(int(at), KNOTS - 2)
        weight = at - low
        action = np.zeros(6)
        ed, es = memory[ERROR_DISTANCE], memory[ERROR_SPEED]
        gains = _GAINS + step * 14
        for i in range(6):
            row = _A_HAT + (step * KNOTS + low) * 6 + i
            action[i] = (1.0 - weight) * p[row] + weight * p[row + 6]
            if step < 3:
                action[i] += p[gains + i] * ed + p[gains + 7 + i] * es
        side_action = np.empty(6)
        at = 2.0 * phase
        low = min(int(at), 1)
        weight = at - low
        for i in range(6):
            row = _LATERAL + (step * 3 + low) * 6 + i
            side_action[i] = (1.0 - weight) * p[row] + weight * p[row + 6]
        own = _M_SP + int(memory[PHASE]) * RANK * SENSORS
        m_sp, m_ap = p[own : own + RANK * SENSORS], p[_M_AP : _M_AP + 9 * RANK]
        add_feedback(m_sp, m_ap, sensed, reference[step], phase, action, side_action)
        add_actions(side, action, side_action, wanted)
        beta = p[_BETA + step]
        if step < 3:
            beta += p[gains + 6] * ed + p[gains + 13] * es
        beta = min(max(beta, 0.3), 2.0)
        step_time = advance_pace(beta, knots, timing, state)
        if 1 <= step <= 2:
            share, flip = 0.5 * (phase + (step - 1.0)), (side > 0) == (step == 1)  # taking off from the left
            cycle_rate = 0.5 * beta / step_time if phase < 1.0 else 0.0
            alpha = p[_ALPHA + step - 1]
            add_clip(share, alpha, cycle_rate, difference, rate, flip, mirror, sign, wanted)
    apply_offset(wanted, memory[_OFFSET : _OFFSET + _N], ctrl)
    _arm(p, memory, step, phase, qpos, ctrl)
    if step >= STEPS and state[layout.STEP_TIME] > 0.12:
        memory[ACTIVE] = 0.0
