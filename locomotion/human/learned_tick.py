"""A control tick of the learned walk in one kernel, and what it remembers."""

import math

import numpy as np

from locomotion.body.person import CONTROL_DT
from locomotion.gaits.policy import layout as at
from locomotion.gaits.policy.kernel import decide_tick
from locomotion.gaits.policy.law import RUN_SIDEWAYS, RUNS_FROM
from locomotion.gaits.policy.level_ground import floor_at
from locomotion.gaits.walk.layout import (
    CLOCK,
    DOUBLE,
    PHASE,
    SINGLE,
    STANDING,
    WALK_HEADING,
    WALK_SPEED,
    WALK_STANCE,
    WALK_STEPS,
    WALK_TICKS,
    WALK_TURN_RATE,
    wrap,
)
from locomotion.human.gaze import look_ahead
from locomotion.paths.command import HEADING_ASKED, SIDEWAYS_ASKED, SPEED_ASKED
from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "ACTIVE",
    "CALMS",
    "CALM_SPEED",
    "CALM_TURN",
    "MAY_RUN",
    "MEMORY_SIZE",
    "MOST_TURN",
    "OWN_STYLE",
    "SIDEWAYS",
    "SLOWEST",
    "TICKS",
    "decide_and_walk_on",
    "walk_on",
]

SLOWEST = 0.3
"""[m/s] at which it walks at least. Asked for less than half of that, it comes to rest."""
MOST_TURN = 1.2
"""[rad/s] that it turns at most."""
SIDEWAYS = 1.2
"""[m/s^2] in a bend at most as it walks, and as a run is planned; that leaves a run some to steer with."""
CALM_SPEED, CALM_TURN = 1.1, 0.25
"""[m/s] and [rad/s]: greatest speed and turn rate with which planned steps follow learned ones. Faster people
often fall there."""
_EAGERNESS = 2.0  # [1/s] of turning towards the heading asked for
_ASKEW = 0.3  # [rad] off that heading from which it hardly goes on straight
_CALMER = 0.8  # share of these limits that is asked for, so that they are reached
_FACES = 0.1  # [rad] off that heading up to which a person at rest does not turn

ACTIVE = at.STATE_SIZE + at.FELT_SIZE
TICKS, MAY_RUN, CALMS, _OWN = ACTIVE + 1, ACTIVE + 2, ACTIVE + 3, ACTIVE + 4
OWN_STYLE = slice(_OWN, _OWN + at.STYLE.stop - at.STYLE.start)
MEMORY_SIZE = OWN_STYLE.stop
"""The memory of the learned walk: the policy's memory, what it feels, whether it moves the person, for how
many ticks, whether it may run here, whether it calms down because planned steps are to follow, and the
person's own style, which it shows on level ways."""
_SOLE_HEIGHTS = at.STATE_SIZE + at.SOLES.start + 2


@kernel
def _ask(memory, command, asked):
    """What ``command`` asks of a walk that makes no steps aside."""
    speed = command[SPEED_ASKED]
    if not memory[MAY_RUN] > 0.0:
        speed = min(speed, RUNS_FROM)
    speed = max(speed, SLOWEST) if speed > 0.5 * SLOWEST else 0.0
    aside = math.atan2(command[SIDEWAYS_ASKED], speed) if speed > 0.0 else 0.0
    off = wrap(command[HEADING_ASKED] + aside - memory[at.HEADING])
    sideways = RUN_SIDEWAYS if memory[at.FAST] > 0.0 else SIDEWAYS
    most = min(MOST_TURN, sideways / max(speed, memory[at.TOLD], SLOWEST))
    turn = min(max(_EAGERNESS * off, -most), most)
    if speed == 0.0 and abs(off) < _FACES:
        turn = 0.0
    if memory[CALMS] > 0.0:
        most = _CALMER * CALM_TURN
        turn = min(max(turn, -most), most)
        speed = min(speed, _CALMER * CALM_SPEED if abs(off) < _ASKEW else SLOWEST)
    asked[at.ASKED_SPEED], asked[at.ASKED_TURN] = speed, turn


@kernel
def _go_on(memory, landed, command, walk, qpos, ctrl):
    memory[TICKS] += 1.0
    walk[WALK_TICKS] += 1.0
    if memory[at.RUNNING] == 0.0:
        walk[PHASE], walk[CLOCK] = STANDING, 0.0
    elif landed:
        walk[PHASE], walk[CLOCK] = DOUBLE, 0.0
        walk[WALK_STANCE] = -1.0 if memory[at.PHASE] < 0.5 else 1.0
        walk[WALK_STEPS] += 1.0
    else:
        walk[PHASE], walk[CLOCK] = SINGLE, walk[CLOCK] + CONTROL_DT
    walk[WALK_HEADING], walk[WALK_SPEED] = memory[at.HEADING], memory[at.TOLD]
    walk[WALK_TURN_RATE] = memory[at.TURN_RATE]
    look_ahead(memory[at.HEADING], command, qpos, ctrl)


@allocating_kernel
def decide_and_walk_on(ground, motion, walks, stands, runs, memory, command, walk, qpos, qvel, ctrl):
    """A tick in which the policy decides: write the targets ``ctrl`` (39,) [rad], and what others read into
    ``walk`` (WALK_SIZE,).

    ground: as in `locomotion.gaits.walk.footholds.ground_at`. motion, walks, stands, runs: as of
    `decide_tick`. memory: (MEMORY_SIZE,). command: (4,), see `locomotion.paths.command`.
    """
    state, felt = memory[: at.STATE_SIZE], memory[at.STATE_SIZE : ACTIVE]
    asked = np.empty(2)
    _ask(memory, command, asked)
    lowest = memory[_SOLE_HEIGHTS]
    for k in range(1, len(at.SOLE_POINTS)):
        lowest = min(lowest, memory[_SOLE_HEIGHTS + 3 * k])
    floor = floor_at(ground, qpos[0], qpos[1], lowest)
    state[at.FLOOR] = lowest if math.isnan(floor) else floor
    before = state[at.PHASE]
    decide_tick(motion, walks, stands, runs, state, asked, felt, qpos, qvel, ctrl)
    landed = math.floor(2.0 * state[at.PHASE]) != math.floor(2.0 * before)
    _go_on(memory, landed, command, walk, qpos, ctrl)


@kernel
def walk_on(memory, command, walk, qpos, ctrl):
    """A tick between two decisions; arguments as of `decide_and_walk_on`."""
    _go_on(memory, False, command, walk, qpos, ctrl)
