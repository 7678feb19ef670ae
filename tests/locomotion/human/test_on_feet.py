"""A person on its feet: how fast it lets itself become."""

import numpy as np

from locomotion.gaits.run import controller
from locomotion.human.human import Human
from locomotion.human.state import MOVING


def test_a_person_told_to_run_fast_speeds_up_no_further_than_it_can_follow() -> None:
    human, fastest = Human(), 0.0
    human.reset([0.0, 0.0, 0.0], 0.0)
    human.follow(np.array([[0.0, 0.0, 0.0], [45.0, 0.0, 0.0]]), 4.8)
    while human.status in MOVING and human.com[0] < 30.0:
        human.tick()
        state = human.control
        if not human.on_feet.walks and state[controller.STEPS] > 3.0:
            fastest = max(fastest, float(state[controller.STEP_SPEED]))
            assert state[controller.SPEED] < max(3.75, state[controller.STEP_SPEED] + 1.1)
    assert human.status in MOVING and fastest > 4.5
