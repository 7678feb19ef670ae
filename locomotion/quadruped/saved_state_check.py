"""Check saved states of quadrupeds."""

from __future__ import annotations

import numpy as np

from locomotion.errors import LocomotionError
from locomotion.quadruped import layout as at
from locomotion.quadruped.body import Body
from locomotion.quadruped.herd import RING
from locomotion.quadruped.orders import AnimalMemory
from locomotion.saved_arrays import FARTHEST, Slots, check_array, check_number

__all__ = ["check_animal"]

_COUNT, _FLAG = (0.0, FARTHEST), (0.0, 1.0)
_WHOLE = (
    at.MODE, at.WAY, at.STOPPING, at.GAIT_NOW, at.GAIT_WISH, at.ROW_START, at.ROW_COUNT, at.KIND, at.REST,
    at.FIRST_TICK, at.NO_GROUND, at.FIXED_LOOK, at.CRUMBS, at.CRUMB_LAST,
)  # fmt: skip
_LEAST_ROWS = 2
_TURN = 1e4  # [rad] that a direction is off at most


def _row_of(gaits: int) -> Slots:
    """Ranges of the row of an animal with so many gaits."""
    return Slots(
        "the row of an animal",
        at.STATE,
        [
            (at.MODE, (at.STANDING, at.SCRIPTED)),
            (at.SPEED, (0.0, 100.0)),
            (at.WAY, (-1.0, 1.0)),
            (at.WISH, (0.0, 100.0)),
            (at.STOPPING, _FLAG),
            (at.CLOCK, _FLAG),
            (at.GAIT_NOW, (0.0, gaits - 1.0)),
            (at.GAIT_WISH, (-1.0, gaits - 1.0)),
            (at.FREQUENCY_NOW, (0.0, 100.0)),
            (slice(at.DUTY_FRONT_NOW, at.DUTY_REAR_NOW + 1), _FLAG),
            (at.YAW, (-_TURN, _TURN)),
            (at.BEND, (-10.0, 10.0)),
            (at.CHEST, (-_TURN, _TURN)),
            (at.GAZE, (-_TURN, _TURN)),
            (slice(at.SCRIPT_TIME, at.SCRIPT_LENGTH + 1), (0.0, 1e4)),
            (slice(at.ROW_START, at.ROW_COUNT + 1), _COUNT),
            (at.ROW_STEP, (0.0, 10.0)),
            (at.KIND, _COUNT),
            (slice(at.REST, at.NO_GROUND + 1), _FLAG),
            (at.FIXED_LOOK, _FLAG),
            (at.CRUMBS, (0.0, float(RING))),
            (at.CRUMB_LAST, (0.0, RING - 1.0)),
            (at.PACE, _FLAG),
            (at.FREQUENCY_WISH, (0.0, 100.0)),
            (slice(at.FLEXION_NOW, at.LOWER_NOW + 1), (-10.0, 10.0)),
            (slice(at.BACK, at.NECK_DIP + 1), (-10.0, 10.0)),
            (at.CHORD, (0.01, 1.001)),
            (at.SLOPE, (-100.0, 100.0)),
            (at.IDLE, _FLAG),
            (slice(at.STANDS_FRONT, at.STANDS_REAR + 1), _FLAG),
            (at.BREATH, _FLAG),
            (at.AGE, (0.0, FARTHEST)),
            (slice(at.HABITS, at.HABITS + 4), _FLAG),
        ],
        whole=_WHOLE,
        open_ended=(at.LOOK_X, at.LOOK_Y),
    )


def check_animal(memory: AnimalMemory, body: Body) -> None:
    """Raise `LocomotionError` if no animal with this ``body`` can have this ``memory``."""
    state = memory.herd
    if state.body != body.name:
        raise LocomotionError(f"the saved state belongs to a {state.body}, not to a {body.name}")
    _row_of(len(body.gaits)).check(state.row)
    check_array("the feet of an animal", state.feet, 4, at.FOOT)
    check_array("the crumbs of an animal", state.crumbs, RING, 3)
    check_array("the motion of an animal", state.table, None, at.ROW)
    row, count = state.row, len(state.table)
    if row[at.ROW_COUNT] != count:
        raise LocomotionError(f"the motion of an animal has {count} rows, of {row[at.ROW_COUNT]:g}")
    moves = row[at.MODE] != at.STANDING
    if moves and (count < _LEAST_ROWS or row[at.ROW_STEP] <= 0.0 or row[at.WAY] == 0.0):
        raise LocomotionError(f"an animal moves by {count} rows, {row[at.ROW_STEP]:g} apart")
    if row[at.MODE] == at.SCRIPTED and row[at.SCRIPT_LENGTH] <= 0.0:
        raise LocomotionError("an animal plays a motion of no length")
    if not np.isin(state.feet[:, at.IN_SWING], (0.0, 1.0)).all():
        raise LocomotionError("a foot of an animal neither stands nor swings")
    tempo, shares = state.feet[:, at.TEMPO], state.feet[:, [at.STANCE, at.HUMP]]
    if not (np.all((tempo > 0.0) & (tempo < 100.0)) and np.all((shares >= 0.0) & (shares <= 1.0))):
        raise LocomotionError("a foot of an animal is at no place in its stride")
    _check_mind(memory, body)


def _check_mind(memory: AnimalMemory, body: Body) -> None:
    errand, trail = memory.errand, memory.trail
    body.gait_index(errand.gait)
    if errand.goals and not np.isfinite(np.array(errand.goals)).all():
        raise LocomotionError("a goal of an animal is not finite")
    check_number("the speed that an animal was told", errand.speed, 1e-6, FARTHEST)
    for what in (errand.waited, errand.backed, errand.manoeuvres, memory.ticks, memory.stood):
        check_number("a count of an animal", what, 0, FARTHEST)
    if trail is not None:
        check_array("the trail of an animal", trail.rows, None, at.ROW, least=_LEAST_ROWS)
        check_number("the spacing of a trail", trail.step, 1e-9, 10.0)
    for way in memory.ways:
        check_array("the way of an animal", way.points, None, 3, least=1)
    if memory.phase in ("following", "flexing") and (trail is None or not memory.ways):
        raise LocomotionError("an animal follows no trail")
    if memory.phase in ("following", "backing") and memory.herd.row[at.MODE] != at.ON_TRAIL:
        raise LocomotionError("an animal follows a trail that it is not on")
    if memory.phase in ("following", "flexing") and len(memory.ways) > max(len(errand.goals), 1):
        raise LocomotionError("an animal is on more ways than it has goals")
