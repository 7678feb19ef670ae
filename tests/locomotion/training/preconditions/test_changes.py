"""A change of gait is tried once, and the moment before it is noted."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion.preconditions.changes import BRAKE, END_RUN, SLOW_DOWN, WALK_TO_RUN
from locomotion.training.preconditions.changes import try_change
from locomotion.training.preconditions.starts import draw_change

EASY = replace(
    draw_change(SLOW_DOWN, np.random.default_rng(0)), distance=4.0, speed=3.5, friction=0.9, running=3.0,
    beside=0.0, askew=0.0, noise=0.0, push_ticks=0, variation=(1.0, 0.0),
)  # fmt: skip


@pytest.mark.parametrize(
    ("name", "running", "choice"),
    [(WALK_TO_RUN, 0.0, (0.0, 0.0)), (SLOW_DOWN, 3.0, (1.0, 0.0)), (BRAKE, 2.8, (2.5, 0.0)),
     (END_RUN, 3.0, (0.0, 0.0))],
)  # fmt: skip
def test_an_easy_change_holds_and_has_one_moment(name, running, choice):
    start = replace(EASY, running=running, variation=choice)
    outcome = try_change(name, start, np.random.default_rng(0))
    assert outcome.end == "holds" and outcome.clean and len(outcome.noted) == 1
    moment = outcome.noted[0].moment
    assert moment.variation.tolist() == list(choice) and moment.plan[3] == 0.9


def test_a_hopeless_change_does_not_hold():
    start = replace(EASY, friction=0.05)
    assert try_change(BRAKE, start, np.random.default_rng(0)).end != "holds"
