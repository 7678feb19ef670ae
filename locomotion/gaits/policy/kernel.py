"""A policy that controls one person, compiled: the same as `locomotion.gaits.policy.law` and the network's
layers.

Per control tick of 10 ms, in the order *control, physics, feel*::

    skill = load_policy()                                       # locomotion.gaits.policy.skill
    memory, felt = new_memory(yaw), np.zeros(layout.FELT_SIZE)
    feel(parts, data, felt)
    each tick:
        if tick % TICKS_PER_DECISION == 0:
            decide_tick(*skill.tables, memory, asked, felt, data.qpos, data.qvel, data.ctrl)
        mujoco.mj_step(model, data, STEPS_PER_TICK)
        feel(parts, data, felt)

``asked`` (2,) float64: speed [m/s] and turn rate [rad/s], which may jump. `decide_tick` reads nothing else,
so a simulation that is restored with ``memory`` and ``felt`` goes on bit for bit.
"""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.contacts import contacts_of
from locomotion.body.person import JOINT_NAMES, PersonIndex
from locomotion.gaits.policy import layout as at
from locomotion.gaits.policy.corrections import correct_one, kept_off_one
from locomotion.gaits.policy.evaluation import evaluate
from locomotion.gaits.policy.law import (
    ACCELERATION,
    ALL_BUT,
    ALL_CALM,
    AT_REST,
    BEARING,
    BEARS,
    BEGINS_AT,
    BEGINS_WITHIN,
    BOTH_BEAR,
    BRAKING,
    CALM,
    CATCHES,
    CHANGE_SHARE,
    CREEPS,
    ENDS_TURNING,
    FACES_WITHIN,
    FACING,
    FASTEST_WALK,
    FEET_OFF,
    FIRST_STEPS,
    LAG_SHARE,
    LATER,
    LIFT_OFF,
    MOST_AHEAD,
    MOST_ASKEW,
    MOST_BEHIND,
    MOST_LATE,
    MOST_MISS,
    MOST_TWIST,
    PENDULUM,
    QUICKENS,
    QUICKENS_FROM,
    REACH,
    REST_TRIM,
    REST_TRIM_ENDS,
    REST_TRIM_RATE,
    RUN_ACCELERATION,
    RUN_BRAKING,
    RUN_SIDEWAYS,
    RUN_TRIM,
    RUNS_FROM,
    SETTLES_AT,
    SETTLES_SLOWING,
    SETTLES_WITHIN,
    SETTLING,
    SHIFTING,
    SHOWN_AHEAD,
    SHOWN_WITHIN,
    SLOWEST_RUN,
    SOLE_AHEAD,
    SOLE_ASIDE,
    STEADY,
    STRAIGHT,
    TRIM_IN_USE,
    TRIM_RATE,
    TURNING,
    UNWINDS,
)
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["Parts", "decide_tick", "feel", "feet_yaw", "new_memory"]

_N = len(at.JOINTS)
_COLUMNS = np.array([JOINT_NAMES.index(name) for name in at.JOINTS])
_HELD = np.array([k for k, name in enumerate(JOINT_NAMES) if name not in at.JOINTS])
_TURNS, _SPREADS, _LEANS = _COLUMNS[at.HIP_ROTATIONS], _COLUMNS[at.SPREADING], _COLUMNS[at.LEANING]
_ASIDE = np.array(at.ARMS_ASIDE)
_SWINGS = np.array([k in at.SWINGING for k in range(_N)])
_BENDS = JOINT_NAMES.index("neck_pitch")
_SOLE_POINTS = np.array([*at.ANKLE_SOLE, at.TIP])
_ACTION, _PACE = at.ACTION.start, at.ACTION.stop - 1
_FORCES = at.FORCES.start
_UP, _VELOCITY, _SPIN = at.GRAVITY_UP.start, at.VELOCITY.start, at.SPIN.start
_LAGS, _ANGLES, _RATES, _RISE = at.LAGS.start, at.ANGLES.start, at.RATES.start, at.FEET_RISE.start
_AHEAD, _LEFT, _CONTACTS = at.FEET_AHEAD.start, at.FEET_LEFT.start, at.CONTACTS.start
_TIMING, _ASKED = at.TIMING.start, at.ASKED.start


