"""A machine is fitted to what decides, and its odds are calibrated."""

import numpy as np
import pytest

from locomotion.preconditions.svm import odds_exactly
from locomotion.training.preconditions.fitting import MOST, Samples, fit_machine, ranked_features

pytest.importorskip("sklearn")


def samples(rng, count=1200):
    """Of six features the third decides, with noise; and a little the first."""
    features = rng.normal(size=(count, 6))
    chance = 1.0 / (1.0 + np.exp(-(2.5 - 2.0 * features[:, 2] ** 2 + 0.8 * features[:, 0])))
    holds = rng.random(count) < chance
    start = np.repeat(np.arange(count // 3), 3)
    return Samples(features, holds, start, np.ones(count, dtype=bool), np.zeros(count, dtype=int)), chance


def test_the_features_that_decide_come_first_and_the_odds_are_near_the_chances():
    seen, _ = samples(np.random.default_rng(1))
    ranked = ranked_features(seen, 0)
    assert ranked[0][0] == 2 and ranked[0][1] > 5.0 * ranked[2][1] and len(ranked) == 6 <= MOST
    machine = fit_machine(seen, ranked[:3], 0, centres=32)
    unseen, chance = samples(np.random.default_rng(2))
    odds = odds_exactly(machine, unseen.features)
    assert np.abs(odds - chance).mean() < 0.12
    sure = odds > 0.8
    assert abs(unseen.holds[sure].mean() - odds[sure].mean()) < 0.07


def test_the_same_samples_give_the_same_machine():
    seen, _ = samples(np.random.default_rng(1), 300)
    one, other = (fit_machine(seen, [(2, 0.1), (0, 0.05)], 0, centres=16) for _ in range(2))
    assert all((a == b).all() for a, b in zip(one, other, strict=True))
