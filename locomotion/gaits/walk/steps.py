"""The steps of a walking person: what it was told, which feet bear it, when steps begin and end (numba)."""

import math

from locomotion.body.person import CONTROL_DT, JOINT_NAMES
from locomotion.gaits.walk.footholds import sway
from locomotion.gaits.walk.layout import (
    CLOCK,
    DOUBLE,
    FOOTHOLD,
    GAINS,
    LIFT,
    LIFT_NORMAL,
    LIFT_YAW,
    LONGER,
    MISSED,
    PHASE,
    SEEN_FEET,
    SEEN_SOLES,
    SETTING_OFF,
    SIDEWAYS,
    SINGLE,
    STANDING,
    STEP_MADE,
    STEPPED_AT,
    STEPPED_FROM,
    SUDDEN,
    SWING_ANGLES,
    SWING_TIME,
    TOLD,
    UNEVEN,
    USUAL_SPEED,
    WALK_HEADING,
    WALK_SPEED,
    WALK_STANCE,
    WALK_STEPS,
    WALK_TICKS,
    WALK_TRIM,
    WALK_TURN_RATE,
    clamp,
    pace_of,
    wrap,
)  # fmt: skip
from locomotion.paths.command import SIDEWAYS_ASKED, SPEED_ASKED
from surefoot.kernels import kernel

__all__ = ["TURN_RATE", "TURN_TIME", "advance_step", "begin_swing", "follow"]

_I = {name: i for i, name in enumerate(GAINS)}
_SWING, _TRANSFER = _I["swing_time"], _I["transfer_time"]
_MOST_MISSED = _I["most_missed"]
_TRIM_RATE, _MOST_TRIM = _I["trim_rate"], _I["most_trim"]
_SPOT, _LIFT, _LIFT_NORMAL, _ANGLES = FOOTHOLD.start, LIFT.start, LIFT_NORMAL.start, SWING_ANGLES.start
_SOLES, _FEET, _STEPPED = SEEN_SOLES.start, SEEN_FEET.start, STEPPED_FROM.start
_LONGER = LONGER.start
_R_HIP, _L_HIP = (JOINT_NAMES.index(f"{side}_hip_flexion") for side in ("right", "left"))
_TOUCH = 40.0  # [N] under the swing foot that end the step
_LANDING, _NEAR = 0.8, 0.12  # share of the swing after which, or [m] from its foothold where it may land
_OVERDUE = 0.12  # [s] after which a foot that has not landed is swung anew: the capture point has moved on
TURN_RATE = 1.2
"""[rad/s] at most, of one that is told at once to turn."""
TURN_TIME = 0.3
"""[s] in which it would turn to where it is told to."""
_TURNING = 0.6  # [m/s^2] sideways at most, as it turns
_SLOW_TURN = 0.4  # [m/s] below which that is no limit
_AT_ONCE = 0.15  # [rad] by which what it is told changes in a tick, if it is no bend
_IN_BENDS = 1.75  # [rad/s] at most in a bend, in which feet can be put aside in time
_TIGHT_BENDS = 0.8  # [m/s] up to which it turns like that
_NO_LONGER, _TOO_FAST = 1.0, 3.5  # [m/s] above which it does not; [rad/s] from which it goes slowly, too
_TURN_CHANGE = 6.0  # [rad/s^2]
_FASTER, _SLOWER, _SIDE_CHANGE = 0.8, 1.0, 0.5  # [m/s^2] of the reference speeds
_STILL, _STRAIGHT, _AWRY = 0.02, 0.2, 0.3  # [m/s], [rad] below which it stands; [rad] above which it sets off
_SLOW, _STOPPING = 0.1, 0.3  # [m/s] below which steps are corrected faster: share of their error in speed
_BENDS = 0.2  # [rad] off its way up to which a fast walk bends
_SETTLED = 0.05  # [m/s] of the reference speed below which it stands
_FOOTED = 0.5  # share of a sole's length on which it can stand
_TOES, _HEELS = 0.1, -0.08  # [m] ahead of the feet's middles between which the capture point can be held
_SIDES = 0.02  # [m] outside of the middle of a foot to which it can
_SET_OFF_LIMIT = 3.0  # [s] after which the first step is made regardless


