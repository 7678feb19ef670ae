"""Learning to speed up."""

import numpy as np

from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import load_run_skill
from locomotion.training.gaits.speed_up import SpeedUpProblem, _curriculum
from locomotion.training.training import Training


def test_a_candidate_that_falls_costs_more():
    problem = SpeedUpProblem(_curriculum(Training(effort=0.1)), load_run_skill())
    stage, start = problem.stages()[0], problem.start()
    trials = problem.scenarios(stage, 0, np.random.default_rng(1))[:2]
    bad = start.copy()
    bad[controller.parameter_slices()["a_hat"]] = 1.0
    assert problem.evaluate(stage, bad, trials)[0] > problem.evaluate(stage, start, trials)[0]
    assert problem.evaluate(stage, bad, trials)[1] == 0.0
