"""A machine is fitted to what decides, and its odds are calibrated."""

import numpy as np
import pytest

from locomotion.gaits.run.layout import STATE_SIZE
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.preconditions.features import FEATURES, describe, site_of
from locomotion.preconditions.moments import PLAN
from locomotion.preconditions.svm import odds_exactly
from locomotion.training.preconditions.fitting import (
    MOST,
    Samples,
    fit_machine,
    fit_precondition,
    ranked_features,
    samples_of,
)
from locomotion.training.preconditions.outcomes import STARTS, Outcomes

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


def outcomes(count=160):
    """Jumps that hold up to 0.6 m, with two moments each; of the first start one before a push."""
    rng = np.random.default_rng(4)
    starts = np.zeros((count, len(STARTS)))
    columns = {name: starts[:, k] for k, name in enumerate(STARTS)}
    columns["size"][:] = rng.uniform(0.1, 1.1, count)
    columns["distance"][:], columns["friction"][:] = rng.uniform(6.0, 12.0, count), 0.9
    ends = np.where(columns["size"] + rng.normal(0.0, 0.05, count) <= 0.6, 0, 3)
    ends[1] = 1  # it never took off
    rows = 2 * count
    wide = {"state": STATE_SIZE, "plan": len(PLAN), "variation": 2, "beside": 1}
    moments = {name: rng.normal(size=(rows, width)).astype(np.float32) for name, width in wide.items()}
    moments["off"] = np.arange(rows) % 2 == 1
    moments["unforeseen"] = np.arange(rows) == 0
    clean, first = np.ones(count, dtype=bool), 2 * np.arange(count + 1)
    return Outcomes("jump", starts, ends, clean, first, moments, {"seed": 4})


def test_each_moment_is_described_by_its_own_state_plan_and_obstacle():
    kept = outcomes()
    samples, row = samples_of(kept), np.empty(len(FEATURES))
    assert len(samples.holds) == 2 * 160 - 3 and samples.start.tolist()[:2] == [0, 2]
    moments = kept.moments
    for k, moment in ((0, 1), (5, 8), (6, 9)):  # what was left out came before
        start = moment // 2
        size, distance = kept.starts[start, [STARTS.index("size"), STARTS.index("distance")]]
        edge, normal = np.array([distance, 0.0, 0.0]), np.array([-1.0, 0.0, 0.0])
        site = site_of(ObstacleAhead(distance, "jump", size, edge, normal), 0.9)
        state, plan = (moments[name][moment].astype(float) for name in ("state", "plan"))
        farther, faster = moments["variation"][moment].astype(float)
        describe(state, plan, farther, faster, float(moments["beside"][moment, 0]), site, row)
        np.testing.assert_array_equal(samples.features[k], row)
        assert samples.start[k] == start and samples.holds[k] == (kept.ends[start] == 0)
        assert (samples.steps[k] == 0) == moments["off"][moment]
        assert samples.within[k] == (0.1 <= size <= 0.7)


def test_what_decides_is_learned_from_its_own_column():
    found = fit_precondition(outcomes())
    assert next(iter(found.meta["features"])) == "size"
    size = FEATURES.index("size")
    assert found.run_up.columns[0] == size and len(found.run_up.columns) == MOST
    asked = np.tile(samples_of(outcomes()).features.mean(axis=0), (2, 1))
    asked[:, size] = 0.2, 1.0
    low, high = found.odds(asked)
    assert low > 0.8 and high < 0.3
