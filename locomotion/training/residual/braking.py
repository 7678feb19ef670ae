"""Many people at once who brake from a run, corrected by a residual policy."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.gaits.brake import BrakeSkill, load_brake_skill
from locomotion.gaits.residual.layout import INPUTS
from locomotion.gaits.run import layout as run
from locomotion.human.human import BetweenGaits, Human
from locomotion.human.state import HumanState
from locomotion.training.gaits.brake import draw_starts
from locomotion.training.policies.environment import Outcome
from locomotion.training.residual.people import CorrectedPeople, outcome

__all__ = ["SPEEDS", "BrakingPeople", "BrakingStage", "braking_group"]

SPEEDS = (2.0, 5.0)
"""[m/s] of the runs that they brake from."""

_PUSH_WITHIN = (0, 60)  # decisions
_STANDS = 1.0  # what a stand is worth


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


class BrakingPeople(CorrectedPeople):
    """``count`` people who were told to stop in one of the ``starts``.

    Attributes:
      inputs, actions: numbers observed and decided.
    """

    inputs = INPUTS

    def __init__(self, skill: BrakeSkill, starts: Sequence[HumanState], count: int) -> None:
        between = BetweenGaits(brake=skill, residual=None)
        people = [Human(None, clearing=(), rehearsals=0, between=between) for _ in range(count)]
        super().__init__(people, [human.on_feet.residual for human in people])
        self.starts, self.ahead = starts, np.zeros((count, 2))

    def _begin_anew(self, i: int, human: Human) -> None:
        rng, stage = self.rng, self.stage
        start = self.starts[int(rng.integers(len(self.starts)))]
        self.corrections[i].forget()
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
        for i, human in enumerate(self.people):
            residual = human.on_feet.residual
            self.left[i] = residual.observe(human.control, human.on_feet.walk, human.data)
            seen[i] = residual.observed
        return seen

    def step(self, decided: NDArray[np.floating]) -> Outcome:
        """Do what the policies ``decided`` (n, ACTIONS) until the next decision."""
        action, n, moved = self._in_own_sides(decided), self.count, []
        way, aside = np.zeros(n), np.zeros(n)
        stood, ended = np.zeros(n, bool), np.zeros(n, bool)
        for i, human in enumerate(self.people):
            before = human.control[run.COM][:2].copy()
            moved.append(self._move(i, action[i]))
            by = human.control[run.COM][:2] - before
            way[i] = float(self.ahead[i] @ by)
            aside[i] = float(self.ahead[i, 0] * by[1] - self.ahead[i, 1] * by[0])
            fell = moved[i].fell
            stood[i] = not fell and human.on_feet.at_rest(human.control)
            ended[i] = fell or stood[i] or not human.on_feet.brakes
        terms = self._usual_terms(action, moved) | {
            "way": -np.abs(way),
            "aside": -np.abs(aside),
            "up": np.full(n, 0.01),
            "stand": _STANDS * stood,
        }
        over = (self.age >= self.stage.longest) & ~ended
        return outcome(terms, ended, over)


def braking_group(count: int, starts: int, seed: int, number: int) -> BrakingPeople:
    """Group ``number`` of ``count`` people, who brake from ``starts`` runs of their own."""
    runs = draw_starts(np.random.default_rng([seed, 1, number]), starts, SPEEDS)
    return BrakingPeople(load_brake_skill(), runs, count)
