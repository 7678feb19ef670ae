"""Learning to slow down."""

import numpy as np

from locomotion.gaits.run.skill import load_run_skill
from locomotion.gaits.slow_down import load_slow_down_skill
from locomotion.training.gaits.slow_down import draw_halt, first_guess, halt, slow_down_of


def test_learning_prefers_those_that_stand_in_the_end():
    run, drawn = load_run_skill(), [draw_halt(np.random.default_rng([3, k])) for k in range(4)]
    good = [halt(trial, run, load_slow_down_skill()) for trial in drawn]
    x = first_guess()
    x[: x.size // 3] += 0.5
    bad = [halt(trial, run, slow_down_of(x)) for trial in drawn]
    assert np.mean([cost for cost, _ in good]) < np.mean([cost for cost, _ in bad])
    assert sum(stood for _, stood in good) > sum(stood for _, stood in bad)
