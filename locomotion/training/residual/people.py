"""What people who learn to be corrected have in common, whatever they do meanwhile."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import MASS
from locomotion.gaits.policy.layout import MIRROR_JOINT, SIGN_JOINT, TICKS_PER_DECISION
from locomotion.gaits.residual.layout import ACTIONS, DECIDED
from locomotion.gaits.run import layout as run
from locomotion.human.human import Human
from locomotion.human.residual import Correction
from locomotion.training.policies.environment import Outcome
from locomotion.training.residual.pushes import Pushes

__all__ = ["CorrectedPeople", "Moved", "outcome"]

_FALL = 3.0  # what a fall costs
_HARD = 4.5  # body weights of ground reaction that cost nothing


class Moved(NamedTuple):
    """After a decision of a person: how far its trunk tilts (squared), by how many body weights the ground
    pushes too hard, and whether it has fallen."""

    tilt: float
    hard: float
    fell: bool


class CorrectedPeople(ABC):
    """People whose ``corrections`` a policy decides.

    Attributes:
      count: people. age: (n,) decisions since each began. before: (n, ACTIONS) what was decided last.
      left: (n,) whether what each observed was the mirror image. pushes: of them all.
    """

    actions = ACTIONS

    def __init__(self, people: Sequence[Human], corrections: Sequence[Correction]) -> None:
        self.people, self.corrections, self.count = people, corrections, len(people)
        self.age = np.zeros(self.count, np.int64)
        self.before = np.zeros((self.count, ACTIONS))
        self.left = np.zeros(self.count, bool)
        self.pushes = Pushes(people)

    def begin(self, stage: Any, seed: int) -> None:
        """Everybody begins anew."""
        self.stage, self.rng = stage, np.random.default_rng(seed)
        self.reset(np.ones(self.count, bool))

    def reset(self, who: NDArray[np.bool_]) -> None:
        """Some begin anew."""
        for i in np.flatnonzero(who).tolist():
            self._begin_anew(i, self.people[i])

    @abstractmethod
    def _begin_anew(self, i: int, human: Human) -> None: ...

    def _in_own_sides(self, decided: NDArray[np.floating]) -> NDArray[np.float64]:
        """Decisions (n, ACTIONS) in each person's own left and right."""
        action = decided.astype(np.float64)
        action[self.left] = action[self.left][:, MIRROR_JOINT] * SIGN_JOINT
        return action

    def _move(self, i: int, action: NDArray[np.float64]) -> Moved:
        """Let a person go on until its next decision."""
        human = self.people[i]
        self.corrections[i].memory[DECIDED] = action
        self.pushes.apply(i, int(self.age[i]))
        for _ in range(TICKS_PER_DECISION):
            human.tick()
            if human.status == "fallen":
                break
        weights = float(human.control[run.CONTACT].sum()) / (9.81 * MASS)
        tilt = float(human.data.qpos[4:6] @ human.data.qpos[4:6])
        return Moved(tilt, max(weights - _HARD, 0.0), human.status == "fallen")

    def _usual_terms(self, action: NDArray[np.float64], moved: Sequence[Moved]) -> dict[str, NDArray]:
        """Terms of the reward that all have, after everybody was moved."""
        tilt, hard, fell = (np.array(each) for each in zip(*moved, strict=True))
        self.age += 1
        change = ((action - self.before) ** 2).mean(axis=1)
        self.before = action
        return {
            "tilt": -0.1 * tilt,
            "hard": -0.02 * hard,
            "effort": -0.004 * (action**2).mean(axis=1),
            "change": -0.004 * change,
            "fall": -_FALL * fell,
        }


def outcome(terms: dict[str, NDArray], done: NDArray[np.bool_], over: NDArray[np.bool_]) -> Outcome:
    """What comes of a decision: the ``terms`` of its reward, for whom it is ``done``, whose time is over."""
    means = {name: float(values.mean()) for name, values in terms.items()}
    means["falls of ends"] = float((terms["fall"] < 0.0).sum()) / max(float((done | over).sum()), 1.0)
    reward = np.sum(list(terms.values()), axis=0)
    return Outcome(reward, done, over, np.zeros(len(done), bool), np.zeros((0,)), means)
