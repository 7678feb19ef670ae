"""Jumping onto a stair from the run: the jump's control law on top of the running controller.

A jump takes four steps, counted by the stance switches of `controller.run_tick`:

    0  transIn   the last running step; it begins with the stance foot ``mark`` before the edge
    1  clear     the take-off foot pushes off, the body flies, knees up
    2  clear     the other foot has landed on top and carries on
    3  transOut  the recovery step; then the run goes on alone

During a jump every tick adds an offset to the PD targets of the run,

    offset = alpha * (clip - run reference) + a_hat(h) + G e + M_ap M_sp (s - s_ref)      (rank 3)

and scales the pace by beta. ``a_hat`` has four knots over each step for six sagittal actions and one
value for six lateral ones. ``e`` (2,) are the errors of the distance to the edge and of speed, measured
when steps 0 and 1 begin. ``s`` (15,) are the run's sensors and the swing foot's place relative to the
centre of mass. The offset passes through a low-pass filter, which blends the references where steps meet.
Everything is mirrored when the take-off foot is the left one. The vector of parameters at a height comes
from radial basis functions over the learned heights (biharmonic spline with a linear term).
"""

import numpy as np

from locomotion.body.person import JOINT_NAMES
from locomotion.gaits.run import controller
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
    MIRROR,
    MIRROR_SIGN,
    RANK,
    SHARED_MEMORY,
    TRIM,
    add_actions,
    add_clip,
    add_feedback,
    advance_pace,
    apply_offset,
    hold_course,
    measure_errors,
    mirror,
    sense_swing_foot,
)  # fmt: skip
from surefoot.kernels import allocating_kernel

__all__ = [
    "ACTIVE", "BINS", "ERROR_DISTANCE", "ERROR_SPEED", "MEMORY_SIZE", "MIRROR", "MIRROR_SIGN",
    "PARAMETERS", "RANK", "SENSED", "SENSORS", "STEPS", "jump_tick", "mirror", "parameter_slices",
    "start_jump",
]  # fmt: skip

STEPS = 4
"""Steps of a jump, from transIn to transOut."""
KNOTS = 4
SENSORS = 15
BINS = 6
SAGITTAL = ("swing_hip", "swing_knee", "stance_hip", "stance_knee", "stance_ankle", "waist_pitch")
LATERAL = (
    "swing_hip_abduction", "swing_hip_rotation", "stance_hip_abduction", "stance_hip_rotation",
    "waist_roll", "waist_yaw",
)  # fmt: skip

PARAMETERS: dict[str, int] = {
    "a_hat": STEPS * KNOTS * 6,  # (4, 4, 6) offsets of the sagittal actions [rad]
    "lateral": STEPS * 6,        # (4, 6) offsets of the lateral actions, mirrored [rad]
    "beta": STEPS,               # (4,) pace of each step relative to the run's
    "alpha": 2,                  # (2,) share of the clip in steps 1 and 2
    "marks": 2,                  # (2,) distance to the edge of the stance foot when steps 0 and 1 begin [m]
    "gains": 3 * 2 * 7,          # (3, 2, 7) per step: change of the sagittal actions and of beta per error
    "m_sp": RANK * SENSORS,      # (3, 15)
    "m_ap": 9 * RANK,            # (9, 3), actions in the order of `controller.ACTIONS`
    "entry": 1,                  # wanted entry speed [m/s]
}  # fmt: skip
"""Blocks of a parameter vector, in order, with their lengths."""


def parameter_slices() -> dict[str, slice]:
    """Where each block of `PARAMETERS` lies in a parameter vector."""
    result, start = {}, 0
    for name, size in PARAMETERS.items():
        result[name] = slice(start, start + size)
        start += size
    return result


_SP = parameter_slices()
_A_HAT, _LATERAL, _BETA, _ALPHA, _MARKS, _GAINS, _M_SP, _M_AP, _ENTRY = (_SP[k].start for k in PARAMETERS)

# --- what a jump remembers, after what `locomotion.skills.kernel` says
_N = len(JOINT_NAMES)
_OFFSET = SHARED_MEMORY
_SENSED = _OFFSET + _N
SENSED = slice(_SENSED, _SENSED + SENSORS)
"""Sensors of the last tick, after the (39,) offsets [rad] of the targets, low-passed."""
MEMORY_SIZE = _SENSED + SENSORS


@allocating_kernel
def start_jump(p, memory, state, edge_x, edge_y, ahead_x, ahead_y):
    """Begin a jump at the stance switch that has just been made (its tick's `jump_tick` comes next).

    p (243,): parameters. memory (MEMORY_SIZE,). state: the run's. edge: a point of the edge [m]; ahead: unit
    vector towards the obstacle.
    """
    memory[:] = 0.0
    memory[ACTIVE] = 1.0
    memory[FIRST_STEP] = state[controller.STEPS]
    memory[LAST_STEP] = 0.0
    memory[ENTRY] = p[_ENTRY]
    memory[TRIM] = state[controller.TRIM]
    memory[EDGE_X], memory[EDGE_Y], memory[AHEAD_X], memory[AHEAD_Y] = edge_x, edge_y, ahead_x, ahead_y
    measure_errors(p[_MARKS], memory, state)


@allocating_kernel
def jump_tick(p, knots, timing, difference, difference_rate, reference, mirror, sign, memory, state, ctrl):
    """One tick of a jump, after `run_tick` and before the physics: adds to ``ctrl`` (39,), changes the
    pace.

    p (243,): parameters at this height. knots, timing (k,): the run's speeds [m/s] and step times [s].
    difference, difference_rate (n, 39): clip less run reference over a cycle that begins with the right
    foot's take-off step, and its rate per cycle. reference (4, 6, 15): expected sensors. mirror, sign
    (39,). memory (MEMORY_SIZE,), state: changed.
    """
    if memory[ACTIVE] == 0.0:
        return
    step = int(state[controller.STEPS] - memory[FIRST_STEP])
    if step != int(memory[LAST_STEP]):
        memory[LAST_STEP] = step
        if step == 1:
            measure_errors(p[_MARKS + 1], memory, state)
    side, phase = state[controller.STANCE], state[controller.PHASE]
    hold_course(memory, state)
    wanted = np.zeros(_N)
    sensed = memory[_SENSED : _SENSED + SENSORS]
    sense_swing_foot(state, sensed)
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
        for i in range(6):
            side_action[i] = p[_LATERAL + step * 6 + i]
        m_sp, m_ap = p[_M_SP : _M_SP + RANK * SENSORS], p[_M_AP : _M_AP + 9 * RANK]
        add_feedback(m_sp, m_ap, sensed, reference[step], phase, action, side_action)
        add_actions(side, action, side_action, wanted)
        beta = p[_BETA + step]
        if step < 3:
            beta += p[gains + 6] * ed + p[gains + 13] * es
        beta = min(max(beta, 0.3), 2.0)
        step_time = advance_pace(beta, knots, timing, state)
        if 1 <= step <= 2:
            share, flip = 0.5 * (phase + (step - 1.0)), (side > 0) == (step == 1)  # taking off from the left
            rate = 0.5 * beta / step_time if phase < 1.0 else 0.0
            alpha = p[_ALPHA + step - 1]
            add_clip(share, alpha, rate, difference, difference_rate, flip, mirror, sign, wanted)
    apply_offset(wanted, memory[_OFFSET : _OFFSET + _N], ctrl)
    if step >= STEPS and state[controller.STEP_TIME] > 0.12:
        memory[ACTIVE] = 0.0
