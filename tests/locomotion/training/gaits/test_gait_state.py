"""One state for the figures of a run and of a walk."""

import numpy as np
import pytest

from locomotion.gaits.run import layout as run
from locomotion.human.human import Human
from locomotion.training.gaits.gait_state import gait_state


def test_a_run_is_its_own_controllers_state():
    human = Human(clearing=(), rehearsals=0)
    human.reset((0, 0, 0), 0.0, 3.0)
    human.follow([[0, 0, 0], [20, 0, 0]], 3.0)
    human.tick()
    assert gait_state(human) is human.control and human.control[run.SPEED] > 2.0


def test_a_walk_tells_its_own_heading_speed_and_steps_and_what_is_observed_of_the_body():
    human = Human(clearing=(), rehearsals=0)
    human.reset((0, 0, 0), 0.3)
    human.follow([[0, 0, 0], [3 * np.cos(0.3), 3 * np.sin(0.3), 0]], 1.0)
    for _ in range(150):
        human.tick()
    before = human.control.copy()
    state = gait_state(human)
    assert state[run.HEADING] == pytest.approx(0.3, abs=0.1) and 0.5 < state[run.SPEED] <= 1.0
    assert state[run.STEPS] >= 2.0 and state[run.STANCE] in (-1.0, 1.0)
    assert np.array_equal(state[run.OBSERVED], human.control[run.OBSERVED])
    assert np.array_equal(human.control, before)  # a copy: the run's own memory stays