class Parts:
    """Where a person's feet are in a model: ``bodies`` (4,) int64, ids of foot and toes, right and left;
    ``geoms`` (ngeom,) int8, 1 to 4 for what belongs to them, else 0."""

    def __init__(self, index: PersonIndex, model: mujoco.MjModel) -> None:
        names = [f"{side}_{part}" for side in ("right", "left") for part in ("foot", "toes")]
        self.bodies = np.array([index.bodies[name] for name in names])
        self.geoms = np.zeros(model.ngeom, np.int8)
        for k, body in enumerate(self.bodies):
            self.geoms[model.geom_bodyid == body] = k + 1


def new_memory(yaw: float) -> NDArray[np.float64]:
    """The memory of a person who stands and faces ``yaw`` [rad]; the left foot lifts off first."""
    memory = np.zeros(at.STATE_SIZE)
    memory[at.PHASE], memory[at.HEADING] = LIFT_OFF, yaw
    return memory


@kernel
def _wrap(angle):
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


@kernel
def _yaw(qpos):
    w, x, y, z = qpos[3], qpos[4], qpos[5], qpos[6]
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


@kernel
def feet_yaw(felt):
    """Where both feet together point [rad]; ``felt`` (FELT_SIZE,)."""
    x, y = 0.0, 0.0
    for side in range(2):  # from the heel to the ball
        x += felt[9 * side + 3] - felt[9 * side]
        y += felt[9 * side + 4] - felt[9 * side + 1]
    return math.atan2(y, x)


@kernel
def _row(speeds, speed):
    """The row of ``speeds`` at or below ``speed``, and how far it is to the next."""
    last = speeds.shape[0] - 1
    v = min(max(speed, speeds[0]), speeds[last])
    i = 0
    while i < last - 1 and v >= speeds[i + 1]:
        i += 1
    return i, (v - speeds[i]) / (speeds[i + 1] - speeds[i])


@kernel
def _shown_speed(memory):
    speed = memory[at.SPEED]
    if not memory[at.FAST] > 0.0:
        return min(speed, FASTEST_WALK)
    body = speed + memory[at.LAG_AHEAD]
    ahead = min(max(SHOWN_AHEAD * body, SHOWN_WITHIN), SHOWN_AHEAD)
    return min(max(speed, body - SHOWN_WITHIN), body + ahead)


@kernel
def _cycles_per_second(speeds, periods, memory):
    """How fast the cycle goes on [1/s], how fast it usually would, and how much faster that is than the
    reference's."""
    i, a = _row(speeds, _shown_speed(memory))
    quicker = 1.0 + memory[at.STEP_RATE]
    if memory[at.FAST] == 0.0:
        quicker += QUICKENS * max(memory[at.TOLD] - QUICKENS_FROM, 0.0)
    usual = quicker / ((1.0 - a) * periods[i] + a * periods[i + 1])
    share = min(max(1.0 + at.RATE_GAIN * memory[_PACE], at.SLOW_RATE), at.FAST_RATE)
    return share * usual * memory[at.RUNNING], usual, quicker


