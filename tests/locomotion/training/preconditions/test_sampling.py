"""A start is tried once, and the moments of its run-up are noted."""

from dataclasses import replace

import numpy as np
import pytest

from locomotion import Human
from locomotion.skills.registry import skill_called
from locomotion.training.preconditions.sampling import ENDS, WiderSkill, try_slow_down, try_start
from locomotion.training.preconditions.starts import draw_slow_down, draw_start

KIND = skill_called("jump")
EASY = replace(
    draw_start(KIND, np.random.default_rng(0)), size=0.3, distance=6.0, speed=3.5, friction=0.9, running=3.0,
    beside=0.0, askew=0.0, noise=0.0, push_ticks=0, variation=(0.03, 0.1), from_step=1,
)  # fmt: skip


def test_an_easy_start_holds_and_its_steps_are_noted_down_to_the_take_off():
    outcome = try_start(KIND, EASY, np.random.default_rng(0))
    steps = [noted.moment.plan[0] for noted in outcome.noted]
    assert outcome.end == "holds" and steps == sorted(steps, reverse=True) and steps[-1] == 0.0
    assert [noted.off for noted in outcome.noted] == [False] * (len(steps) - 1) + [True]
    assert all(noted.moment.variation.tolist() == [0.03, 0.1] for noted in outcome.noted)


def test_a_hopeless_start_does_not_hold():
    outcome = try_start(KIND, replace(EASY, size=1.3), np.random.default_rng(0))
    assert outcome.end == "fell in the skill" and not outcome.clean


def test_who_slows_down_has_one_moment():
    start = replace(
        draw_slow_down(np.random.default_rng(1)), distance=12.0, running=0.0, from_step=5, push_ticks=0
    )
    outcome = try_slow_down(start, np.random.default_rng(1))
    assert outcome.end in ENDS and len(outcome.noted) == 1
    assert outcome.noted[0].moment.variation.tolist() == list(start.variation)


@pytest.mark.parametrize("kind", ["vault", "drop-roll"])
def test_a_wider_skill_tries_what_is_out_of_its_range(kind):
    skill = next(each for each in Human().clearing if each.affordance == skill_called(kind).affordance)
    wide = WiderSkill(skill)
    assert wide.heights[1] > 2.0 * skill.heights[1] and wide.affordance == skill.affordance
    assert wide.approach(skill.heights[1]) == wide.approach(5.0) and wide.ends == skill.ends
    assert wide.stride == skill.stride
