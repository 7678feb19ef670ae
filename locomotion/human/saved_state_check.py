"""Check saved states of persons."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import JOINT_NAMES
from locomotion.body.physics import physics_size
from locomotion.errors import LocomotionError
from locomotion.gaits.policy import layout as policy
from locomotion.gaits.residual import layout as residual
from locomotion.gaits.run import layout as run
from locomotion.gaits.walk import layout as walk
from locomotion.human import learned_walk
from locomotion.human.human import Human
from locomotion.human.landing import LASTS, NEVER
from locomotion.human.state import BUSY, CLEARING, HumanState
from locomotion.paths import tracking
from locomotion.paths.command import COMMAND_SIZE, HEADING_ASKED, SIDEWAYS_ASKED, SLOPE_THERE, SPEED_ASKED
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.paths.table import BRAKE, FAST_WALK, GAIT, RUN, SPEED, WALK, PathTable
from locomotion.recovery import layout as scramble
from locomotion.saved_arrays import COUNT, FARTHEST, FLAG, SIDE, Slots, check_array, check_number
from locomotion.skills import run_up_layout as run_up
from locomotion.skills.interface import skill_for

__all__ = ["check_person"]

_SPEED, _TURNS, _TIME = (-100.0, 100.0), (-1e4, 1e4), (0.0, FARTHEST)
_STYLE = (-2.0, 2.0)
_SLOWER = 0.05  # of a step: a skill may hold back its first tick, which takes no more
_UNIT = 1e-2  # by which the length of a quaternion may be off 1
_MOST_REHEARSED = 100_000  # ticks, which are simulated again when it is restored
_OFF_LEVEL = 1e3  # [m] beside the level
_FASTEST, _MOST_ANGLE = 1e3, 100.0  # [m/s, rad/s], [rad] of a joint

_PARTS = (
    Slots(
        "the run of a person",
        run.STATE_SIZE,
        [
            (run.PHASE, (-_SLOWER, 1.0)),
            (run.STANCE, SIDE),
            (run.HEADING, _TURNS),
            (run.SPEED, _SPEED),
            (run.TRIM, _SPEED),
            (run.STEPS, COUNT),
            (run.STEP_TIME, _TIME),
            (run.SLOPE, _SPEED),
            (run.TICKS, COUNT),
            (run.FALLEN, FLAG),
        ],
        whole=(run.STANCE, run.STEPS, run.TICKS, run.FALLEN),
    ),
    Slots(
        "the command of a person",
        COMMAND_SIZE,
        [
            (HEADING_ASKED, _TURNS),
            (SPEED_ASKED, _SPEED),
            (SIDEWAYS_ASKED, _SPEED),
            (SLOPE_THERE, _SPEED),
        ],
    ),
    Slots(
        "the walk of a person",
        walk.WALK_SIZE,
        [
            (walk.PHASE, (walk.STANDING, walk.DOUBLE)),
            (walk.CLOCK, _TIME),
            (walk.WALK_STANCE, SIDE),
            (walk.WALK_HEADING, _TURNS),
            (walk.WALK_SPEED, _SPEED),
            (walk.SIDEWAYS, _SPEED),
            (walk.SETTING_OFF, FLAG),
            (walk.SWING_TIME, (0.0, 10.0)),
            (walk.WALK_STEPS, (-3.0, FARTHEST)),
            (walk.WALK_TICKS, COUNT),
            (walk.FOOTHOLD_YAW, _TURNS),
            (walk.LIFT_YAW, _TURNS),
            (walk.WALKS, FLAG),
            (walk.STEPPED_AT, COUNT),
            (walk.CAUGHT, FLAG),
            (walk.UNEVEN, FLAG),
            (walk.LONGER, (-10.0, 10.0)),
            (walk.TOLD, _TURNS),
        ],
        whole=(
            walk.PHASE,
            walk.WALK_STANCE,
            walk.WALK_STEPS,
            walk.WALK_TICKS,
            walk.WALKS,
            walk.CAUGHT,
        ),
        open_ended=(walk.BODY_HEIGHT,),
    ),
    Slots(
        "what corrects the braking of a person",
        residual.MEMORY_SIZE,
        [(residual.SINCE, COUNT), (residual.DECIDED, _SPEED)],
        whole=(residual.SINCE,),
    ),
    Slots(
        "what corrects the landing of a person",
        residual.MEMORY_SIZE,
        [(residual.SINCE, (NEVER, LASTS + 1.0)), (residual.DECIDED, _SPEED)],
        whole=(residual.SINCE,),
    ),
    Slots(
        "the way of a person",
        tracking.TRACK_SIZE,
        [
            (tracking.ARC, COUNT),
            (tracking.PACE, FLAG),
            (tracking.BACKED, (0.0, 1e3)),
            (tracking.WAITED, COUNT),
            (tracking.TRIED, COUNT),
            (tracking.STOPS_SINCE, COUNT),
        ],
        whole=(tracking.BACKED, tracking.TRIED, tracking.STOPS_SINCE),
    ),
    Slots(
        "what a person on hands and feet remembers",
        scramble.SCRAMBLE_SIZE,
        [
            (scramble.PHASE, (scramble.ALL_DOWN, scramble.SWINGING)),
            (scramble.CLOCK, _TIME),
            (scramble.PAIR, FLAG),
            (scramble.FACING, _TURNS),
            (scramble.TICKS, COUNT),
            (scramble.RISEN, (0.0, 2.0)),
            (scramble.LOADS, FLAG),
            (scramble.DOWN, FLAG),
            (scramble.STANCE, (-10.0, 10.0)),
            (scramble.MODE, (scramble.AWAY, scramble.RISING)),
            (scramble.MODE_CLOCK, _TIME),
            (scramble.ROLL_SIDE, FLAG),
            (scramble.TRIES, COUNT),
        ],
        whole=(
            scramble.PHASE,
            scramble.PAIR,
            scramble.TICKS,
            scramble.DOWN,
            scramble.MODE,
            scramble.ROLL_SIDE,
            scramble.TRIES,
        ),
    ),
    Slots(
        "the run-up of a person",
        run_up.RUN_UP_SIZE,
        [
            (run_up.NEXT, COUNT),
            (run_up.STEPS_SEEN, COUNT),
            (run_up.PLANNED, _SPEED),
            (run_up.FARTHER, _SPEED),
            (run_up.FASTER, _SPEED),
        ],
        whole=(run_up.NEXT, run_up.STEPS_SEEN),
    ),
)
"""In the order of the arrays in `locomotion.human.state`, but for the learned walk."""
_LEARNED = Slots(
    "the learned walk of a person",
    learned_walk.MEMORY_SIZE,
    [
        (policy.PHASE, FLAG),
        (policy.RUNNING, FLAG),
        (policy.RESTED, (-1.0, FARTHEST)),
        (policy.HEADING, _TURNS),
        (policy.SPEED, _SPEED),
        (policy.TURN_RATE, _SPEED),
        (policy.STARTED, FLAG),
        (policy.TOLD, _SPEED),
        (policy.TRIM, _SPEED),
        *((k, _STYLE) for k in range(policy.STYLE.start, policy.STYLE.stop)),
        *((k, _STYLE) for k in range(learned_walk.OWN_STYLE.start, learned_walk.OWN_STYLE.stop)),
        (learned_walk.ACTIVE, FLAG),
        (learned_walk.TICKS, COUNT),
        (learned_walk.CALMS, FLAG),
    ],
    whole=(
        policy.RUNNING,
        policy.STARTED,
        learned_walk.ACTIVE,
        learned_walk.TICKS,
        learned_walk.CALMS,
    ),
)
_WALK = 2  # place of the planned walk, which the learned one follows


def _parts(human: Human) -> tuple[Slots, ...]:
    if human.on_feet.learned is None:
        return _PARTS
    return *_PARTS[: _WALK + 1], _LEARNED, *_PARTS[_WALK + 1 :]


def check_person(state: HumanState, human: Human) -> None:
    """Raise `LocomotionError` if ``human`` cannot be in this ``state``."""
    numbers, end = state.numbers, 0
    parts = _parts(human)
    held = sum(part.size for part in parts)
    if numbers.shape != (held + physics_size(human.model),):
        raise LocomotionError("the saved state belongs to another model")
    for part in parts:
        begin, end = end, end + part.size
        part.check(numbers[begin:end])
    _check_physics(numbers[held:], human)
    for path in (state.path, state.interrupted):
        if path is not None:
            _check_path(path)
    if state.status not in BUSY and state.status not in CLEARING.values():
        raise LocomotionError(f"a person is {state.status!r}, which nobody can be")
    on_path = state.interrupted is not None or state.status in ("walking", "running", *CLEARING.values())
    if state.path is None and on_path:
        raise LocomotionError(f"a person is {state.status} along no path")
    for what in (state.ticks, state.ended_at, state.pushed_until):
        check_number("a tick of a person", what, 0, 2**53)
    check_number("the habit of a person", state.habit, 0.0, 1.0)
    spent, begins = state.foresight
    check_number("what a person has rehearsed", spent, 0, _MOST_REHEARSED)
    check_number("the tick from which a person rehearses", begins, 0, 2**53)
    for what in (state.slowing, state.speed, state.back_to, *state.on_all_fours):
        check_number("a mood of a person", what)
    for obstacle in state.obstacles:
        _check_obstacle(obstacle)
    _check_clearing(state, human)


def _check_physics(physics: NDArray[np.float64], human: Human) -> None:
    """Check time, coordinates and their rates; MuJoCo's other numbers must only be finite."""
    check_array("the physics of a person", physics, None)
    nq, nv = human.model.nq, human.model.nv
    time, qpos, qvel = physics[0], physics[1 : 1 + nq], physics[1 + nq : 1 + nq + nv]
    check_number("the physics' time", time, 0.0)
    if human.ground is not None:
        low, high = human.ground.low - _OFF_LEVEL, human.ground.high + _OFF_LEVEL
        if not ((qpos[:3] >= low) & (qpos[:3] <= high)).all():
            raise LocomotionError("a person is far from the level")
    check_number(
        "the length of a person's quaternion", float(np.linalg.norm(qpos[3:7])), 1 - _UNIT, 1 + _UNIT
    )
    check_number("a joint of a person", float(np.abs(qpos[7 : 7 + len(JOINT_NAMES)]).max()), 0.0, _MOST_ANGLE)
    check_number("a speed of a person", float(np.abs(qvel).max()), 0.0, _FASTEST)