@kernel
def _stands(stance, memory, felt, qpos, qvel):
    """Whether the person may begin to stand, and whether one that stands has to make a step."""
    c, s = math.cos(memory[at.HEADING]), math.sin(memory[at.HEADING])
    x, y = qvel[0] / PENDULUM, qvel[1] / PENDULUM
    off_ahead, off_left, apart_ahead, apart_left = -stance[0], 0.0, 0.0, 0.0
    for side in range(2):
        dx = 0.5 * (felt[9 * side] + felt[9 * side + 3]) - qpos[0]
        dy = 0.5 * (felt[9 * side + 1] + felt[9 * side + 4]) - qpos[1]
        ahead, left = c * dx + s * dy, c * dy - s * dx
        sign = 1.0 if side == 1 else -1.0
        apart_ahead, apart_left = apart_ahead + sign * ahead, apart_left + sign * left
        off_ahead, off_left = off_ahead + 0.5 * ahead, off_left + 0.5 * left
    off_ahead, off_left = off_ahead - (c * x + s * y), off_left - (c * y - s * x)
    miss = math.hypot(off_ahead / SOLE_AHEAD, off_left / (0.5 * max(apart_left, 0.0) + SOLE_ASIDE))
    right, left = felt[_FORCES] + felt[_FORCES + 1], felt[_FORCES + 2] + felt[_FORCES + 3]
    speed = math.hypot(memory[at.LAG_AHEAD] + memory[at.SPEED], memory[at.LAG_LEFT])
    bears = min(right, left) > BEARS * at.BODY_WEIGHT
    if bears:
        can = speed < CALM and miss < MOST_MISS
    else:
        can = speed < ALL_CALM and miss < ALL_BUT and memory[at.RESTED] > CATCHES
    can = can and abs(memory[at.TURN_RATE]) < FACING
    can = can and abs(apart_ahead) < FEET_OFF[0] and abs(apart_left - stance[1]) < FEET_OFF[1]
    return can, miss > REACH, left > right


