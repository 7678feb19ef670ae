"""What a policy observes, what its decisions do and how its memory goes on, for many people at once.

This is the plain form, which learning uses; `locomotion.gaits.policy.kernel` is the compiled one. In turn,
for each decision::

    observed = observe(memory, seen)
    ... the network decides, `decide` keeps it ...
    targets(memory, motion)              # held by the servos for POLICY_DT
    ... physics ...
    advance(memory, motion, asked, seen)
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.gaits.policy.corrections import corrections, kept_off
from locomotion.gaits.policy.layout import (
    ACTION,
    ANGLES,
    ARM_SWING,
    ARMS_ASIDE,
    ASKED,
    ASKED_SPEED,
    ASKED_TURN,
    BODY_WEIGHT,
    CHANGE,
    CHANGE_SEEN,
    CONTACTS,
    FAST,
    FAST_RATE,
    FEET_AHEAD,
    FEET_LEFT,
    FEET_RISE,
    FLOOR,
    GRAVITY_UP,
    HEADING,
    HEELS_AND_BALLS,
    HEIGHT_SEEN,
    HIP_ROTATIONS,
    INPUTS,
    LAG_AHEAD,
    LAG_LEFT,
    LAGS,
    LEAD,
    LEANING,
    MIRROR_ACTION,
    MIRROR_OBSERVED,
    PHASE,
    POLICY_DT,
    RATE_GAIN,
    RATES,
    RESTED,
    RUNNING,
    SCALE,
    SIGN_ACTION,
    SIGN_OBSERVED,
    SLOW_RATE,
    SPEED,
    SPIN,
    SPREAD,
    SPREADING,
    STARTED,
    STEP_RATE,
    SWINGING,
    TIMING,
    TOLD,
    TRIM,
    TRUNK_LEAN,
    TURN_RATE,
    VELOCITY,
    YAW_SEEN,
)
from locomotion.gaits.policy.motion import Motion

__all__ = [
    "ACCELERATION", "ALL_BUT", "ALL_CALM", "AT_REST", "BEARING", "BEARS", "BEGINS_AT", "BEGINS_WITHIN",
    "BOTH_BEAR", "BRAKING", "CALM", "CATCHES", "CHANGE_SHARE", "CREEPS", "ENDS_TURNING", "FACES_WITHIN",
    "FACING", "FASTEST_WALK", "FEET_OFF", "FIRST_STEPS", "LAG_SHARE", "LATER", "LIFT_OFF",
    "MOST_AHEAD", "MOST_ASKEW", "MOST_BEHIND", "MOST_LATE", "MOST_MISS", "MOST_TRIM", "MOST_TWIST",
    "PENDULUM", "QUICKENS", "QUICKENS_FROM", "REACH", "REST_TRIM", "REST_TRIM_ENDS", "REST_TRIM_RATE",
    "RUNS_FROM", "RUN_ACCELERATION", "RUN_BRAKING", "RUN_SIDEWAYS", "RUN_TRIM", "SETTLES_AT",
    "SETTLES_SLOWING", "SETTLES_WITHIN", "SETTLING", "SHIFTING", "SHOWN_AHEAD", "SHOWN_WITHIN",
    "SLOWEST_RUN", "SOLE_AHEAD", "SOLE_ASIDE", "STEADY", "STRAIGHT", "TRIM_IN_USE", "TRIM_RATE",
    "TURNING", "UNWINDS", "Seen", "advance", "along", "decide", "mirrored", "observe", "own_period",
    "pace_share", "rate", "shown_speed", "standing_miss", "styled", "targets", "turned_feet", "turned_in",
    "up_and_yaw", "wrap",
]  # fmt: skip

ACCELERATION, BRAKING, TURNING = 1.0, 0.8, 2.0
"""[m/s^2] up and down, and [rad/s^2], at which speed and turn rate follow those asked for."""
RUN_ACCELERATION = 2.2
"""[m/s^2] with which the speed told rises while a person runs."""
RUN_BRAKING, MOST_AHEAD = (3.6, 0.7, 2.2), 1.0
"""[m/s^2] with which the speed told falls while a person runs, above the third number [m/s]; below that it
falls more slowly, at the second number as slowly as `BRAKING`. The faster the body is than told, the more
slowly it falls, too, and from `MOST_AHEAD` [m/s] on not at all."""
SLOWEST_RUN, ENDS_TURNING, RUN_SIDEWAYS = 1.1, 0.57, 1.6
"""[m/s] that a running person is told at least: the walk takes over there. [rad/s] that it turns at most
while it slows down for that, and [m/s^2] in any bend."""
SHOWN_WITHIN, SHOWN_AHEAD = 0.4, 0.8
"""[m/s] by which the reference motion of a run may be slower or faster than the body: nobody who still runs
is shown how to walk. While the body speeds up from 0.5 to 1 m/s, the motion may be ahead by more and more, up
to the second number: a person that speeds up is shown how to run, not what lies between walk and run."""
MOST_LATE, LATER, RUN_TRIM, UNWINDS = 0.8, 0.25, 0.12, 0.03
"""While a person runs, the speed told waits for a body that is slower by more than `MOST_BEHIND` and the
share `LATER` of the speed, but at most `MOST_LATE` [m/s]. What is added to the speed told is at most the
share `RUN_TRIM` of it, and grows only at the speed asked for; otherwise it shrinks by the share `UNWINDS`
with each decision."""
FASTEST_WALK, RUNS_FROM = 2.3, 2.05
"""[m/s] of the fastest reference motion for a walk; and the speed asked for, above which a person runs."""
QUICKENS_FROM, QUICKENS = 1.5, 0.3
"""[m/s] told, above which a walk's cycle goes on faster than the reference's, and by which share per m/s: the
network alone takes too few steps there, and is too slow."""
BEGINS_AT, BEGINS_WITHIN, STRAIGHT = 1.0, 0.4, 0.6
"""[m/s] told, from which a run begins, if the body keeps to it within so much, and [rad/s] that it turns at
most then."""
SETTLES_AT, SETTLES_SLOWING, SETTLES_WITHIN, STEADY = 1.7, 1.2, 0.25, 0.05
"""[m/s] told, up to which a run ends if that is what is asked for, and if more or less is; the body keeps to
it within so much, and turns no more than that; and how far from what is asked counts as that."""
TRIM_RATE, MOST_TRIM, TRIM_IN_USE = 0.5, 0.15, 0.4
"""Part of the error of the speed that is added to it, per second, and the share of the speed that is added at
most, first while the policy is learned, then in worlds."""
REST_TRIM, REST_TRIM_RATE, REST_TRIM_ENDS = 0.35, 1.5, 0.4
"""While a person steps in place before it stands: most that is added to the speed told [m/s], so that it does
not creep away; its rate; and the speed told [m/s] from which on nothing is added."""
CREEPS, CATCHES = 0.1, 1.5
"""[m/s] low-passed, up to which a body creeps, and [s] of steps in place after which a faster one does, too.
A body that a push has just made fast is not told to walk against it: it would set its feet down on the wrong
side."""
MOST_TWIST, MOST_BEHIND = 0.45, 0.4
"""[rad] that the heading is off the body's at most: it waits for a body that does not turn as told, and
follows one that is thrown round. [m/s] that the body, low-passed, may be too slow; beyond that the speed
told does not rise."""
FACES_WITHIN = 0.3
"""[rad] that a body that walks may face off its heading; beyond that the speed told does not rise."""
AT_REST = 0.05
"""[m/s] asked for, below which a person comes to rest."""
FACING = 0.05
"""[rad/s] asked for, below which a person need not turn, and may come to rest."""
BEARING, MOST_ASKEW = 0.62, 0.45
"""Share of the cycle in which a foot stays where it is while the body turns over it, and [rad] that it is
turned from the body at most."""
SETTLING = 0.4
"""[s] of steps in place before it stands."""
FIRST_STEPS = 0.7
"""[s] that it steps in place when it sets off from a stand, whose feet may be anywhere."""
CALM = 0.2
"""[m/s] low-passed, below which it may stand, if also:"""
BEARS, FEET_OFF = 0.12, (0.1, 0.13)
"""each foot bears this share of the weight, and is this near to where it stands: [m] ahead and aside."""
MOST_MISS, REACH = 0.8, 1.1
"""Where the body would come to rest, as a share of how far the feet reach: up to which it may begin to stand,
and above which a person that stands makes a step."""
ALL_CALM, ALL_BUT = 0.1, 0.5
"""The same limits of [m/s] and share for one of whose feet is above the ground, after `CATCHES` of steps."""
PENDULUM = 3.3
"""[1/s] of a standing body: it comes to rest this part of a second's way ahead."""
SOLE_AHEAD, SOLE_ASIDE = 0.1, 0.03
"""[m] from the middle of a sole that it reaches."""
BOTH_BEAR, LIFT_OFF = 0.04, 0.12
"""Shares of the cycle from which both feet bear, so that the cycle may stop, and at which the left foot lifts
off; the right one half a cycle later."""
SHIFTING = 0.14
"""Share of the cycle before that at which it goes on: first the weight goes over to the other foot."""
LAG_SHARE = 0.08
"""Share of the error of the speed that its low-passed value takes up with each decision."""
CHANGE_SHARE = 0.15
"""The same share for how fast the speed told changes."""


