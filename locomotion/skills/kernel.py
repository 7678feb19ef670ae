"""What the control laws of skills on top of the run have in common (numba kernels;
`locomotion.skills.jump.kernel` says how they work).

Memories of such skills begin alike: `ACTIVE` to `AHEAD_Y`.
"""

import math

import numpy as np

from locomotion.body.person import CONTROL_DT, JOINT_NAMES
from locomotion.gaits.run import layout
from surefoot.kernels import kernel

__all__ = [
    "ACTIVE", "AHEAD_X", "AHEAD_Y", "EDGE_X", "EDGE_Y", "ENTRY", "ERROR_DISTANCE", "ERROR_SPEED",
    "FIRST_STEP", "LAST_STEP", "MIRROR", "MIRROR_SIGN", "RANK", "SHARED_MEMORY", "SWING_FOOT", "TRIM",
    "add_actions", "add_clip", "add_feedback", "advance_pace", "apply_offset", "hold_course",
    "measure_errors", "mirror", "sense_swing_foot",
]  # fmt: skip

RANK = 3

ACTIVE, FIRST_STEP, LAST_STEP, ENTRY, ERROR_DISTANCE, ERROR_SPEED, TRIM = range(7)
"""1 while the skill works; the run's step count when it began; step last seen; wanted entry speed [m/s];
errors of the distance [m, positive: too far] and of the speed [m/s] measured last; the run's speed
correction, kept."""
EDGE_X, EDGE_Y, AHEAD_X, AHEAD_Y = range(7, 11)
"""A point of the edge (x, y) [m] and the unit direction of the approach (x, y)."""
SHARED_MEMORY = 11
SWING_FOOT = 12
"""Of the sensors of such a skill the first of the swing foot's three; before it are those of the run."""

_SWING_HIP, _SWING_KNEE, _STANCE_HIP, _STANCE_KNEE, _STANCE_ANKLE, _TRUNK_PITCH = range(6)
_SWING_ABDUCTION, _SWING_ROTATION, _STANCE_ABDUCTION, _STANCE_ROTATION, _TRUNK_ROLL, _TRUNK_YAW = range(6)
# places of the sagittal and of the lateral actions
_N = len(JOINT_NAMES)
_R_HIP, _L_HIP = (JOINT_NAMES.index(f"{side}_hip_flexion") for side in ("right", "left"))
_WAIST, _CHEST = JOINT_NAMES.index("waist_pitch"), JOINT_NAMES.index("chest_pitch")
_FILTER_TIME = 0.02  # [s]
_LEAD = 0.1  # servo damping per stiffness [s], as in locomotion.body.person


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


@kernel
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


@kernel
def measure_errors(mark, memory, state):
    """Errors of distance and speed when a step begins that should do so ``mark`` [m] before the edge, into
    ``memory``."""
    planted = layout.LEFT_PLANTED if state[layout.STANCE] > 0 else layout.RIGHT_PLANTED
    ax, ay = memory[AHEAD_X], memory[AHEAD_Y]
    distance = (memory[EDGE_X] - state[planted]) * ax + (memory[EDGE_Y] - state[planted + 1]) * ay
    speed = state[layout.VELOCITY_X] * ax + state[layout.VELOCITY_Y] * ay
    memory[ERROR_DISTANCE] = min(max(distance - mark, -0.5), 0.5)
    memory[ERROR_SPEED] = min(max(speed - memory[ENTRY], -0.8), 0.8)


@kernel
def hold_course(memory, state):
    """Let the run under the skill go straight at the obstacle, on level ground and with the speed correction
    that it began with. A body that is turned towards its path while it flies lands askew."""
    state[layout.TRIM] = memory[TRIM]
    state[layout.SLOPE] = 0.0
    state[layout.HEADING] = math.atan2(memory[AHEAD_Y], memory[AHEAD_X])
    state[layout.TURN_RATE] = 0.0


@kernel
def sense_swing_foot(state, sensed):
    """The run's 12 sensors and the swing foot relative to the centre of mass, in the mirrored frame of the
    heading, into the first 15 of ``sensed``."""
    side = state[layout.STANCE]
    ch, sh = math.cos(state[layout.HEADING]), math.sin(state[layout.HEADING])
    foot = layout.RIGHT_FOOT if side > 0 else layout.LEFT_FOOT
    dx, dy = state[foot] - state[layout.COM_X], state[foot + 1] - state[layout.COM_Y]
    for j in range(12):
        sensed[j] = state[layout.FIRST_SENSOR + j]
    sensed[SWING_FOOT] = ch * dx + sh * dy
    sensed[SWING_FOOT + 1] = state[foot + 2] - state[layout.COM_Z]
    sensed[SWING_FOOT + 2] = -side * (-sh * dx + ch * dy)