@kernel
def _advance(speeds, periods, stance, memory, asked, felt, qpos, qvel):
    pace, _, _ = _cycles_per_second(speeds, periods, memory)
    before, running = memory[at.PHASE], memory[at.RUNNING] > 0.0
    after = before + at.POLICY_DT * pace
    to_stand = asked[at.ASKED_SPEED] < AT_REST and abs(asked[at.ASKED_TURN]) < FACING
    rests = memory[at.TOLD] < AT_REST and to_stand
    can, must, on_left = _stands(stance, memory, felt, qpos, qvel)
    steps = must and not running
    rested = memory[at.RESTED] + at.POLICY_DT
    memory[at.RESTED] = rested if rests and not steps else min(rested, 0.0)
    if not (running or rests or must):
        memory[at.RESTED] = -FIRST_STEPS
    begun = 0.5 * math.floor(2.0 * after)
    both = running and BOTH_BEAR < after - begun <= LIFT_OFF
    if both and memory[at.RESTED] > SETTLING and can:
        after = begun + LIFT_OFF
        memory[at.RUNNING] = 0.0
        memory[at.LAG_AHEAD] += memory[at.SPEED]
    elif steps or not rests:
        memory[at.RUNNING] = 1.0
        if steps:  # with the foot that bears less
            after = LIFT_OFF + (0.5 if on_left else 0.0)
        elif not running:
            after -= SHIFTING
    memory[at.PHASE] = after - math.floor(after)
    yaw = _yaw(qpos)
    off = _wrap(yaw - memory[at.HEADING] - at.POLICY_DT * memory[at.TURN_RATE])
    memory[at.HEADING] = _wrap(yaw - min(max(off, -MOST_TWIST), MOST_TWIST))
    c, s = math.cos(memory[at.HEADING]), math.sin(memory[at.HEADING])
    ahead, left = c * qvel[0] + s * qvel[1], c * qvel[1] - s * qvel[0]
    fast, told = memory[at.FAST] > 0.0, memory[at.TOLD]
    ends = fast and asked[at.ASKED_SPEED] < SLOWEST_RUN
    wanted = (SLOWEST_RUN if ends else asked[at.ASKED_SPEED]) - told
    if memory[at.RESTED] < 0.0:
        wanted = 0.0
    lag, steady = memory[at.LAG_AHEAD] + memory[at.TRIM], abs(wanted) < STEADY
    off = min(MOST_BEHIND + LATER * told, MOST_LATE) if fast else MOST_BEHIND
    if lag < -off or (not fast and abs(_wrap(yaw - memory[at.HEADING])) > FACES_WITHIN):
        wanted = min(wanted, 0.0)
    slower, faster = BRAKING, ACCELERATION
    if fast:
        share = (told - RUN_BRAKING[1]) / (RUN_BRAKING[2] - RUN_BRAKING[1])
        slower += min(max(share, 0.0), 1.0) * (RUN_BRAKING[0] - BRAKING)
        slower *= 1.0 - min(max(lag / MOST_AHEAD, 0.0), 1.0)
        faster = RUN_ACCELERATION
    change = min(max(wanted, -slower * at.POLICY_DT), faster * at.POLICY_DT)
    memory[at.TOLD] += change
    memory[at.CHANGE] += CHANGE_SHARE * (change / at.POLICY_DT - memory[at.CHANGE])
    slow = min(max(1.0 - memory[at.TOLD] / REST_TRIM_ENDS, 0.0), 1.0) * memory[at.RUNNING]
    creeps = math.hypot(memory[at.LAG_AHEAD] + memory[at.SPEED], memory[at.LAG_LEFT]) < CREEPS
    creeps = creeps or memory[at.RESTED] > CATCHES
    turns = abs(memory[at.TURN_RATE]) > FACING
    slow = slow if asked[at.ASKED_SPEED] < AT_REST and (creeps or turns) else 0.0
    pull = TRIM_RATE + slow * (REST_TRIM_RATE - TRIM_RATE)
    trim = memory[at.TRIM] + pull * at.POLICY_DT * (memory[at.TOLD] - ahead)
    if fast and not steady:
        trim = memory[at.TRIM] * (1.0 - UNWINDS)
    most = (RUN_TRIM if fast else TRIM_IN_USE) * max(memory[at.TOLD], 0.0) + slow * REST_TRIM
    memory[at.TRIM] = min(max(trim, -most), most)
    memory[at.SPEED] = memory[at.TOLD] + memory[at.TRIM]
    runs_on = asked[at.ASKED_SPEED] > RUNS_FROM
    straight, off = abs(memory[at.TURN_RATE]) < STRAIGHT, max(abs(lag), abs(memory[at.LAG_LEFT]))
    settled = straight and off < SETTLES_WITHIN
    settled = settled and memory[at.TOLD] < (SETTLES_AT if steady else SETTLES_SLOWING)
    begins = runs_on and straight and memory[at.TOLD] > BEGINS_AT and off < BEGINS_WITHIN
    goes_on = begins or (fast and (runs_on or not settled))
    memory[at.FAST] = 1.0 if goes_on and memory[at.RUNNING] > 0.0 else 0.0
    turn = 0.0 if rests else asked[at.ASKED_TURN]
    if fast:
        tightest = RUN_SIDEWAYS / max(memory[at.SPEED] + memory[at.LAG_AHEAD], SLOWEST_RUN)
        tightest = min(tightest, ENDS_TURNING) if ends else tightest
        turn = min(max(turn, -tightest), tightest)
    most = TURNING * at.POLICY_DT
    memory[at.TURN_RATE] += min(max(turn - memory[at.TURN_RATE], -most), most)
    memory[at.LAG_AHEAD] += LAG_SHARE * (ahead - memory[at.SPEED] - memory[at.LAG_AHEAD])
    memory[at.LAG_LEFT] += LAG_SHARE * (left - memory[at.LAG_LEFT])


