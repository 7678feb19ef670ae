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

import math

import numpy as np
from numba import njit

from locomotion import controller
from locomotion.person import CONTROL_DT, JOINT_NAMES

__all__ = [
    "ACTIVE", "BINS", "ERROR_DISTANCE", "ERROR_SPEED", "MEMORY_SIZE", "MIRROR", "MIRROR_SIGN",
    "PARAMETERS", "RANK", "SENSED", "SENSORS", "STEPS", "jump_tick", "mirror", "parameter_slices",
    "start_jump",
]  # fmt: skip

STEPS = 4
"""Steps of a jump, from transIn to transOut."""
KNOTS = 4
RANK = 3
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
_A_HAT, _LATERAL, _BETA, _ALPHA, _MARKS, _GAINS, _M_SP, _M_AP = (_SP[k].start for k in PARAMETERS)

# --- what a jump remembers
ACTIVE, FIRST_STEP, LAST_STEP, ENTRY, ERROR_DISTANCE, ERROR_SPEED, TRIM = range(7)
"""1 while jumping; the run's step count when it began; step last seen; wanted entry speed [m/s]; errors
of the distance [m, positive: too far] and of the speed [m/s] measured last; the run's speed correction,
kept."""
EDGE = slice(7, 11)
"""A point of the edge (x, y) [m] and the unit direction of the approach (x, y)."""
_OFFSET = 11
SENSED = slice(50, 50 + SENSORS)
MEMORY_SIZE = 50 + SENSORS

_N = len(JOINT_NAMES)
_R_HIP, _L_HIP = (JOINT_NAMES.index(f"{side}_hip_flexion") for side in ("right", "left"))
_WAIST, _CHEST = JOINT_NAMES.index("waist_pitch"), JOINT_NAMES.index("chest_pitch")
_TIMING = controller.parameter_slices()["timing"].start
_FILTER_TIME = 0.02  # [s]
_LEAD = 0.1  # servo damping per stiffness [s], as in locomotion.person


def _mirror_table() -> tuple[np.ndarray, np.ndarray]:
    """Joint that takes each joint's place in the mirror, (39,) int64, and the sign of its angle, (39,)."""
    swap = {"right_": "left_", "left_": "right_"}
    index = np.arange(_N)
    sign = np.ones(_N)
    for i, name in enumerate(JOINT_NAMES):
        side = next((s for s in swap if name.startswith(s)), None)
        if side is not None:
            index[i] = JOINT_NAMES.index(swap[side] + name[len(side) :])
        elif name.endswith(("_roll", "_yaw")):
            sign[i] = -1.0
    return index, sign


MIRROR, MIRROR_SIGN = _mirror_table()


def mirror(poses: np.ndarray) -> np.ndarray:
    """Joint angles (..., 39) of the mirror image."""
    return poses[..., MIRROR] * MIRROR_SIGN


@njit(cache=True)
def _between(knots, values, x):
    """Linear interpolation of ``values`` (k,) over ``knots`` (k,), held beyond the ends."""
    k = knots.shape[0]
    if x <= knots[0]:
        return values[0]
    for i in range(k - 1):
        if x <= knots[i + 1]:
            w = (x - knots[i]) / (knots[i + 1] - knots[i])
            return (1.0 - w) * values[i] + w * values[i + 1]
    return values[k - 1]


@njit(cache=True)
def _measure_errors(p, memory, state, mark):
    """Errors of distance and speed when a step begins, into ``memory``."""
    planted = 28 + (3 if state[controller.STANCE] > 0 else 0)
    ax, ay = memory[9], memory[10]
    distance = (memory[7] - state[planted]) * ax + (memory[8] - state[planted + 1]) * ay
    speed = state[17] * ax + state[18] * ay
    memory[ERROR_DISTANCE] = min(max(distance - p[_MARKS + mark], -0.5), 0.5)
    memory[ERROR_SPEED] = min(max(speed - memory[ENTRY], -0.8), 0.8)


@njit(cache=True)
def start_jump(p, memory, state, entry, edge_x, edge_y, ahead_x, ahead_y):
    """Begin a jump at the stance switch that has just been made (its tick's `jump_tick` comes next).

    p (241,): parameters. memory (MEMORY_SIZE,). state: the run's. entry: wanted speed [m/s]. edge: a
    point of the edge [m]; ahead: unit vector towards the obstacle.
    """
    memory[:] = 0.0
    memory[ACTIVE] = 1.0
    memory[FIRST_STEP] = state[controller.STEPS]
    memory[LAST_STEP] = 0.0
    memory[ENTRY] = entry
    memory[TRIM] = state[controller.TRIM]
    memory[7], memory[8], memory[9], memory[10] = edge_x, edge_y, ahead_x, ahead_y
    _measure_errors(p, memory, state, 0)


