"""A person on its feet: how fast it lets itself become."""

from dataclasses import replace

import numpy as np

from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import load_run_skill
from locomotion.human.human import Human
from locomotion.human.state import MOVING


def test_people_with_the_same_skills_share_what_is_worked_out_from_them() -> None:
    skill = load_run_skill()
    one, other, third = Human(skill=skill), Human(skill=skill), Human(skill=replace(skill))
    assert one.on_feet.limits == other.on_feet.limits == third.on_feet.limits
    quick = [each.on_feet._quick_run for each in (one, other, third)]
    assert all((a == b).all() for a, b in zip(quick[0], quick[2], strict=True))
    assert quick[0][1] is not quick[2][1]  # of another skill


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