@kernel
def _observe(memory, felt, qpos, qvel, out):
    """What the policy observes, not mirrored, into ``out``."""
    c, s = math.cos(memory[at.HEADING]), math.sin(memory[at.HEADING])
    w, x, y, z = qpos[3], qpos[4], qpos[5], qpos[6]
    out[at.HEIGHT_SEEN] = qpos[2] - memory[at.FLOOR]
    out[_UP] = 2 * (x * z - w * y)
    out[_UP + 1] = 2 * (y * z + w * x)
    out[_UP + 2] = 1 - 2 * (x * x + y * y)
    out[_VELOCITY] = c * qvel[0] + s * qvel[1]
    out[_VELOCITY + 1] = c * qvel[1] - s * qvel[0]
    out[_VELOCITY + 2] = qvel[2]
    for k in range(3):
        out[_SPIN + k] = qvel[3 + k]
    out[at.YAW_SEEN] = _wrap(_yaw(qpos) - memory[at.HEADING])
    out[_LAGS], out[_LAGS + 1] = memory[at.LAG_AHEAD], memory[at.LAG_LEFT]
    for k in range(_N):
        out[_ANGLES + k] = qpos[7 + _COLUMNS[k]]
        out[_RATES + k] = 0.1 * qvel[6 + _COLUMNS[k]]
    for k in range(_ASIDE.shape[0]):
        out[_ANGLES + _ASIDE[k]] -= kept_off_one(memory)
    for k in range(6):
        out[_RISE + k] = felt[3 * k + 2] - qpos[2]
    for k in range(2):
        dx, dy = felt[9 * k] - qpos[0], felt[9 * k + 1] - qpos[1]
        out[_AHEAD + k] = c * dx + s * dy
        out[_LEFT + k] = c * dy - s * dx
    for k in range(4):
        out[_CONTACTS + k] = math.tanh(3.0 / at.BODY_WEIGHT * felt[_FORCES + k])
    running = memory[at.RUNNING]
    angle = 2.0 * math.pi * (memory[at.PHASE] - (0.5 if memory[at.PHASE] >= 0.5 else 0.0))
    out[_TIMING], out[_TIMING + 1] = running * math.sin(angle), running * math.cos(angle)
    out[_TIMING + 2], out[_TIMING + 3] = running * math.sin(2 * angle), running * math.cos(2 * angle)
    out[_TIMING + 4] = running
    out[_ASKED], out[_ASKED + 1] = memory[at.SPEED], memory[at.TURN_RATE]
    out[at.CHANGE_SEEN] = memory[at.CHANGE]


@kernel
def _behind(share):
    """How far a foot of a body that turns by 1 a cycle is turned from it, at a ``share`` of its own cycle."""
    if share < BEARING:
        return 0.5 * BEARING - share
    return BEARING * ((share - BEARING) / (1.0 - BEARING) - 0.5)


@kernel
def _targets(speeds, periods, joints, rates, means, memory, ctrl):
    """Targets of all joints until the next decision, into ``ctrl`` (39,)."""
    pace, usual, quicker = _cycles_per_second(speeds, periods, memory)
    i, a = 0, 0.0  # the stand
    if memory[at.RUNNING] > 0.0:
        i, a = _row(speeds, _shown_speed(memory))
        i += 1
    share = memory[at.PHASE] + 0.5 * at.POLICY_DT * pace
    samples = joints.shape[1]
    x = (share - math.floor(share)) * samples
    low = int(x)
    b = x - low
    j = low % samples
    k = (j + 1) % samples
    lead = at.LEAD * pace / usual * quicker
    w00, w01, w10, w11 = (1.0 - a) * (1.0 - b), (1.0 - a) * b, a * (1.0 - b), a * b
    for n in range(_N):
        angle = (
            w00 * joints[i, j, n]
            + w01 * joints[i, k, n]
            + w10 * joints[i + 1, j, n]
            + w11 * joints[i + 1, k, n]
        )
        moving = (
            w00 * rates[i, j, n] + w01 * rates[i, k, n] + w10 * rates[i + 1, j, n] + w11 * rates[i + 1, k, n]
        )
        angle += lead * moving
        decided = at.SCALE[n] * memory[_ACTION + n]
        if _SWINGS[n]:
            angle += memory[at.ARM_SWING] * (angle - (1.0 - a) * means[i, n] - a * means[i + 1, n])
            decided *= 1.0 + memory[at.ARM_SWING]
        ctrl[_COLUMNS[n]] = angle + decided
    for n in range(_HELD.shape[0]):
        ctrl[_HELD[n]] = 0.0
    for k in range(_SPREADS.shape[0]):
        ctrl[_SPREADS[k]] += memory[at.SPREAD]
    ctrl[_LEANS] += memory[at.TRUNK_LEAN]
    ctrl[_BENDS] = memory[at.HEAD_BEND]
    turn = memory[at.TURN_RATE] * memory[at.RUNNING] / usual
    phase = memory[at.PHASE] + (0.5 * at.POLICY_DT + at.LEAD) * pace
    correct_one(memory, _shown_speed(memory), phase, ctrl)
    for side in range(2):
        share = phase + 0.5 * side
        foot = min(max(turn * _behind(share - math.floor(share)), -MOST_ASKEW), MOST_ASKEW)
        ctrl[_TURNS[side]] += foot if side == 0 else -foot


