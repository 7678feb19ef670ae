"""Trying a bare skill, without rehearsals, from one start, and noting the moments of its run-up."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.gaits.run import controller
from locomotion.ground.ground import FRICTION, Ground
from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.preconditions.changes import changing
from locomotion.preconditions.moments import Moment, make_slippery, planned
from locomotion.rehearsal.trials import clears
from locomotion.skills.course import make_course
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.jump.kind import JUMP
from locomotion.skills.kind import SkillKind
from locomotion.skills.run_up_layout import FARTHER, FASTER
from locomotion.training.preconditions.starts import Start

__all__ = ["ENDS", "Noted", "Outcome", "WiderSkill", "noted_change", "try_slow_down", "try_start"]

ENDS = (
    "holds",
    "did not take off",
    "fell in the run-up",
    "fell in the skill",
    "fell behind it",
    "does not hold",
)
"""How an attempt ends; the last is of changes of gait. A skill holds if the body clears the
obstacle and stays up behind it, as in a rehearsal (`locomotion.rehearsal.trials.clears`)."""
_WAITS = 1500  # ticks within which it is in its run-up
_WALKS = 200  # ticks that it has to walk on after it has slowed down
_DECELERATES = 0.5  # what a variation of a mark [m] never is, and a deceleration [m/s²] always
_WIDER = 4.0  # times the span of the sizes that a skill has learned: it tries all of these


class WiderSkill:
    """A skill that also tries sizes that it has not learned, with the law for the nearest that it has."""

    def __init__(self, skill: ClearingSkill) -> None:
        low, high = skill.heights
        self._skill, self.affordance = skill, skill.affordance
        self.heights = (0.0, high + _WIDER * (high - low))

    @property
    def stride(self) -> tuple[float, float, float]:
        return self._skill.stride

    @property
    def ends(self) -> Literal["running", "walking"]:
        return self._skill.ends

    def approach(self, size: float, depth: float = 0.0) -> tuple[float, float]:
        return self._skill.approach(size, depth)

    def start(self, obstacle: ObstacleAhead, state: NDArray[np.float64]) -> NDArray[np.float64]:
        return self._skill.start(obstacle, state)

    def tick(
        self,
        obstacle: ObstacleAhead,
        memory: NDArray[np.float64],
        state: NDArray[np.float64],
        data: mujoco.MjData,
    ) -> bool:
        return self._skill.tick(obstacle, memory, state, data)

    def fell(self, memory: NDArray[np.float64], state: NDArray[np.float64]) -> bool:
        return self._skill.fell(memory, state)

    def check(self, memory: NDArray[np.float64], steps: float) -> None:
        self._skill.check(memory, steps)


class Noted(NamedTuple):
    """A moment of an attempt. off: whether the skill has just begun; else a step of the run-up has.
    unforeseen: whether a push is still to come. qpos (46,), qvel (45,): of the simulation."""

    moment: Moment
    off: bool
    unforeseen: bool
    qpos: NDArray[np.float64]
    qvel: NDArray[np.float64]


@dataclass
class Outcome:
    """What came of a start: one of `ENDS`; whether it touched nothing that it should not; the moments of its
    run-up, or the one before a change; the obstacle, None without one."""

    start: Start
    obstacle: ObstacleAhead | None
    end: str = ""
    clean: bool = False
    noted: list[Noted] = field(default_factory=list)


def try_start(kind: SkillKind, start: Start, rng: np.random.Generator) -> Outcome:
    """Run from a ``start`` at an obstacle and clear it; ``rng``: for the noise of the velocities."""
    human, outcome = _begin(kind, start, rng)
    attempt = _Attempt(human, outcome)
    for _ in range(_WAITS):
        if attempt.runs_up or human.status not in MOVING:
            break
        attempt.before()
        human.tick()
        attempt.after()
    if human.status == "fallen":
        outcome.end = ENDS[2]
    elif not attempt.runs_up:
        outcome.end = ENDS[1]
    else:
        _clear(human, attempt, outcome)
    return outcome


def try_slow_down(start: Start, rng: np.random.Generator) -> Outcome:
    """Run from a ``start`` at a stair, and slow down to a walk at a step of the run-up: does it walk on for
    `_WALKS`?"""
    human, outcome = _begin(JUMP, start, rng)
    attempt = _Attempt(human, outcome)
    while human.status in MOVING and not attempt.took_off and not outcome.noted and human.ticks < _WAITS:
        attempt.before()
        human.tick()
        attempt.after()
    if not outcome.noted or attempt.took_off:
        outcome.end, outcome.noted = ENDS[1], []
        return outcome
    outcome.noted = [noted_change(human, start.variation, 0.0, start.friction)]
    human.data.xfrc_applied[:] = 0.0
    human.balk(start.variation[0])
    walked = 0
    for _ in range(_WAITS):
        human.tick()
        walked = walked + 1 if human.gait_now == "walk" else 0
        if human.status == "fallen" or walked > _WALKS:
            break
    outcome.end = ENDS[0] if walked > _WALKS else ENDS[5]
    outcome.clean = walked > _WALKS
    return outcome


def noted_change(human: Human, choice: tuple[float, float], asked: float, grip: float) -> Noted:
    """The moment before a change; arguments as of `preconditions.changes.changing`, ``choice``: what it will
    do."""
    body = changing(human, asked, grip)
    moment = Moment(body.state, body.plan, np.array(choice), body.beside)
    return Noted(moment, False, False, body.qpos, body.qvel)


def _begin(kind: SkillKind, start: Start, rng: np.random.Generator) -> tuple[Human, Outcome]:
    course = make_course([(kind.affordance, start.size, start.depth)], [start.distance])
    ground = Ground.from_arrays(course.vertices, course.faces)
    ground.friction = start.friction
    bare = Human(ground, rehearsals=0)
    if start.friction < FRICTION:
        make_slippery(bare.model, start.friction)
    human = Human(ground, clearing=[WiderSkill(each) for each in bare.clearing], rehearsals=0)
    human.on_feet.landing.behind = lambda skill: True
    place = course.path[0] + (0.0, start.beside, 0.0)
    human.reset(place, start.askew, start.running)
    human.data.qvel[:] += start.noise * rng.normal(size=human.model.nv)
    human.follow(course.path, start.speed, course.obstacles)
    return human, Outcome(start, course.obstacles[0])


def _clear(human: Human, attempt: _Attempt, outcome: Outcome) -> None:
    """From the first step of its run-up on."""
    task = clears(human, looks_on=False)
    attempt.before()
    while True:
        try:
            next(task)
        except StopIteration as ended:
            went = ended.value[0]
            break
        attempt.after()
        attempt.before()
    outcome.clean = went >= 1.0
    if went > 0.0:
        outcome.end = ENDS[0]
    elif human.status != "fallen" and not attempt.took_off:
        outcome.end = ENDS[1]
    else:
        outcome.end = ENDS[4 if attempt.cleared else 3 if attempt.took_off else 2]


class _Attempt:
    """Pushes and notes along the way."""

    def __init__(self, human: Human, outcome: Outcome) -> None:
        self._human, self._outcome = human, outcome
        self.runs_up = self.took_off = self.cleared = False
        self._steps, self._left = 0, outcome.start.push_ticks

    def before(self) -> None:
        """Before a tick: push."""
        start, human = self._outcome.start, self._human
        force = human.data.xfrc_applied[human.index.root]
        force[:2] = 0.0
        if self._left and human.com[0] >= start.distance - start.push_at:
            force[:2] = start.push
            self._left -= 1

    def after(self) -> None:
        """After a tick: vary the run-up, and note the moment."""
        human, run_up = self._human, self._human.run_up
        if human.status == "fallen" or self.took_off:
            self.cleared |= self.took_off and not run_up.clearing and human.status != "fallen"
            return
        self.took_off = run_up.clearing
        begins = human.on_feet.runs and run_up.planned > 0.0 and human.control[controller.STEP_TIME] == 0.0
        if self.took_off:
            self._note(True)
        elif begins and run_up.ahead is not None:
            start = self._outcome.start
            if self._steps == start.from_step and start.variation[0] < _DECELERATES:
                run_up.vary(start.variation, human.control, False)
            if self._steps >= start.from_step:
                self._note(False)
            self._steps += 1
            self.runs_up = True

    def _note(self, off: bool) -> None:
        human, run_up, obstacle = self._human, self._human.run_up, self._outcome.obstacle
        assert obstacle is not None
        plan = planned(human.control, obstacle, run_up.skill, human.on_feet.run_skill, run_up.plan, off)
        moment = Moment(
            human.control.copy(), plan, run_up.plan[[FARTHER, FASTER]].copy(), human.lateral_error
        )
        if math.isfinite(moment.plan.sum()):
            noted = Noted(moment, off, self._left > 0, human.qpos, human.data.qvel.copy())
            self._outcome.noted.append(noted)