@njit(cache=True)
def jump_tick(p, knots, timing, difference, difference_rate, reference, mirror, sign, memory, state, ctrl):
    """One tick of a jump, after `run_tick` and before the physics: adds to ``ctrl`` (39,), changes the
    pace.

    p (241,): parameters at this height. knots, timing (k,): the run's speeds [m/s] and step times [s].
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
            _measure_errors(p, memory, state, 1)
    side, phase = state[controller.STANCE], state[controller.PHASE]
    state[controller.TRIM] = memory[TRIM]
    state[controller.SLOPE] = 0.0
    wanted = np.zeros(_N)
    # where the swing foot is, beside the run's sensors
    ch, sh = math.cos(state[controller.HEADING]), math.sin(state[controller.HEADING])
    foot = 20 + (0 if side > 0 else 3)
    dx, dy = state[foot] - state[14], state[foot + 1] - state[15]
    sensed = memory[50 : 50 + SENSORS]
    for j in range(12):
        sensed[j] = state[37 + j]
    sensed[12] = ch * dx + sh * dy
    sensed[13] = state[foot + 2] - state[16]
    sensed[14] = -side * (-sh * dx + ch * dy)
    if step < STEPS:
        stance = _L_HIP if side > 0 else _R_HIP
        swing = _R_HIP if side > 0 else _L_HIP
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
        # reduced-order feedback
        b = phase * (BINS - 1)
        bin_low = min(int(b), BINS - 2)
        bw = b - bin_low
        for r in range(RANK):
            latent = 0.0
            for j in range(SENSORS):
                expected = (1.0 - bw) * reference[step, bin_low, j] + bw * reference[step, bin_low + 1, j]
                latent += p[_M_SP + r * SENSORS + j] * (sensed[j] - expected)
            latent = min(max(latent, -1.0), 1.0)
            action[0] += p[_M_AP + r] * latent
            side_action[0] += p[_M_AP + RANK + r] * latent
            side_action[1] += p[_M_AP + 2 * RANK + r] * latent
            action[2] += p[_M_AP + 3 * RANK + r] * latent
            side_action[2] += p[_M_AP + 4 * RANK + r] * latent
            side_action[3] += p[_M_AP + 5 * RANK + r] * latent
            action[5] += p[_M_AP + 6 * RANK + r] * latent
            side_action[4] += p[_M_AP + 7 * RANK + r] * latent
            side_action[5] += p[_M_AP + 8 * RANK + r] * latent
        wanted[swing] += action[0]
        wanted[swing + 3] += action[1]
        wanted[stance] += action[2]
        wanted[stance + 3] += action[3]
        wanted[stance + 4] += action[4]
        wanted[_WAIST] += action[5]
        wanted[_CHEST] += action[5]
        wanted[swing + 1] += side_action[0]
        wanted[swing + 2] += side_action[1]
        wanted[stance + 1] += side_action[2]
        wanted[stance + 2] += side_action[3]
        for k in range(2):
            wanted[_WAIST + 1 + k] -= side * side_action[4 + k]
            wanted[_CHEST + 1 + k] -= side * side_action[4 + k]
        beta = p[_BETA + step]
        if step < 3:
            beta += p[gains + 6] * ed + p[gains + 13] * es
        beta = min(max(beta, 0.3), 2.0)
        step_time = _between(knots, timing, state[controller.SPEED])
        if 1 <= step <= 2:
            alpha = p[_ALPHA + step - 1]
            place = 0.5 * (phase + (step - 1.0)) * (difference.shape[0] - 1)
            row_low = min(int(place), difference.shape[0] - 2)
            w = place - row_low
            lead = 0.5 * beta / step_time * _LEAD if phase < 1.0 else 0.0
            flip = (side > 0) == (step == 1)  # taking off from the left foot
            for j in range(_N):
                value = (1.0 - w) * difference[row_low, j] + w * difference[row_low + 1, j]
                value += lead * (
                    (1.0 - w) * difference_rate[row_low, j] + w * difference_rate[row_low + 1, j]
                )
                if flip:
                    wanted[mirror[j]] += alpha * sign[j] * value
                else:
                    wanted[j] += alpha * value
        state[controller.PHASE] = min(phase + (beta - 1.0) * CONTROL_DT / step_time, 1.0)
    keep = math.exp(-CONTROL_DT / _FILTER_TIME)
    for j in range(_N):
        memory[_OFFSET + j] = keep * memory[_OFFSET + j] + (1.0 - keep) * wanted[j]
        ctrl[j] += memory[_OFFSET + j]
    if step >= STEPS and state[controller.STEP_TIME] > 0.12:
        memory[ACTIVE] = 0.0