@kernel
def add_feedback(m_sp, m_ap, sensed, reference, phase, action, side_action):
    """Reduced-order feedback: ``m_ap`` (27,) ``m_sp`` (3 n,) (sensed - reference), added to the actions (6,).

    sensed (n,). reference (bins, n): expected sensors over the step.
    """
    n = sensed.shape[0]
    at = phase * (reference.shape[0] - 1)
    low = min(int(at), reference.shape[0] - 2)
    w = at - low
    for r in range(RANK):
        latent = 0.0
        for j in range(n):
            expected = (1.0 - w) * reference[low, j] + w * reference[low + 1, j]
            latent += m_sp[r * n + j] * (sensed[j] - expected)
        latent = min(max(latent, -1.0), 1.0)
        action[_SWING_HIP] += m_ap[r] * latent
        side_action[_SWING_ABDUCTION] += m_ap[RANK + r] * latent
        side_action[_SWING_ROTATION] += m_ap[2 * RANK + r] * latent
        action[_STANCE_HIP] += m_ap[3 * RANK + r] * latent
        side_action[_STANCE_ABDUCTION] += m_ap[4 * RANK + r] * latent
        side_action[_STANCE_ROTATION] += m_ap[5 * RANK + r] * latent
        action[_TRUNK_PITCH] += m_ap[6 * RANK + r] * latent
        side_action[_TRUNK_ROLL] += m_ap[7 * RANK + r] * latent
        side_action[_TRUNK_YAW] += m_ap[8 * RANK + r] * latent


@kernel
def add_actions(side, action, side_action, wanted):
    """Put sagittal and lateral actions (6,) on the joints of ``wanted`` (39,); ``side``: the stance
    foot's."""
    stance = _L_HIP if side > 0 else _R_HIP
    swing = _R_HIP if side > 0 else _L_HIP
    wanted[swing] += action[_SWING_HIP]
    wanted[swing + 3] += action[_SWING_KNEE]
    wanted[stance] += action[_STANCE_HIP]
    wanted[stance + 3] += action[_STANCE_KNEE]
    wanted[stance + 4] += action[_STANCE_ANKLE]
    wanted[_WAIST] += action[_TRUNK_PITCH]
    wanted[_CHEST] += action[_TRUNK_PITCH]
    wanted[swing + 1] += side_action[_SWING_ABDUCTION]
    wanted[swing + 2] += side_action[_SWING_ROTATION]
    wanted[stance + 1] += side_action[_STANCE_ABDUCTION]
    wanted[stance + 2] += side_action[_STANCE_ROTATION]
    for k in range(2):
        wanted[_WAIST + 1 + k] -= side * side_action[_TRUNK_ROLL + k]
        wanted[_CHEST + 1 + k] -= side * side_action[_TRUNK_ROLL + k]


@kernel
def add_clip(share, alpha, cycle_rate, difference, rate, flip, mirror, sign, wanted):
    """Add ``alpha`` times a row of ``difference`` (n, 39) at ``share`` of it, with its ``rate`` in advance of
    the servos' lag at ``cycle_rate`` [1/s]; of the mirror image with ``flip``."""
    place = share * (difference.shape[0] - 1)
    low = min(int(place), difference.shape[0] - 2)
    w = place - low
    lead = cycle_rate * _LEAD
    for j in range(_N):
        value = (1.0 - w) * difference[low, j] + w * difference[low + 1, j]
        value += lead * ((1.0 - w) * rate[low, j] + w * rate[low + 1, j])
        if flip:
            wanted[mirror[j]] += alpha * sign[j] * value
        else:
            wanted[j] += alpha * value


@kernel
def advance_pace(beta, knots, timing, state):
    """Change the phase that `run_tick` has advanced as if the pace were ``beta``; gives the run's step
    time."""
    step_time = _between(knots, timing, state[layout.SPEED])
    phase = state[layout.PHASE]
    state[layout.PHASE] = min(phase + (beta - 1.0) * CONTROL_DT / step_time, 1.0)
    return step_time


@kernel
def apply_offset(wanted, offset, ctrl):
    """Low-pass ``wanted`` (39,) into ``offset`` (39,) and add that to ``ctrl`` (39,)."""
    keep = math.exp(-CONTROL_DT / _FILTER_TIME)
    for j in range(_N):
        offset[j] = keep * offset[j] + (1.0 - keep) * wanted[j]
        ctrl[j] += offset[j]
