"""Starts are drawn from their numbers, in and beyond the range of a skill."""

import numpy as np

from locomotion.preconditions.changes import BRAKE, CHANGES, WALK_TO_RUN
from locomotion.skills.registry import skill_called
from locomotion.training.preconditions.starts import draw_change, draw_slow_down, draw_start


def test_starts_cover_what_is_easy_and_what_is_hopeless():
    kind = skill_called("vault")
    starts = [draw_start(kind, np.random.default_rng([1, k])) for k in range(400)]
    size = np.array([each.size for each in starts])
    within = (size >= 0.6) & (size <= 1.0)
    assert 0.65 < within.mean() < 0.85 and size.min() < 0.5 and 1.3 < size.max() <= 1.4
    assert 0.2 < np.mean([each.push_ticks > 0 for each in starts]) < 0.4
    assert 0.5 < np.mean([each.running == 0.0 for each in starts]) < 0.8
    friction = np.array([each.friction for each in starts])
    assert friction.min() < 0.75 and friction.max() > 1.7 and 0.5 < (friction == 0.9).mean() < 0.7
    assert starts[7] == draw_start(kind, np.random.default_rng([1, 7]))


def test_a_run_up_is_broken_off_at_the_usual_stair():
    start = draw_slow_down(np.random.default_rng(2))
    assert start.size == 0.4 and 0.6 <= start.variation[0] <= 3.0 and 0 <= start.from_step < 8


def test_changes_are_chosen_all_over_their_ranges():
    drawn = {name: [draw_change(name, np.random.default_rng([3, k])) for k in range(200)] for name in CHANGES}
    assert all(each.running == 0.0 for each in drawn[WALK_TO_RUN])
    assert 0.4 < np.mean([each.variation[0] for each in drawn[WALK_TO_RUN]]) < 0.6
    harder = np.array([each.variation[0] for each in drawn[BRAKE]])
    assert 0.9 <= harder.min() < 1.1 and 2.6 < harder.max() <= 2.8
    assert all(2.2 <= each.running <= 4.4 for each in drawn[BRAKE])
