"""Who is drawn in how much detail."""

import math

import numpy as np
import pytest

from runtime import Budget, RuntimeInputError, Viewer
from runtime.world.level_of_detail import LEVELS, checked_detail, levels_for

VIEWER = Viewer((0.0, 0.0, 1.7), (1.0, 0.0, 0.0), math.radians(80.0))
LOW = np.full(400, 3)


def names(levels):
    return [LEVELS[level] for level in levels]


def test_the_nearest_in_view_are_the_most_detailed():
    places = np.column_stack([np.arange(1.0, 401.0), np.zeros(400), np.zeros(400)])
    levels = levels_for(places, LOW, np.zeros(400, bool), [VIEWER], Budget(physics=5, full=10, medium=20))
    assert names(levels[:36]) == ["physics"] * 5 + ["full"] * 10 + ["medium"] * 20 + ["low"]
    near = levels_for(places, LOW, np.zeros(400, bool), [VIEWER], Budget(physics=50, physics_within=7.5))
    assert (near == 0).sum() == 7
    assert set(names(levels_for(places, LOW, np.zeros(400, bool), [], Budget()))) == {"low"}


def test_what_nobody_sees_counts_as_farther_off():
    places = np.array([[12.0, 0.0, 0.0], [-8.0, 0.0, 0.0]])
    levels = levels_for(places, LOW[:2], np.zeros(2, bool), [VIEWER], Budget(physics=1))
    assert names(levels) == ["physics", "full"]
    both = [VIEWER, Viewer((0, 0, 1.7), (-1.0, 0.0, 0.0))]
    assert names(levels_for(places, LOW[:2], np.zeros(2, bool), both, Budget(physics=1))) == [
        "full",
        "physics",
    ]


def test_nobody_changes_back_and_forth_at_a_border():
    budget = Budget(physics=1)
    rng, changes = np.random.default_rng(0), 0
    now = np.array([0, 1])
    for _ in range(200):
        places = np.array([[10.0, 0.0, 0.0], [10.0, 1.0, 0.0]]) + rng.normal(0, 0.3, (2, 3))
        levels = levels_for(places, now, np.zeros(2, bool), [VIEWER], budget)
        changes += (levels != now).any()
        now = levels
    assert changes == 0


def test_those_of_fixed_detail_keep_it_and_count():
    places = np.array([[5.0, 0, 0], [6.0, 0, 0], [90.0, 0, 0], [7.0, 0, 0]])
    fixed, now = np.array([False, False, True, True]), np.array([3, 3, 0, 3])
    levels = levels_for(places, now, fixed, [VIEWER], Budget(physics=2))
    assert names(levels) == ["physics", "full", "physics", "low"]


def test_a_budget_of_milliseconds_is_turned_into_counts():
    small, great = (Budget.for_milliseconds(ms, 300) for ms in (5.0, 20.0))
    assert small.physics < great.physics and small.full <= great.full
    assert Budget.for_milliseconds(0.0, 300).physics == 0


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Viewer((0, 0)), "the position of a viewer"),
        (lambda: Viewer((0, 0, 0), (0, 0, 0)), "has no length"),
        (lambda: Viewer((0, 0, 0), field_of_view=7.0), "at most 2π"),
        (lambda: Viewer((0, 0, float("nan"))), "finite"),
        (lambda: Budget(physics=-1), "physics must be a whole number"),
        (lambda: Budget(full_within=-1.0), "full_within must be"),
        (lambda: checked_detail("high", LEVELS, "human"), "valid: auto, physics, full, medium, low"),
        (lambda: checked_detail("auto", ("physics",), "dog"), "valid: physics"),
    ],
)
def test_mistakes_are_told(make, says):
    with pytest.raises(RuntimeInputError, match=says):
        make()
