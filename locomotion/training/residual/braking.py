"""Many people at once who brake from a run, corrected by a residual policy."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import MASS
from locomotion.gaits.brake import BrakeSkill, load_brake_skill
from locomotion.gaits.policy.layout import MIRROR_JOINT, SIGN_JOINT, TICKS_PER_DECISION
from locomotion.gaits.residual.layout import ACTIONS, DECIDED, INPUTS
from locomotion.gaits.run import layout as run
from locomotion.human.human import BetweenGaits, Human
from locomotion.human.state import HumanState
from locomotion.training.gaits.brake import draw_starts
from locomotion.training.policies.environment import Outcome
from locomotion.training.residual.pushes import Pushes

__all__ = ["SPEEDS", "BrakingPeople", "BrakingStage", "braking_group"]

SPEEDS = (2.0, 5.0)
"""[m/s] of the runs that they brake from."""

_PUSH_WITHIN = (0, 60)  # decisions
_FALL, _STANDS = 3.0, 1.0  # what a fall costs, and what a stand is worth
_HARD = 4.5  # body weights of ground reaction that cost nothing


@dataclass(frozen=True)
class BrakingStage:
    """A part of learning; all that it asks is drawn uniformly.

    Attributes:
      name: what it is about. samples: decisions to learn from.
      harder: how hard people brake, relative to the skill.
      pushed: share that is pushed; push: greatest force at the waist [N], for 0.1 s.
      noise: standard deviation of what is tried, at the stage's beginning and at its end.
      longest: decisions after which somebody begins anew.
    """

    name: str
    samples: int
    harder: tuple[float, float] = (0.9, 2.8)
    pushed: float = 0.0
    push: float = 0.0
    noise: tuple[float, float] = (0.3, 0.3)
    longest: int = 200


class BrakingPeople:
    """``count`` people who were told to stop in one of the ``starts``.

    Attributes:
      inputs, actions: numbers observed and decided.
    """

    inputs, actions = INPUTS, ACTIONS

    def __init__(self, skill: BrakeSkill, starts: Sequence[HumanState], count: int) -> None:
        self.count, self.starts = count, starts
        between = BetweenGaits(brake=skill, residual=None)
        self.people = [Human(None, clearing=(), rehearsals=0, between=between) for _ in range(count)]
        self.residuals = [human.on_feet.residual for human in self.people]
        self.age = np.zeros(count, np.int64)
        self.ahead = np.zeros((count, 2))
        self.before = np.zeros((count, ACTIONS))
        self.left = np.zeros(count, bool)
        self.pushes = Pushes(self.people)

    def begin(self, stage: BrakingStage, seed: int) -> None:
        """Everybody begins anew."""
        self.stage, self.rng = stage, np.random.default_rng(seed)
        self.reset(np.ones(self.count, bool))

    def reset(self, who: NDArray[np.bool_]) -> None:
        """Some begin anew."""
        rng, stage = self.rng, self.stage
        for i in np.flatnonzero(who).tolist():
            human = self.people[i]
            start = self.starts[int(rng.integers(len(self.starts)))]
            self.residuals[i].memory[:] = 0.0
            human.restore_state(start)
            human.stop()
            human.brake(float(rng.uniform(*stage.harder)))
            velocity = human.velocity[:2]
            self.ahead[i] = velocity / np.linalg.norm(velocity)
            self.age[i], self.before[i] = 0, 0.0
            self.pushes.draw(i, rng, stage.pushed, stage.push, _PUSH_WITHIN)

    def observe(self) -> NDArray[np.float64]:
        """What the policies observe, (n, INPUTS)."""
        seen = np.empty((self.count, INPUTS))
        for i, (human, residual) in enumerate(zip(self.people, self.residuals, strict=True)):
            self.left[i] = residual.observe(human.control, human.on_feet.walk, human.data)
            seen[i] = residual.observed
        return seen

    def step(self, decided: NDArray[np.floating]) -> Outcome:
        """Do what the policies ``decided`` (n, ACTIONS) until the next decision."""
        action = decided.astype(np.float64)
        action[self.left] = action[self.left][:, MIRROR_JOINT] * SIGN_JOINT
        n = self.count
        way, aside, tilt, hard = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
        fell, stood, ended = np.zeros(n, bool), np.zeros(n, bool), np.zeros(n, bool)
        for i, (human, residual) in enumerate(zip(self.people, self.residuals, strict=True)):
            residual.memory[DECIDED] = action[i]
            self.pushes.apply(i, int(self.age[i]))
            before = human.control[run.COM][:2].copy()
            for _ in range(TICKS_PER_DECISION):
                human.tick()
                if human.status == "fallen":
                    break
            moved = human.control[run.COM][:2] - before
            way[i] = float(self.ahead[i] @ moved)
            aside[i] = float(self.ahead[i, 0] * moved[1] - self.ahead[i, 1] * moved[0])
            tilt[i] = float(human.data.qpos[4:6] @ human.data.qpos[4:6])
            hard[i] = max(float(human.control[run.CONTACT].sum()) / (9.81 * MASS) - _HARD, 0.0)
            fell[i] = human.status == "fallen"
            stood[i] = not fell[i] and human.on_feet.at_rest(human.control)
            ended[i] = not (fell[i] or stood[i] or human.on_feet.brakes)
        self.age += 1
        change = ((action - self.before) ** 2).mean(axis=1)
        self.before = action
        terms = {
            "way": -np.abs(way),
            "aside": -np.abs(aside),
            "tilt": -0.1 * tilt,
            "hard": -0.02 * hard,
            "up": np.full(n, 0.01),
            "effort": -0.004 * (action**2).mean(axis=1),
            "change": -0.004 * change,
            "fall": -_FALL * fell,
            "stand": _STANDS * stood,
        }
        reward = np.sum(list(terms.values()), axis=0)
        done = fell | stood | ended
        over = (self.age >= self.stage.longest) & ~done
        means = {name: float(values.mean()) for name, values in terms.items()}
        means["falls of ends"] = float(fell.sum()) / max(float((done | over).sum()), 1.0)
        nobody = np.zeros(n, bool)
        return Outcome(reward, done, over, nobody, np.zeros((0,)), means)


def braking_group(count: int, starts: int, seed: int, number: int) -> BrakingPeople:
    """Group ``number`` of ``count`` people, who brake from ``starts`` runs of their own."""
    runs = draw_starts(np.random.default_rng([seed, 1, number]), starts, SPEEDS)
    return BrakingPeople(load_brake_skill(), runs, count)
