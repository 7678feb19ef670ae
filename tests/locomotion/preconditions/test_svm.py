"""The kernel gives the odds of the plain formula, and those of scikit-learn."""

import numpy as np
import pytest

from locomotion.preconditions.svm import Machine, decide_exactly, odds_exactly, odds_into


def machine(rng, features=5, counting=3, centres=7):
    return Machine(
        np.sort(rng.permutation(features)[:counting]).astype(np.int32),
        np.full(counting, -1.0), np.full(counting, 2.0),
        rng.normal(size=counting), rng.uniform(0.5, 2.0, counting), rng.normal(size=(counting, centres)),
        rng.normal(size=centres), np.array([0.3, 0.1, 2.0, -0.5]),
    )  # fmt: skip


def test_the_kernel_says_what_the_formula_says():
    rng = np.random.default_rng(2)
    learned, asked = machine(rng), 3.0 * rng.normal(size=(32, 5))
    told, before = np.empty(32), asked.copy()
    odds_into(*learned, asked, told)
    np.testing.assert_allclose(told, odds_exactly(learned, asked), rtol=1e-12)
    assert (asked == before).all() and ((told > 0.0) & (told < 1.0)).all()


def test_beyond_what_was_sampled_the_nearest_sample_counts():
    learned = machine(np.random.default_rng(4), counting=5)
    near, far = np.full((1, 5), 2.0), np.full((1, 5), 900.0)
    assert odds_exactly(learned, near) == odds_exactly(learned, far) != odds_exactly(learned, -near)


def test_the_decisions_are_those_of_scikit_learn():
    pytest.importorskip("sklearn")
    from sklearn.kernel_approximation import Nystroem
    from sklearn.pipeline import make_pipeline
    from sklearn.svm import LinearSVC

    rng = np.random.default_rng(7)
    seen = rng.normal(size=(300, 3))
    holds = (seen**2).sum(axis=1) < 2.5
    model = make_pipeline(
        Nystroem(gamma=0.4, n_components=24, random_state=0), LinearSVC(dual=False, random_state=0)
    ).fit(seen, holds)
    mapped, linear = model[0], model[1]
    own = Machine(
        np.arange(3, dtype=np.int32), seen.min(axis=0), seen.max(axis=0), np.zeros(3), np.ones(3),
        np.ascontiguousarray(mapped.components_.T), mapped.normalization_.T @ linear.coef_[0],
        np.array([0.4, linear.intercept_[0], 1.0, 0.0]),
    )  # fmt: skip
    np.testing.assert_allclose(decide_exactly(own, seen), model.decision_function(seen), atol=1e-9)
    told = np.empty(300)
    odds_into(*own, seen, told)
    np.testing.assert_allclose(told, 1.0 / (1.0 + np.exp(-model.decision_function(seen))), atol=1e-9)
