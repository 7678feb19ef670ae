"""Trying changes of gait, from many states on level ground."""

from __future__ import annotations

import numpy as np

from locomotion.gaits.limits import SHORT_ENTRY, run_entry_speed
from locomotion.gaits.policy.skill import load_policy
from locomotion.gaits.run.layout import STEP_TIME
from locomotion.ground.ground import FRICTION, Ground, extruded
from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.paths.command import HEADING_ASKED
from locomotion.preconditions.changes import BRAKE, END_RUN, SLOW_DOWN, WALK_TO_RUN
from locomotion.preconditions.moments import make_slippery
from locomotion.training.preconditions.sampling import ENDS, Outcome, noted_change
from locomotion.training.preconditions.starts import Start

__all__ = ["try_change"]

_HALF, _BEHIND, _LENGTH = 20.0, 10.0, 100.0
# [m] of the ground: to both sides of the way, behind its start, ahead
_PACES = (0.5, 0.99)  # of the planned speed: with less than all of it nobody begins to run by itself
_LONGEST, _WAITS = 2000, 300  # ticks until a change is due, and in which it then finds a moment for it
_CHANGES_IN, _STAYS = 800, 200  # ticks within which it has changed, and for which it stays up afterwards
_RUNS = 300  # ticks of a run that has begun well


def try_change(name: str, start: Start, rng: np.random.Generator) -> Outcome:
    """Go on from a ``start``, and change as ``name`` (`preconditions.changes.CHANGES`) says when the way of
    `Start.distance` is made; ``rng``: for velocities and paces."""
    human, outcome = _begin(name, start, rng), Outcome(start, None)
    left = start.push_ticks
    while human.status in MOVING and human.com[0] < start.distance and human.ticks < _LONGEST:
        pushed = left > 0 and human.com[0] >= start.distance - start.push_at
        human.data.xfrc_applied[human.index.root, :2] = start.push if pushed else (0.0, 0.0)
        left -= pushed
        human.tick()
    human.data.xfrc_applied[:] = 0.0
    until = human.ticks + _WAITS
    while human.status in MOVING and human.ticks < until and not _can(name, human):
        human.tick()
    if human.status not in MOVING or not _can(name, human):
        outcome.end = ENDS[1]
        return outcome
    asked = start.speed if name == WALK_TO_RUN else 0.0
    outcome.noted.append(noted_change(human, start.variation, asked, start.friction))
    _change(name, human, start.variation)
    outcome.clean = _went_well(name, human)
    outcome.end = ENDS[0] if outcome.clean else ENDS[5]
    return outcome


def _begin(name: str, start: Start, rng: np.random.Generator) -> Human:
    ground = Ground.from_arrays(*extruded([(-_BEHIND, 0.0), (_LENGTH, 0.0)], _HALF))
    ground.friction = start.friction
    policy = load_policy() if name == END_RUN else None
    human = Human(ground, rehearsals=0, policy=policy)
    if start.friction < FRICTION:
        make_slippery(human.model, start.friction)
    human.reset((0.0, start.beside, 0.0), start.askew, start.running)
    human.data.qvel[:] += start.noise * rng.normal(size=human.model.nv)
    human.follow([[0.0, 0.0, 0.0], [_LENGTH - _BEHIND, 0.0, 0.0]], start.speed)
    if name == WALK_TO_RUN:
        human.give_way(float(rng.uniform(*_PACES)), None)
    return human


def _can(name: str, human: Human) -> bool:
    """Whether this is a moment for the change."""
    if name == WALK_TO_RUN:
        return _entry(human) is not None
    if name == END_RUN:
        return human.control[STEP_TIME] == 0.0 and human.on_feet.can_end_run(human.simulation)
    return human.on_feet.runs


def _entry(human: Human) -> float | None:
    heading = float(human.command[HEADING_ASKED])
    return run_entry_speed(human.on_feet.walk, human.observed, heading, SHORT_ENTRY)


def _change(name: str, human: Human, choice: tuple[float, float]) -> None:
    if name == WALK_TO_RUN:
        speed = _entry(human)
        assert speed is not None
        human.give_way(1.0, None)
        human.run(choice[0] > 0.0, speed + choice[1])
    elif name == SLOW_DOWN:
        human.give_way(_PACES[1], None)
        human.slow_down(choice[0])
    elif name == BRAKE:
        human.stop()
        human.brake(choice[0])
    else:
        human.stop()
        human.end_run()


def _went_well(name: str, human: Human) -> bool:
    """Whether it runs, walks or stands for long enough, without a fall in between."""
    done, stays = 0, _RUNS if name == WALK_TO_RUN else _STAYS
    for _ in range(_CHANGES_IN):
        human.tick()
        if human.status in ("fallen", "lost"):
            return False
        if name == WALK_TO_RUN:
            done += 1
        elif name == SLOW_DOWN:
            done = done + 1 if human.gait_now == "walk" else 0
        else:
            done = done + 1 if human.held or human.on_feet.stands_still(human.control) else 0
        if done >= stays or human.held:
            return True
    return False
