"""How good the odds of preconditions are, on starts that they were not learned from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import rankdata

from locomotion.preconditions.precondition import Precondition
from locomotion.training.preconditions.fitting import samples_before, samples_of
from locomotion.training.preconditions.outcomes import Outcomes

__all__ = ["NEEDS", "Bin", "Judgement", "area_under_curve", "bins_of", "judge", "judged"]

NEEDS = 0.5
"""Odds from which false goes and false stops are counted."""
BINS = 10
MOMENTS = {
    "before the run-up": None,
    "5 or more steps left": (5, 99),
    "3 or 4 steps left": (3, 4),
    "1 or 2 steps left": (1, 2),
    "at take-off": (0, 0),
}
"""When the odds of a skill are asked: steps that are left."""
BEFORE_CHANGE = {"before the change": (0, 0)}


@dataclass(frozen=True)
class Bin:
    """Moments whose odds are alike: how many, mean of their odds, and share that held."""

    count: int
    odds: float
    held: float


@dataclass(frozen=True)
class Judgement:
    """How good odds are at a ``moment`` of `MOMENTS`. within: only sizes that people are to clear.

    count: moments. held: share that held. area: under the curve of hits over false alarms, NaN where all end
    alike. brier: mean squared error of the odds; usual: that of always saying ``held``. false_go: share that
    fails of those with odds of at least `NEEDS`; false_stop: share that holds of the others; stopped: share
    of the others.
    """

    skill: str
    moment: str
    within: bool
    count: int
    held: float
    area: float
    brier: float
    usual: float
    false_go: float
    false_stop: float
    stopped: float


def area_under_curve(odds: NDArray[np.float64], holds: NDArray[np.bool_]) -> float:
    """Chance that one that holds has higher odds than one that does not; NaN where all end alike."""
    good, bad = int(holds.sum()), int((~holds).sum())
    if not good or not bad:
        return float("nan")
    return float((rankdata(odds)[holds].sum() - 0.5 * good * (good + 1)) / (good * bad))


def judged(
    skill: str, moment: str, within: bool, odds: NDArray[np.float64], holds: NDArray[np.bool_]
) -> Judgement:
    """Judge ``odds`` (n,) by what came of it (n,)."""
    go, held = odds >= NEEDS, float(holds.mean())
    return Judgement(
        skill, moment, within, len(odds), held, area_under_curve(odds, holds),
        float(((odds - holds) ** 2).mean()), held * (1.0 - held),
        float((~holds[go]).mean()) if go.any() else float("nan"),
        float(holds[~go].mean()) if not go.all() else float("nan"), float((~go).mean()),
    )  # fmt: skip


def bins_of(odds: NDArray[np.float64], holds: NDArray[np.bool_]) -> list[Bin]:
    """A reliability diagram: moments by their odds, in tenths; those without any are left out."""
    number = np.minimum((odds * BINS).astype(int), BINS - 1)
    alike = [number == k for k in range(BINS) if (number == k).any()]
    return [Bin(int(each.sum()), float(odds[each].mean()), float(holds[each].mean())) for each in alike]


def judge(precondition: Precondition, outcomes: Outcomes) -> tuple[list[Judgement], list[Bin]]:
    """Judge a precondition by ``outcomes`` of its skill: before a change, or at each of `MOMENTS`,
    over all sizes and over those that people are to clear; and its reliability in all run-ups."""
    samples, found = samples_of(outcomes), []
    odds = precondition.odds(samples.features)
    for moment, steps in (BEFORE_CHANGE if precondition.before is None else MOMENTS).items():
        asked, at = odds, samples
        if steps is None:
            at = samples_before(outcomes)
            asked, then = precondition.odds_before(at.features), np.ones(len(at.holds), dtype=bool)
        else:
            then = (samples.steps >= steps[0]) & (samples.steps <= steps[1])
        for within in (False,) if precondition.before is None else (False, True):
            chosen = then & at.within if within else then
            if chosen.any():
                found.append(judged(precondition.skill, moment, within, asked[chosen], at.holds[chosen]))
    return found, bins_of(odds, samples.holds)
