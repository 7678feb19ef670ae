"""Learning to run: several beginnings, and what a fall costs."""

from pathlib import Path

import numpy as np
import pytest

from locomotion.training.gaits.run import begin
from locomotion.training.gaits.run_trials import TrialKind, draw_scenario
from locomotion.training.progress import Clock
from locomotion.training.search.loop import Stage, learn
from locomotion.training.training import Training
from tests.locomotion.training.tiny import tiny_problem


def test_running_goes_on_from_the_best_of_several_beginnings(tmp_path: Path) -> None:
    problem = tiny_problem()
    training = Training(7, tmp_path, workers=1, on_progress=lambda progress: None)
    genes = begin(training, problem.stages(), Clock(1.0), count=3)
    each = [learn(problem, 7 + k, None, 1, lambda progress: None) for k in range(3)]
    trials = [
        draw_scenario(np.random.default_rng(k), TrialKind(**problem.stages()[-1].options["trial"]))
        for k in range(9)
    ]
    costs = [problem.evaluate(problem.stages()[-1], x, trials)[0] for x in each]
    assert any(np.array_equal(genes, x) for x in each)
    np.testing.assert_array_equal(genes, each[int(np.argmin(costs))])
    np.testing.assert_array_equal(begin(training, problem.stages(), Clock(1.0), count=3), genes)


def test_a_fall_costs_what_its_stage_says_and_a_trial_that_lasts_nothing() -> None:
    problem, rng = tiny_problem(), np.random.default_rng(2)
    lasts, falls = draw_scenario(rng, TrialKind(0.2)), draw_scenario(rng, TrialKind(3.0, push=3000.0))
    for trials, more in (([lasts], 0.0), ([falls], 6.0), ([lasts, falls], 3.0)):
        free, dear = (
            Stage("a", 1, 0.1, np.ones(1), {"style": 0.3, "fall": fall, "soft": 0.0}) for fall in (0.0, 6.0)
        )
        free, dear = (problem.evaluate(stage, problem.genes, trials)[0] for stage in (free, dear))
        assert dear - free == pytest.approx(more)
