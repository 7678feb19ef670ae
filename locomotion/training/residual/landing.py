"""Many people at once who land behind obstacles, corrected by a residual policy."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import MASS
from locomotion.gaits.policy.layout import MIRROR_JOINT, SIGN_JOINT, TICKS_PER_DECISION
from locomotion.gaits.residual.layout import ACTIONS, DECIDED, LANDING_INPUTS, SINCE
from locomotion.gaits.residual.skill import ResidualSkill
from locomotion.gaits.run import layout as run
from locomotion.ground.ground import Ground
from locomotion.human.human import BetweenGaits, Human
from locomotion.human.landing import LASTS
from locomotion.human.state import MOVING, HumanState
from locomotion.skills.course import Course, make_course
from locomotion.skills.registry import skill_kinds
from locomotion.training.policies.environment import Outcome
from locomotion.training.residual.pushes import Pushes

__all__ = ["LandingPeople", "LandingStage", "landing_group", "on_course"]

_OBSTACLES = 8  # of each course
_DISTANCES, _DEPTHS = (8.0, 16.0), (0.1, 0.6)  # [m] between obstacles; of what one gets over
_SPEED, _NOISE = (3.0, 4.0), 0.05  # [m/s] asked for; [m/s, rad/s] at the beginning
_AGAIN = 0.8  # [m] behind an obstacle from which who has fallen there goes on
_NEAR = 6.0  # [m] before an obstacle, farther than which it has fallen behind the one before
_LONGEST = 12_000  # ticks on a course
_PUSH_WITHIN = 100  # decisions
_FALL = 3.0  # what a fall costs
_HARD = 4.5  # body weights of ground reaction that cost nothing


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


class LandingPeople:
    """``count`` people, each on a course of its own, who have just landed behind one of its obstacles.

    Attributes:
      inputs, actions: numbers observed and decided.
      starts: where each of them may begin.
    """

    inputs, actions = LANDING_INPUTS, ACTIONS

    def __init__(self, count: int, rng: np.random.Generator) -> None:
        self.count, self.rng = count, rng
        self.people: list[Human] = []
        self.starts: list[list[HumanState]] = []
        while len(self.people) < count:
            human, starts = on_course(self.rng, None)
            if starts:
                self.people.append(human)
                self.starts.append(starts)
        self.landings = [human.on_feet.landing for human in self.people]
        self.age = np.zeros(count, np.int64)
        self.before = np.zeros((count, ACTIONS))
        self.left = np.zeros(count, bool)
        self.pushes = Pushes(self.people)

    def begin(self, stage: LandingStage, seed: int) -> None:
        """Everybody begins anew."""
        self.stage, self.rng = stage, np.random.default_rng(seed)
        self.reset(np.ones(self.count, bool))

    def reset(self, who: NDArray[np.bool_]) -> None:
        """Some begin anew."""
        rng, stage = self.rng, self.stage
        for i in np.flatnonzero(who).tolist():
            human = self.people[i]
            human.restore_state(self.starts[i][int(rng.integers(len(self.starts[i])))])
            human.data.qvel[:] += stage.shaken * rng.normal(size=human.model.nv)
            memory = self.landings[i].memory
            memory[:] = 0.0
            memory[SINCE] = 1.0
            self.age[i], self.before[i] = rng.integers(0, 25), 0.0
            self.pushes.draw(
                i, rng, stage.pushed, stage.push, (int(self.age[i]), int(self.age[i]) + _PUSH_WITHIN)
            )

    def observe(self) -> NDArray[np.float64]:
        """What the policies observe, (n, LANDING_INPUTS)."""
        seen = np.empty((self.count, LANDING_INPUTS))
        for i, (human, landing) in enumerate(zip(self.people, self.landings, strict=True)):
            self.left[i] = landing.observe(human.run_up, human.control, human.on_feet.walk, human.data)
            seen[i] = landing.observed
        return seen

    def step(self, decided: NDArray[np.floating]) -> Outcome:
        """Do what the policies ``decided`` (n, ACTIONS) until the next decision."""
        action = decided.astype(np.float64)
        action[self.left] = action[self.left][:, MIRROR_JOINT] * SIGN_JOINT
        n = self.count
        tilt, hard, aside, slow = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
        fell, ended = np.zeros(n, bool), np.zeros(n, bool)
        for i, (human, landing) in enumerate(zip(self.people, self.landings, strict=True)):
            landing.memory[DECIDED] = action[i]
            self.pushes.apply(i, int(self.age[i]))
            for _ in range(TICKS_PER_DECISION):
                human.tick()
                if human.status == "fallen":
                    break
            tilt[i] = float(human.data.qpos[4:6] @ human.data.qpos[4:6])
            hard[i] = max(float(human.control[run.CONTACT].sum()) / (9.81 * MASS) - _HARD, 0.0)
            ahead, beside = human.control[run.COM_VELOCITY][:2]
            aside[i], slow[i] = abs(beside), abs(ahead - human.on_feet.speed)
            fell[i] = human.status == "fallen"
            ended[i] = not fell[i] and (human.status not in MOVING or not landing.decides)
        self.age += 1
        change = ((action - self.before) ** 2).mean(axis=1)
        self.before = action
        terms = {
            "up": np.full(n, 0.02),
            "tilt": -0.1 * tilt,
            "hard": -0.02 * hard,
            "aside": -0.01 * aside,
            "slow": -0.005 * slow,
            "effort": -0.004 * (action**2).mean(axis=1),
            "change": -0.004 * change,
            "fall": -_FALL * fell,
        }
        reward = np.sum(list(terms.values()), axis=0)
        over = ended | ((self.age >= LASTS // TICKS_PER_DECISION) & ~fell)
        means = {name: float(values.mean()) for name, values in terms.items()}
        means["falls of ends"] = float(fell.sum()) / max(float((fell | over).sum()), 1.0)
        return Outcome(reward, fell, over, np.zeros(n, bool), np.zeros((0,)), means)


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
