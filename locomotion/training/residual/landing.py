"""Many people at once who land behind obstacles, corrected by a residual policy."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from locomotion.gaits.policy.layout import TICKS_PER_DECISION
from locomotion.gaits.residual.layout import LANDING_INPUTS, SINCE
from locomotion.gaits.residual.skill import ResidualSkill
from locomotion.gaits.run import layout as run
from locomotion.ground.ground import Ground
from locomotion.human.human import BetweenGaits, Human
from locomotion.human.landing import LASTS
from locomotion.human.state import MOVING, HumanState
from locomotion.skills.course import Course, make_course
from locomotion.skills.registry import skill_kinds
from locomotion.training.policies.environment import Outcome
from locomotion.training.residual.people import CorrectedPeople, outcome

__all__ = ["LandingPeople", "LandingStage", "landing_group", "on_course"]

_OBSTACLES = 8  # of each course
_DISTANCES, _DEPTHS = (8.0, 16.0), (0.1, 0.6)  # [m] between obstacles; of what one gets over
_SPEED, _NOISE = (3.0, 4.0), 0.05  # [m/s] asked for; [m/s, rad/s] at the beginning
_AGAIN = 0.8  # [m] behind an obstacle from which who has fallen there goes on
_NEAR = 6.0  # [m] before an obstacle, farther than which it has fallen behind the one before
_LONGEST = 12_000  # ticks on a course
_PUSH_WITHIN, _LATEST = 100, 25  # decisions; after the landing that somebody begins at most


@dataclass(frozen=True)
class LandingStage:
    """A part of learning.

    Attributes:
      name: what it is about. samples: decisions to learn from.
      noise: standard deviation of what is tried, at the stage's beginning and at its end.
      pushed: share that is pushed; push: greatest force at the waist [N], for 0.1 s.
      shaken: [m/s, rad/s] standard deviation of what is added to the velocities at the beginning.
    """

    name: str
    samples: int
    noise: tuple[float, float]
    pushed: float = 0.0
    push: float = 0.0
    shaken: float = 0.05


class LandingPeople(CorrectedPeople):
    """``count`` people, each on a course of its own, who have just landed behind one of its obstacles.

    Attributes:
      inputs, actions: numbers observed and decided.
      starts: where each of them may begin.
    """

    inputs = LANDING_INPUTS

    def __init__(self, count: int, rng: np.random.Generator) -> None:
        on_courses: list[tuple[Human, list[HumanState]]] = []
        while len(on_courses) < count:
            human, starts = on_course(rng, None)
            if starts:
                on_courses.append((human, starts))
        people = [human for human, _ in on_courses]
        super().__init__(people, [human.on_feet.landing for human in people])
        self.starts = [starts for _, starts in on_courses]

    def _begin_anew(self, i: int, human: Human) -> None:
        rng, stage = self.rng, self.stage
        human.restore_state(self.starts[i][int(rng.integers(len(self.starts[i])))])
        human.data.qvel[:] += stage.shaken * rng.normal(size=human.model.nv)
        self.corrections[i].forget()
        self.corrections[i].memory[SINCE] = 1.0
        self.age[i], self.before[i] = rng.integers(0, _LATEST), 0.0
        within = int(self.age[i]), int(self.age[i]) + _PUSH_WITHIN
        self.pushes.draw(i, rng, stage.pushed, stage.push, within)

    def observe(self) -> NDArray[np.float64]:
        """What the policies observe, (n, LANDING_INPUTS)."""
        seen = np.empty((self.count, LANDING_INPUTS))
        for i, human in enumerate(self.people):
            feet = human.on_feet
            self.left[i] = feet.landing.observe(human.run_up, human.control, feet.walk, human.data)
            seen[i] = feet.landing.observed
        return seen

    def step(self, decided: NDArray[np.floating]) -> Outcome:
        """Do what the policies ``decided`` (n, ACTIONS) until the next decision."""
        action, n, moved = self._in_own_sides(decided), self.count, []
        aside, slow, ended = np.zeros(n), np.zeros(n), np.zeros(n, bool)
        for i, human in enumerate(self.people):
            moved.append(self._move(i, action[i]))
            ahead, beside = human.control[run.COM_VELOCITY][:2]
            aside[i], slow[i] = abs(beside), abs(ahead - human.on_feet.speed)
            ended[i] = human.status not in MOVING or not human.on_feet.landing.decides
        fell = np.array([each.fell for each in moved])
        terms = self._usual_terms(action, moved) | {
            "up": np.full(n, 0.02),
            "aside": -0.01 * aside,
            "slow": -0.005 * slow,
        }
        over = (ended | (self.age >= LASTS // TICKS_PER_DECISION)) & ~fell
        return outcome(terms, fell, over)


def landing_group(count: int, seed: int, number: int) -> LandingPeople:
    """Group ``number`` of ``count`` people, on courses of their own."""
    return LandingPeople(count, np.random.default_rng([seed, 1, number]))


def on_course(rng: np.random.Generator, skill: ResidualSkill | None) -> tuple[Human, list[HumanState]]:
    """A person with ``skill`` on a random course of all kinds of obstacles, and its states where it has
    landed behind them."""
    kinds, obstacles = skill_kinds(), []
    for _ in range(_OBSTACLES):
        kind = kinds[int(rng.integers(len(kinds)))]
        obstacles.append((kind.affordance, float(rng.uniform(*kind.sizes)), float(rng.uniform(*_DEPTHS))))
    course = make_course(obstacles, [float(rng.uniform(*_DISTANCES)) for _ in obstacles])
    ground = Ground.from_arrays(course.vertices, course.faces)
    human = Human(ground, rehearsals=0, between=BetweenGaits(landing=skill))
    starts: list[HumanState] = []
    x = 0.0
    while x < course.obstacles[-1].arc_length and human.ticks < _LONGEST:
        x += _run_from(human, course, x, rng, starts)
    return human, starts


def _run_from(
    human: Human, course: Course, x: float, rng: np.random.Generator, starts: list[HumanState]
) -> float:
    """Run from a stand at ``x`` [m] until it falls or arrives, and note where it lands; gives how far it is
    to the place behind the obstacle at which it fell."""
    ahead = [
        replace(each, arc_length=each.arc_length - x) for each in course.obstacles if each.arc_length > x
    ]
    points = course.path[course.path[:, 0] > x]
    here = np.array([x, 0.0, points[0, 2]])
    human.reset(here, 0.0)
    human.follow(np.vstack([here, points]), float(rng.uniform(*_SPEED)), ahead)
    human.data.qvel[:] += _NOISE * rng.normal(size=human.model.nv)
    landing = human.on_feet.landing
    while human.status in MOVING and human.ticks < _LONGEST:
        before = landing.decides
        human.tick()
        if landing.decides and not before and human.status in MOVING:
            human.events.clear()
            starts.append(human.save_state())
    fell_at = human.run_up.ahead
    if human.status != "fallen" or fell_at is None:
        return float(course.path[-1, 0])
    if human.com[0] - x < fell_at.arc_length - _NEAR and human.run_up.passed > 0.0:
        return human.run_up.passed
    return fell_at.far_side + _AGAIN