@kernel
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


@kernel
def follow(walk, heading, speed, sideways):
    """Let the reference heading and speeds follow what is asked; gives what is left of the heading [rad]."""
    error = wrap(heading - walk[WALK_HEADING])
    if abs(wrap(heading - walk[TOLD])) > _AT_ONCE:
        walk[SUDDEN] = abs(error)
    walk[TOLD] = heading
    walk[SUDDEN] = max(min(walk[SUDDEN], abs(error)) - abs(walk[WALK_TURN_RATE]) * CONTROL_DT, 0.0)
    bends = walk[SUDDEN] == 0.0 and walk[UNEVEN] == 0.0
    pace, wanted = pace_of(walk), error / TURN_TIME
    if pace > USUAL_SPEED and abs(error) > _BENDS:
        speed = min(speed, USUAL_SPEED)
        if walk[STEP_MADE] > USUAL_SPEED:
            wanted = 0.0  # it slows down before it turns
        else:
            walk[WALK_SPEED] = pace = min(walk[WALK_SPEED], USUAL_SPEED)  # it has not become fast yet
    most = min(TURN_RATE, _TURNING / max(abs(pace), _SLOW_TURN))
    if bends:
        most = max(most, _IN_BENDS * clamp((_NO_LONGER - abs(pace)) / (_NO_LONGER - _TIGHT_BENDS), 0.0, 1.0))
    rate = clamp(wanted, -most, most)
    change = _TURN_CHANGE * CONTROL_DT
    walk[WALK_TURN_RATE] += clamp(rate - walk[WALK_TURN_RATE], -change, change)
    walk[WALK_HEADING] = wrap(walk[WALK_HEADING] + walk[WALK_TURN_RATE] * CONTROL_DT)
    # in a bend the capture point moves sideways: who turns fast goes slowly
    slower = max(_TURNING / max(abs(wanted), 1e-6), _SLOW_TURN)
    if bends:
        slower = max(
            slower, _TIGHT_BENDS * clamp((_TOO_FAST - abs(wanted)) / (_TOO_FAST - _IN_BENDS), 0.0, 1.0)
        )
    slower = min(speed, slower)
    walk[WALK_SPEED] += clamp(slower - walk[WALK_SPEED], -_SLOWER * CONTROL_DT, _FASTER * CONTROL_DT)
    change = _SIDE_CHANGE * CONTROL_DT
    walk[SIDEWAYS] += clamp(sideways - walk[SIDEWAYS], -change, change)
    return error


@kernel
def _in_tight_bend(walk):
    """Whether it turns so fast, in a bend, that a step's direction is not that in which it ends."""
    turns = abs(walk[WALK_TURN_RATE]) > _TURNING / USUAL_SPEED
    return turns and walk[SUDDEN] == 0.0 and walk[WALK_SPEED] > _SLOW_TURN


@kernel
def _trim(gains, walk, x, y):
    """At a touchdown with the centre of mass at (x, y): correct the speed asked for by that of the last
    step."""
    if walk[WALK_STEPS] > 1.0:
        time = (walk[WALK_TICKS] - walk[STEPPED_AT]) * CONTROL_DT
        way = walk[WALK_HEADING]
        if _in_tight_bend(walk):
            way -= 0.5 * walk[WALK_TURN_RATE] * time  # halfway through the step
        ch, sh = math.cos(way), math.sin(way)
        made = (ch * (x - walk[_STEPPED]) + sh * (y - walk[_STEPPED + 1])) / time
        walk[STEP_MADE] = made if pace_of(walk) > USUAL_SPEED else 0.0
        rate = gains[_TRIM_RATE] if walk[WALK_SPEED] > _SLOW else _STOPPING
        trim = walk[WALK_TRIM] + rate * (walk[WALK_SPEED] - made)
        walk[WALK_TRIM] = clamp(trim, -gains[_MOST_TRIM], gains[_MOST_TRIM])
    walk[STEPPED_AT], walk[_STEPPED], walk[_STEPPED + 1] = walk[WALK_TICKS], x, y


