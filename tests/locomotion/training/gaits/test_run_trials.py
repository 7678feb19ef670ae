"""Random trials of a run, and what they cost."""

import itertools

import numpy as np
import pytest

from locomotion.training.gaits.rollout import FIGURES, Trial
from locomotion.training.gaits.run_trials import TrialKind, cost, draw_scenario


def test_trials_of_circles_turn_sharply_one_way_and_blows_are_hard() -> None:
    drawn = [
        draw_scenario(np.random.default_rng(k), TrialKind(9.0, (4.0, 4.0), lateral=1.6, circle=True))
        for k in range(99)
    ]
    turns = np.array([trial.headings[:, 1] for trial in drawn])
    assert np.all(turns == turns[:, :1])
    assert np.all(np.abs(4.0 * turns) >= 0.6 * 1.6 - 1e-12) and np.all(np.abs(4.0 * turns) <= 1.6 + 1e-12)
    assert 30 < np.sum(turns[:, 0] > 0.0) < 70
    blows = [
        draw_scenario(np.random.default_rng(k), TrialKind(9.0, push=330.0, weakest=0.8)) for k in range(99)
    ]
    force = np.concatenate([np.hypot(*trial.pushes[:, 1:3].T) for trial in blows])
    assert force.min() >= 0.8 * 330.0 - 1e-9 and force.max() <= 330.0 + 1e-9


def test_whoever_falls_sooner_is_not_better_off_for_what_it_is_spared() -> None:
    figures = dict.fromkeys(FIGURES, 0.0)
    trials = [
        Trial(figures | {"time": t, "speed_error": 0.75 * t}, np.zeros(0)) for t in (0.3, 0.6, 0.9, 1.2)
    ]
    costs = [cost(trial, 4.0, style=0.3) for trial in trials]
    assert all(later < sooner for sooner, later in itertools.pairwise(costs))
    hopeless = Trial(figures | {"time": 4.0, "speed_error": 50.0}, np.zeros(0))
    assert cost(hopeless, 4.0, style=0.3) == 10.0


def test_a_run_that_steps_as_often_as_a_captured_person_costs_least() -> None:
    def costs(speed: float, soft: float = 0.0) -> np.ndarray:
        figures = dict.fromkeys(FIGURES, 0.0) | {"time": 4.0, "speed": speed}
        trials = [Trial(figures | {"step_rate": rate}, np.zeros(0)) for rate in rates]
        return np.array([cost(trial, 4.0, style=0.0, soft=soft) for trial in trials])

    rates = np.arange(2.0, 5.0, 0.01)
    assert rates[np.argmin(costs(5.26))] == pytest.approx(3.69)
    assert rates[np.argmin(costs(3.5))] == pytest.approx(3.44, abs=0.006)  # equation 8
    np.testing.assert_allclose(costs(3.5, soft=2.0), 3.0 * costs(3.5))