@dataclass(frozen=True)
class Seen:
    """The bodies of n people; all float64.

    Attributes:
      qpos, qvel: (n, 7 or more), (n, 6 or more), MuJoCo's, of which only the root is read.
      angles, rates: (n, 24) of `layout.JOINTS`.
      soles: (n, 6, 3) places of `layout.SOLE_POINTS` in the world [m].
      forces: (n, 4) normal forces under foot and toes, right and left [N].
    """

    qpos: NDArray[np.float64]
    qvel: NDArray[np.float64]
    angles: NDArray[np.float64]
    rates: NDArray[np.float64]
    soles: NDArray[np.float64]
    forces: NDArray[np.float64]


def wrap(angle: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles in [-π, π)."""
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def along(heading: NDArray[np.float64], vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """``vectors`` (n, ..., 3) of the world, ahead, to the left and up from the ``heading`` (n,)."""
    shape = (-1,) + (1,) * (vectors.ndim - 2)
    c, s = np.cos(heading).reshape(shape), np.sin(heading).reshape(shape)
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([c * x + s * y, c * y - s * x, vectors[..., 2]], axis=-1)


def up_and_yaw(qpos: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The world's up in the root's frame (n, 3), and the root's yaw (n,) [rad]."""
    w, x, y, z = qpos[:, 3:7].T
    up = np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=1)
    return up, np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def mirrored(memory: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which people are in the second half of the cycle, (n,)."""
    return memory[:, PHASE] >= 0.5


def observe(memory: NDArray[np.float64], seen: Seen) -> NDArray[np.float64]:
    """What the policy observes, (n, INPUTS), mirrored in the second half of the cycle."""
    out = np.empty((len(memory), INPUTS))
    heading = memory[:, HEADING]
    up, yaw = up_and_yaw(seen.qpos)
    out[:, HEIGHT_SEEN], out[:, GRAVITY_UP] = seen.qpos[:, 2] - memory[:, FLOOR], up
    out[:, VELOCITY], out[:, SPIN] = along(heading, seen.qvel[:, :3]), seen.qvel[:, 3:6]
    out[:, YAW_SEEN] = wrap(yaw - heading)
    out[:, LAGS] = memory[:, [LAG_AHEAD, LAG_LEFT]]
    out[:, ANGLES], out[:, RATES] = seen.angles, 0.1 * seen.rates
    out[:, ANGLES][:, ARMS_ASIDE] -= kept_off(memory)
    soles = along(heading, seen.soles - seen.qpos[:, None, :3])
    out[:, FEET_RISE], out[:, FEET_AHEAD], out[:, FEET_LEFT] = (
        soles[:, :, 2],
        soles[:, ::3, 0],
        soles[:, ::3, 1],
    )
    out[:, CONTACTS] = np.tanh(3.0 / BODY_WEIGHT * seen.forces)
    half = mirrored(memory)
    angle = 2.0 * np.pi * (memory[:, PHASE] - 0.5 * half)
    waves = np.stack(
        [np.sin(angle), np.cos(angle), np.sin(2 * angle), np.cos(2 * angle), np.ones(len(memory))], axis=1
    )
    out[:, TIMING] = waves * memory[:, RUNNING, None]
    out[:, ASKED], out[:, CHANGE_SEEN] = memory[:, [SPEED, TURN_RATE]], memory[:, CHANGE]
    out[half] = out[half][:, MIRROR_OBSERVED] * SIGN_OBSERVED
    return out


def decide(memory: NDArray[np.float64], decided: NDArray[np.floating]) -> None:
    """Remember what the network ``decided`` (n, ACTIONS), in the person's own left and right."""
    action = decided.astype(np.float64)
    half = mirrored(memory)
    action[half] = action[half][:, MIRROR_ACTION] * SIGN_ACTION
    memory[:, ACTION] = action


def pace_share(memory: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of the usual pace of the cycle, as decided, (n,)."""
    return np.clip(1.0 + RATE_GAIN * memory[:, ACTION.stop - 1], SLOW_RATE, FAST_RATE)


def shown_speed(memory: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) [m/s]: the speed at which the reference motion is read."""
    speed = memory[:, SPEED]
    body = speed + memory[:, LAG_AHEAD]
    ahead = np.clip(SHOWN_AHEAD * body, SHOWN_WITHIN, SHOWN_AHEAD)
    near = np.clip(speed, body - SHOWN_WITHIN, body + ahead)
    return np.where(memory[:, FAST] > 0.0, near, np.minimum(speed, FASTEST_WALK))


def own_period(memory: NDArray[np.float64], motion: Motion) -> NDArray[np.float64]:
    """[s] of a cycle of each person at its usual pace, (n,)."""
    fast = np.where(memory[:, FAST] > 0.0, 0.0, np.maximum(memory[:, TOLD] - QUICKENS_FROM, 0.0))
    quicker = 1.0 + memory[:, STEP_RATE] + QUICKENS * fast
    return motion.period(shown_speed(memory)) / quicker


def rate(memory: NDArray[np.float64], period: NDArray[np.float64]) -> NDArray[np.float64]:
    """Cycles per second, (n,), where one usually takes ``period`` [s]."""
    return pace_share(memory) / period * memory[:, RUNNING]


def targets(memory: NDArray[np.float64], motion: Motion) -> NDArray[np.float64]:
    """Target angles (n, 24) of `layout.JOINTS` [rad] until the next decision."""
    speed = shown_speed(memory)
    period = own_period(memory, motion)
    pace = rate(memory, period)
    middle = motion.at(memory[:, PHASE] + 0.5 * POLICY_DT * pace, speed, memory[:, RUNNING])
    usual = motion.period(speed) * pace  # the reference's rates are those of its own pace
    moving = middle.read(motion.rates) * usual[:, None]
    found = styled(memory, middle.read(motion.joints) + LEAD * moving, middle.read_rows(motion.means))
    decided = SCALE * memory[:, ACTION.start : ACTION.stop - 1]
    decided[:, SWINGING] *= 1.0 + memory[:, ARM_SWING, None]
    found += decided
    phase = memory[:, PHASE] + (0.5 * POLICY_DT + LEAD) * pace
    found[:, HIP_ROTATIONS] += turned_in(turned_feet(memory, phase, period))
    return found + corrections(memory, speed, phase)


def styled(
    memory: NDArray[np.float64], joints: NDArray[np.float64], means: NDArray[np.float64]
) -> NDArray[np.float64]:
    """``joints`` (n, 24) [rad] of the motion in each person's own style; ``means`` (n, 24) over the cycle."""
    found = joints.copy()
    found[:, SWINGING] += memory[:, ARM_SWING, None] * (joints - means)[:, SWINGING]
    found[:, SPREADING] += memory[:, SPREAD, None]
    found[:, LEANING] += memory[:, TRUNK_LEAN]
    found[:, ARMS_ASIDE] += kept_off(memory)
    return found


def turned_feet(
    memory: NDArray[np.float64], phase: NDArray[np.float64], period: NDArray[np.float64]
) -> NDArray[np.float64]:
    """How far the right and the left foot are turned from a body that turns, (n, 2) [rad]: a bearing foot
    stays, a swinging one is turned to where the body will be. ``phase`` (n,) of the right foot."""
    share = (phase[:, None] + [0.0, 0.5]) % 1.0
    back = (share - BEARING) / (1.0 - BEARING)
    off = np.where(share < BEARING, 0.5 * BEARING - share, BEARING * (back - 0.5))
    turn = memory[:, TURN_RATE] * memory[:, RUNNING] * period
    return np.clip(turn[:, None] * off, -MOST_ASKEW, MOST_ASKEW)


def turned_in(feet: NDArray[np.float64]) -> NDArray[np.float64]:
    """Hip rotations, right and left, that turn the ``feet`` (n, 2) so far to the left, (n, 2) [rad]."""
    return feet * [1.0, -1.0]


def standing_miss(
    memory: NDArray[np.float64], motion: Motion, seen: Seen
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where the body would come to rest if it only stood, from the middle of the feet, as a share of how far
    they reach, (n,); and how far the feet are off their stance, ahead and aside, (n, 2) [m]."""
    heading = memory[:, HEADING]
    soles = along(heading, seen.soles[:, HEELS_AND_BALLS] - seen.qpos[:, None, :3])
    feet = soles.reshape(-1, 2, 2, 3).mean(axis=2)  # (n, right and left, 3)
    off = feet.mean(axis=1)[:, :2] - along(heading, seen.qvel[:, :3])[:, :2] / PENDULUM
    off[:, 0] -= motion.stance[0]
    apart = feet[:, 1, :2] - feet[:, 0, :2]
    reach = np.stack([np.full(len(off), SOLE_AHEAD), 0.5 * np.maximum(apart[:, 1], 0.0) + SOLE_ASIDE], axis=1)
    return np.hypot(*(off / reach).T), apart - [0.0, motion.stance[1]]


def _stands(
    memory: NDArray[np.float64], motion: Motion, seen: Seen
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Who may begin to stand, and who has to make a step, (n,)."""
    miss, off = standing_miss(memory, motion, seen)
    bears = seen.forces.reshape(-1, 2, 2).sum(axis=2).min(axis=1) > BEARS * BODY_WEIGHT
    speed = np.hypot(memory[:, LAG_AHEAD] + memory[:, SPEED], memory[:, LAG_LEFT])
    late = (speed < ALL_CALM) & (miss < ALL_BUT) & (memory[:, RESTED] > CATCHES)
    calm = np.where(bears, (speed < CALM) & (miss < MOST_MISS), late)
    calm &= np.abs(memory[:, TURN_RATE]) < FACING
    return calm & (np.abs(off) < FEET_OFF).all(axis=1), miss > REACH


def advance(
    memory: NDArray[np.float64],
    motion: Motion,
    asked: NDArray[np.float64],
    seen: Seen,
    halts: bool = True,
    steadies: bool = True,
    waits: bool = True,
) -> None:
    """Go on by `POLICY_DT`. ``asked`` (n, 2): speed [m/s] and turn rate [rad/s]; ``seen``: the bodies after
    it; ``halts``: whether the cycle stops for those who come to rest; ``steadies``: whether they are helped
    not to creep away in place and to keep their speed, most of which the policy is to learn by itself;
    ``waits``: whether the speed told waits for a body that is too slow."""
    pace = rate(memory, own_period(memory, motion))
    before, running = memory[:, PHASE], memory[:, RUNNING] > 0.0
    after = before + POLICY_DT * pace
    to_stand = (asked[:, ASKED_SPEED] < AT_REST) & (np.abs(asked[:, ASKED_TURN]) < FACING)
    rests = (memory[:, TOLD] < AT_REST) & to_stand
    can, must = _stands(memory, motion, seen)
    sets_off = np.minimum(memory[:, RESTED] + POLICY_DT, 0.0)
    rested = np.where(rests & (running | ~must), memory[:, RESTED] + POLICY_DT, sets_off)
    memory[:, RESTED] = np.where(~running & ~rests & ~must, -FIRST_STEPS, rested)
    begun = 0.5 * np.floor(2.0 * after)
    both = (after - begun > BOTH_BEAR) & (after - begun <= LIFT_OFF)
    stops = running & both & (memory[:, RESTED] > SETTLING) & can & halts
    after = np.where(stops, begun + LIFT_OFF, after)
    steps = ~running & must  # with the foot that bears less
    loads = seen.forces.reshape(-1, 2, 2).sum(axis=2)
    after = np.where(steps, LIFT_OFF + 0.5 * (loads[:, 1] > loads[:, 0]), after)
    after = np.where(~running & ~rests & ~steps, after - SHIFTING, after)
    memory[:, LAG_AHEAD] += np.where(stops, memory[:, SPEED], 0.0)
    memory[:, RUNNING] = np.where(stops, 0.0, np.where(rests & ~steps, memory[:, RUNNING], 1.0))
    memory[:, PHASE] = after - np.floor(after)
    heading, yaw = memory[:, HEADING] + POLICY_DT * memory[:, TURN_RATE], up_and_yaw(seen.qpos)[1]
    memory[:, HEADING] = wrap(yaw - np.clip(wrap(yaw - heading), -MOST_TWIST, MOST_TWIST))
    v = along(memory[:, HEADING], seen.qvel[:, :3])
    fast, told = memory[:, FAST] > 0.0, memory[:, TOLD]
    ends = fast & (asked[:, ASKED_SPEED] < SLOWEST_RUN)
    wanted = np.where(ends, SLOWEST_RUN, asked[:, ASKED_SPEED]) - told
    wanted = np.where(memory[:, RESTED] < 0.0, 0.0, wanted)
    lag = memory[:, LAG_AHEAD] + memory[:, TRIM] * steadies
    steady = np.abs(wanted) < STEADY
    off = np.where(fast, np.minimum(MOST_BEHIND + LATER * told, MOST_LATE), MOST_BEHIND)
    askew = np.abs(wrap(yaw - memory[:, HEADING])) > FACES_WITHIN
    behind = (waits & (lag < -off)) | (steadies & askew & ~fast)
    wanted = np.where(behind, np.minimum(wanted, 0.0), wanted)
    most, less, full = RUN_BRAKING
    runs = np.clip((told - less) / (full - less), 0.0, 1.0) * fast
    slower = BRAKING + runs * (most - BRAKING)
    slower *= 1.0 - np.clip(lag / MOST_AHEAD, 0.0, 1.0) * fast
    faster = np.where(fast, RUN_ACCELERATION, ACCELERATION)
    change = np.clip(wanted, -slower * POLICY_DT, faster * POLICY_DT)
    memory[:, TOLD] += change
    memory[:, CHANGE] += CHANGE_SHARE * (change / POLICY_DT - memory[:, CHANGE])
    slow = np.clip(1.0 - memory[:, TOLD] / REST_TRIM_ENDS, 0.0, 1.0) * memory[:, RUNNING]
    creeps = np.hypot(memory[:, LAG_AHEAD] + memory[:, SPEED], memory[:, LAG_LEFT]) < CREEPS
    creeps |= memory[:, RESTED] > CATCHES
    slow *= (asked[:, ASKED_SPEED] < AT_REST) & (creeps | (np.abs(memory[:, TURN_RATE]) > FACING)) & steadies
    pull = TRIM_RATE + slow * (REST_TRIM_RATE - TRIM_RATE)
    trim = memory[:, TRIM] + pull * POLICY_DT * (memory[:, TOLD] - v[:, 0])
    trim = np.where(fast & ~steady, memory[:, TRIM] * (1.0 - UNWINDS), trim)
    share = np.where(fast, RUN_TRIM, TRIM_IN_USE if steadies else MOST_TRIM)
    most = share * np.maximum(memory[:, TOLD], 0.0)
    memory[:, TRIM] = np.clip(trim, -most - slow * REST_TRIM, most + slow * REST_TRIM)
    memory[:, SPEED] = memory[:, TOLD] + memory[:, TRIM]
    goes_on, runs_on = memory[:, RUNNING] > 0.0, asked[:, ASKED_SPEED] > RUNS_FROM
    straight, aside = np.abs(memory[:, TURN_RATE]) < STRAIGHT, np.abs(memory[:, LAG_LEFT])
    settled = straight & (memory[:, TOLD] < np.where(steady, SETTLES_AT, SETTLES_SLOWING))
    settled &= np.maximum(np.abs(lag), aside) < SETTLES_WITHIN
    begins = runs_on & straight & (memory[:, TOLD] > BEGINS_AT)
    begins &= np.maximum(np.abs(lag), aside) < BEGINS_WITHIN
    memory[:, FAST] = goes_on & (begins | (fast & (runs_on | ~settled)))
    most = TURNING * POLICY_DT
    turn = np.where(rests, 0.0, asked[:, ASKED_TURN])
    tightest = RUN_SIDEWAYS / np.maximum(memory[:, SPEED] + memory[:, LAG_AHEAD], SLOWEST_RUN)
    tightest = np.where(ends, np.minimum(tightest, ENDS_TURNING), tightest)
    turn = np.where(fast, np.clip(turn, -tightest, tightest), turn)
    memory[:, TURN_RATE] += np.clip(turn - memory[:, TURN_RATE], -most, most)
    memory[:, LAG_AHEAD] += LAG_SHARE * (v[:, 0] - memory[:, SPEED] - memory[:, LAG_AHEAD])
    memory[:, LAG_LEFT] += LAG_SHARE * (v[:, 1] - memory[:, LAG_LEFT])
    memory[:, STARTED] = 1.0
