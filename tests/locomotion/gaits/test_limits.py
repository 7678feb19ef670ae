"""What a person can follow walking and running, and when it can begin to run."""

import math
from dataclasses import replace

import numpy as np
import pytest

from locomotion.body.observed import OBSERVED_SIZE, VELOCITY_X, VELOCITY_Y
from locomotion.gaits.limits import run_entry_speed, run_limits, walk_limits
from locomotion.gaits.run.skill import load_run_skill
from locomotion.gaits.walk.layout import CLOCK, DOUBLE, PHASE, SINGLE, WALK_HEADING, WALK_STEPS, new_walk
from locomotion.gaits.walk.skill import load_walk_skill


def test_a_run_is_followed_as_far_as_it_was_learned_with_something_left_for_corrections():
    skill = load_run_skill()
    limits = run_limits(skill)
    assert limits.speeds == (2.5, skill.speeds[1]) and limits.sideways == 0.8 * skill.max_lateral
    fast = run_limits(replace(skill, speeds=(3.0, 6.0), max_lateral=2.0))
    assert fast.speeds == (3.0, 6.0) and fast.sideways == pytest.approx(1.6)


def test_a_walk_goes_at_its_usual_pace_unless_a_faster_one_is_asked_for():
    skill = load_walk_skill()
    limits = walk_limits(skill)
    assert limits.speeds[1] == skill.speed > limits.calm == limits.usual
    assert limits.calm < run_limits(load_run_skill()).speeds[0]


def walking(heading=0.5, speed=1.3, phase=DOUBLE, clock=0.0, steps=3.0, drift=0.0):
    walk, observed = new_walk(), np.zeros(OBSERVED_SIZE)
    walk[[PHASE, CLOCK, WALK_STEPS, WALK_HEADING]] = phase, clock, steps, heading
    course = heading + drift
    observed[[VELOCITY_X, VELOCITY_Y]] = speed * math.cos(course), speed * math.sin(course)
    return walk, observed


def test_it_begins_to_run_at_its_speed_along_its_heading():
    assert run_entry_speed(*walking(), 0.5) == pytest.approx(1.3)
    assert run_entry_speed(*walking(), 0.5 + 2 * math.pi) == pytest.approx(1.3)
    assert run_entry_speed(*walking(drift=0.3), 0.6) == pytest.approx(1.3 * math.cos(0.3))


@pytest.mark.parametrize(
    ("changes", "heading"),
    [
        ({"phase": SINGLE}, 0.5),  # on one foot
        ({"clock": 0.01}, 0.5),  # a moment ago
        ({"steps": 2.0}, 0.5),  # has just set off
        ({"speed": 1.05}, 0.5),  # too slow
        ({}, 0.75),  # is to go elsewhere
        ({}, -0.5),
    ],
)
def test_it_does_not_begin_to_run_at_any_other_moment(changes, heading):
    assert run_entry_speed(*walking(**changes), heading) is None
