"""Kinds of jump to train: first guess, ranges of the parameters, cost of a trial."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from locomotion.clips.clip import Clip
from locomotion.gaits.run.skill import RunSkill
from locomotion.skills.jump import kernel as jump
from locomotion.skills.jump.skill import KIND, jump_clip
from locomotion.training.skills.jump_trial import JumpOutcome, JumpSimulator

__all__ = ["ENTRY_SPEED", "WEIGHTS", "JumpKind", "cost", "first_guess", "scales", "stair_jump"]

ENTRY_SPEED = 3.3
"""[m/s]"""
WEIGHTS: Mapping[str, float] = {
    "time": 10.0, "cleared": 3.0, "shortfall": 15.0, "scrape": 0.25, "speed": 0.8, "drift": 0.8,
    "reaction": 2.0, "effort": 0.03, "trunk": 3.0, "pose": 4.0,
}  # fmt: skip
"""What the terms of the objective weigh: that the person falls early, that it has not both feet behind the
edge in the end, how far [m] its feet miss the edge's height, ticks that something touches the face below it,
how far [m/s] the last steps are from the entry speed, sideways distance [m], ground reaction above 4 body
weights, squared torques, squared tilt [rad^2] of the trunk, squared distance [rad^2] from the clip."""


@dataclass(frozen=True)
class JumpKind:
    """A kind of jump. name: its file's kind. clip, affordance: played over what. simulator: of its trials on
    a run. entry [m/s], marks [m], pace, share: where learning starts. weights: as `WEIGHTS`."""

    name: str
    affordance: str
    clip: Clip
    simulator: Callable[[RunSkill], JumpSimulator]
    entry: float = ENTRY_SPEED
    marks: Sequence[float] = (1.95, 0.95)
    pace: Sequence[float] = (1.0, 0.75, 1.0, 1.0)
    share: float = 1.0
    weights: Mapping[str, float] = field(default_factory=lambda: WEIGHTS)

    def decide(self) -> dict[str, Any]:
        """What of it decides what is learned, by the names that a description has for it."""
        return {
            "affordance": self.affordance, "entry": self.entry, "marks": self.marks, "pace": self.pace,
            "share": self.share, "clip": self.clip.digest, "objective": dict(self.weights),
        }  # fmt: skip


def stair_jump() -> JumpKind:
    """The package's jump onto a stair."""
    return JumpKind(KIND, "jump", jump_clip(), JumpSimulator)


def first_guess(kind: JumpKind) -> np.ndarray:
    """Parameters (p,) from which learning starts: the clip in the place of the run; onto a stair it nearly
    clears 0.3 m."""
    x = np.zeros(sum(jump.PARAMETERS.values()))
    part = jump.parameter_slices()
    x[part["beta"]] = kind.pace
    x[part["alpha"]] = kind.share
    x[part["marks"]] = kind.marks
    m_ap = np.zeros((9, jump.RANK))
    m_ap[0, 0] = m_ap[3, 1] = m_ap[1, 2] = 1.0
    m_ap[6, 1] = 0.5
    x[part["m_ap"]] = m_ap.ravel()
    x[part["entry"]] = kind.entry
    return x


def scales(feedback: bool) -> np.ndarray:
    """How far a parameter may reasonably move, (p,) float64; without ``feedback`` its parameters stay."""
    x = np.zeros(sum(jump.PARAMETERS.values()))
    part = jump.parameter_slices()
    x[part["a_hat"]] = 0.35
    x[part["lateral"]] = 0.08
    x[part["beta"]] = 0.12
    x[part["alpha"]] = 0.2
    x[part["marks"]] = 0.12
    if feedback:
        x[part["gains"]] = np.tile(np.r_[np.full(6, 0.5), 0.4, np.full(6, 0.25), 0.2], 3)
        spread = np.array([0.1, 1.0, 0.1, 0.4, 0.8, 0.15, 0.08, 0.15, 1.0, 1.0, 0.25, 0.05, 0.1, 0.1, 0.08])
        x[part["m_sp"]] = np.tile(0.06 / spread, jump.RANK)
        x[part["m_ap"]] = 0.4
    return x


def cost(outcome: JumpOutcome, entry: float, weights: Mapping[str, float] = WEIGHTS) -> float:
    """Objective of one trial."""
    terms = {
        "time": 1.0 - outcome.time,
        "cleared": not outcome.cleared,
        "shortfall": min(outcome.shortfall, 1.0),
        "scrape": min(outcome.scrape, 12),
        "speed": abs(outcome.speed - entry) if outcome.steps >= 2 else 1.5,
        "drift": min(outcome.drift, 1.0),
        "reaction": outcome.reaction,
        "effort": outcome.effort,
        "trunk": outcome.trunk,
        "pose": outcome.pose,
    }
    return float(sum(weights[name] * term for name, term in terms.items()))