def _check_path(path: PathTable) -> None:
    table = path.table
    check_array("the path of a person", table, None, 8, least=2)
    check_array("the goal of a path", path.goal, 3)
    check_number("the length of a path", path.length, 1e-9, float(len(table)))
    if not np.isin(table[:, GAIT], (BRAKE, FAST_WALK, WALK, RUN)).all() or (table[:, SPEED] < 0.0).any():
        raise LocomotionError("a path of a person is gone in no gait")


def _check_obstacle(obstacle: ObstacleAhead) -> None:
    if obstacle.affordance not in CLEARING:
        raise LocomotionError(f"an obstacle affords {obstacle.affordance!r}; valid: {', '.join(CLEARING)}")
    check_array("the place of an obstacle", obstacle.position, 3)
    check_array("the normal of an obstacle", obstacle.normal, 3)
    check_number("the normal of an obstacle", float(np.hypot(*obstacle.normal[:2])), 1 - _UNIT, 1 + _UNIT)
    for what in (obstacle.arc_length, obstacle.height, obstacle.depth):
        check_number("a measure of an obstacle", what)


def _check_clearing(state: HumanState, human: Human) -> None:
    """Check that its skills clear its present and coming obstacles."""
    plan = state.numbers[sum(part.size for part in _parts(human)[:-1]) :]
    number = int(plan[run_up.NEXT])
    ahead = [skill_for(human.clearing, obstacle) for obstacle in state.obstacles[number:]]
    if None in ahead:
        raise LocomotionError("a person is before an obstacle that it cannot clear")
    if state.obstacles and state.path is None:
        raise LocomotionError("a person has obstacles before it and no path")
    if state.skill is None:
        if state.status in CLEARING.values():
            raise LocomotionError(f"a person is {state.status} by no skill")
        return
    if not ahead or ahead[0] is None:
        raise LocomotionError("a person clears no obstacle")
    check_array("the skill of a person", state.skill, None)
    ahead[0].check(state.skill, state.numbers[run.STEPS])
