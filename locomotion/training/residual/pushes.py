"""Pushes at the waists of people who learn."""

import math
from collections.abc import Sequence

import numpy as np

from locomotion.gaits.policy.layout import POLICY_DT
from locomotion.human.human import Human

__all__ = ["Pushes"]

_TIME = 0.1  # [s] of a push
_WEAKEST = 0.2  # of the greatest push
_NEVER = -100  # decision at which nobody is pushed


class Pushes:
    """One push, or none, for each of ``people``, from any side.

    Attributes:
      begins: (n,) the decision at which it begins. force: (n, 2) [N].
    """

    def __init__(self, people: Sequence[Human]) -> None:
        self._people = people
        self.begins = np.full(len(people), _NEVER)
        self.force = np.zeros((len(people), 2))
        self._waist = people[0].model.body("waist").id

    def draw(
        self, person: int, rng: np.random.Generator, share: float, greatest: float, within: tuple[int, int]
    ) -> None:
        """Draw the push of a ``person`` who begins anew: with a chance of ``share``, of up to ``greatest``
        [N], at a decision from ``within[0]`` to below ``within[1]``."""
        pushed = rng.random() < share
        self.begins[person] = rng.integers(*within) if pushed else _NEVER
        force, angle = rng.uniform(_WEAKEST, 1.0) * greatest, rng.uniform(0.0, 2.0 * np.pi)
        self.force[person] = force * math.cos(angle), force * math.sin(angle)
        self._people[person].data.xfrc_applied[:] = 0.0

    def apply(self, person: int, decision: int) -> None:
        """Push a ``person`` in its ``decision``, or do not any more."""
        pushing = 0 <= decision - self.begins[person] < _TIME / POLICY_DT
        force = self.force[person] if pushing else 0.0
        self._people[person].data.xfrc_applied[self._waist, :2] = force