@kernel
def advance_step(gains, walk, command, error, soles, points, spans, contact, down, com, capture, omega, qpos):
    """Which feet bear the person now: phases and their ends. down: whether what touches the swing foot may be
    the ground below it."""
    stance = 1 if walk[WALK_STANCE] > 0 else 0
    swing = 1 - stance
    ch, sh = math.cos(walk[WALK_HEADING]), math.sin(walk[WALK_HEADING])
    still = abs(command[SPEED_ASKED]) < _STILL and abs(command[SIDEWAYS_ASKED]) < _STILL
    # on its toes, or with the capture point before, behind or beside its feet, a person stays up only by
    # stepping; with crossed legs it cannot stand
    mx, my = 0.5 * (points[0, 0] + points[1, 0]), 0.5 * (points[0, 1] + points[1, 1])
    ahead = ch * (capture[0] - mx) + sh * (capture[1] - my)
    left = ch * (capture[1] - my) - sh * (capture[0] - mx)
    apart = ch * (points[1, 1] - points[0, 1]) - sh * (points[1, 0] - points[0, 0])
    beside = abs(left) > 0.5 * apart + _SIDES
    shaky = max(spans[0, 0], spans[1, 0]) < _FOOTED or ahead > _TOES or ahead < _HEELS or beside
    if walk[PHASE] == STANDING:
        if still and abs(error) < _AWRY and not shaky:
            walk[CLOCK] = walk[SETTING_OFF] = 0.0
            return
        # push the capture point over to the first stance foot
        walk[SETTING_OFF] = 1.0
        outside = -sh * (capture[0] - points[stance, 0]) + ch * (capture[1] - points[stance, 1])
        inside = sway(gains, omega, 0.0)[1]
        if shaky or -walk[WALK_STANCE] * outside < 2.0 * inside or walk[CLOCK] > _SET_OFF_LIMIT:
            begin_swing(gains, walk, qpos)
    elif walk[PHASE] == SINGLE:
        # a foot that only brushes the ground on its way has not landed
        dx, dy = soles[swing, 0] - walk[_SPOT], soles[swing, 1] - walk[_SPOT + 1]
        there = walk[CLOCK] > _LANDING * walk[SWING_TIME] or dx * dx + dy * dy < _NEAR * _NEAR
        if walk[CLOCK] > 0.5 * walk[SWING_TIME] and contact[swing] > _TOUCH and there and down:
            missed = ch * (soles[swing, 0] - walk[_SPOT]) + sh * (soles[swing, 1] - walk[_SPOT + 1])
            if walk[WALK_SPEED] <= _SLOW:
                missed -= walk[MISSED]  # faster it stays a sum: runs are learned from such walks
            most = gains[_MOST_MISSED]
            walk[MISSED] = clamp(walk[MISSED] + 0.3 * missed, -most, most)
            walk[PHASE], walk[CLOCK] = DOUBLE, 0.0
            walk[WALK_STANCE] = -walk[WALK_STANCE]
            walk[WALK_STEPS] += 1.0
            walk[_LONGER] = walk[_LONGER + 1] = 0.0
            _trim(gains, walk, com[0], com[1])
        elif walk[CLOCK] > walk[SWING_TIME] + _OVERDUE:
            begin_swing(gains, walk, qpos)  # where it is to land now
    elif walk[CLOCK] >= gains[_TRANSFER]:
        if still and abs(walk[WALK_SPEED]) < _SETTLED and abs(error) < _STRAIGHT and not shaky:
            walk[PHASE], walk[WALK_TRIM] = STANDING, 0.0
            walk[CLOCK] = walk[SETTING_OFF] = 0.0
        else:
            begin_swing(gains, walk, qpos)