@allocating_kernel
def _decide(network, seen, mirrored, memory):
    """What the ``network`` decides, into ``memory``."""
    observed, decided = np.empty(at.INPUTS), np.empty(at.ACTIONS, np.float32)
    for k in range(at.INPUTS):
        observed[k] = seen[at.MIRROR_OBSERVED[k]] * at.SIGN_OBSERVED[k] if mirrored else seen[k]
    evaluate(network, observed, decided)
    for k in range(at.ACTIONS):
        memory[_ACTION + k] = decided[at.MIRROR_ACTION[k]] * at.SIGN_ACTION[k] if mirrored else decided[k]


@allocating_kernel
def decide_tick(motion, walk, stand, run, memory, asked, felt, qpos, qvel, ctrl):
    """Decide, and write the targets ``ctrl`` (39,) [rad] to hold for `layout.POLICY_DT`.

    motion: the arrays of `locomotion.gaits.policy.motion.Motion`. walk, stand, run: the networks of a person
    who walks, stands and runs: mean and deviation (83,) of the inputs, and weights and biases of three
    layers, float32. The rest: see above.
    """
    speeds, periods, joints, rates, stance, means = motion
    if memory[at.STARTED] > 0.0:
        _advance(speeds, periods, stance, memory, asked, felt, qpos, qvel)
    memory[at.STARTED] = 1.0
    seen = np.empty(at.INPUTS)
    _observe(memory, felt, qpos, qvel, seen)
    mirrored = memory[at.PHASE] >= 0.5
    if memory[at.FAST] > 0.0:
        _decide(run, seen, mirrored, memory)
    elif memory[at.RUNNING] > 0.0:
        _decide(walk, seen, mirrored, memory)
    else:
        _decide(stand, seen, mirrored, memory)
    _targets(speeds, periods, joints, rates, means, memory, ctrl)


@kernel
def _feel(places, frames, bodies, ncon, pairs, addresses, forces, geoms, points, felt):
    for side in range(2):
        for k in range(3):
            body = bodies[2 * side + (1 if k == 2 else 0)]
            for row in range(3):
                value = places[body, row]
                for column in range(3):
                    value += frames[body, 3 * row + column] * points[k, column]
                felt[9 * side + 3 * k + row] = value
    for k in range(4):
        felt[_FORCES + k] = 0.0
    for c in range(ncon):
        part = geoms[pairs[c, 0]] + geoms[pairs[c, 1]]
        if part > 0 and addresses[c] >= 0:
            for k in range(4):
                felt[_FORCES + part - 1] += forces[addresses[c] + k]


def feel(parts: Parts, data: mujoco.MjData, felt: NDArray[np.float64]) -> None:
    """Read soles and forces of ``data`` into ``felt``, right after a physics step."""
    pairs, addresses = contacts_of(data)
    _feel(
        data.xpos, data.xmat, parts.bodies, data.ncon, pairs, addresses, data.efc_force,
        parts.geoms, _SOLE_POINTS, felt,
    )  # fmt: skip
