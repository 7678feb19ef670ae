"""What of a way is loaded, and what comes later."""

import dataclasses

import numpy as np
import pytest

from runtime import RuntimeInputError
from runtime.planning.beyond import Beyond, loaded_part
from runtime.planning.planning import NoWay
from tests.runtime.strip import END, ISLAND, START, strip

RADIUS = 0.3


def part(world, *goals, start=START):
    return loaded_part(world, np.array(start), np.array(goals, float), RADIUS, {})


def test_of_a_way_that_is_loaded_nothing_is_left():
    assert part(strip(), (20, 5, 0), (10, 5, 0)) is None


def test_the_first_part_ends_where_what_is_loaded_ends():
    world = strip()
    beyond = part(world, END)
    ((x, _, _),) = beyond.told
    assert 15.0 < x < 30.0 and world.is_loaded(beyond.told)[0]
    assert beyond.full == 0 and not world.is_loaded(beyond.towards)[0]
    assert x < beyond.towards[0] <= END[0]
    assert beyond.length == pytest.approx(END[0] - x, abs=1.0)


def test_goals_before_that_are_told_as_they_are_and_those_after_it_count():
    beyond = part(strip(), (15, 5, 0), END, START)
    assert beyond.told[0] == (15, 5, 0) and len(beyond.told) == 2 and beyond.full == 1
    assert beyond.length == pytest.approx((END[0] - beyond.told[1][0]) + (END[0] - START[0]), abs=2.0)


def test_where_nothing_is_loaded_on_the_way_nothing_is_told():
    world = strip()
    there = (29.0, 5.0, 0.0)
    beyond = part(world, END, start=there)
    assert beyond.told == () and beyond.full == 0
    assert beyond.length == pytest.approx(END[0] - there[0], abs=1.0)


@pytest.mark.parametrize(("goal", "reason"), [(ISLAND, "no way leads there"), ((5, 90, 0), "not near")])
@pytest.mark.parametrize("first", [(), ((20, 5, 0),), (END,)])
def test_a_goal_that_cannot_be_reached_is_known_at_once(goal, reason, first):
    with pytest.raises(NoWay, match=reason) as error:
        part(strip(), *first, goal)
    assert error.value.goal == len(first)


@pytest.mark.parametrize(
    "change",
    [
        {"length": np.inf},
        {"length": -1.0},
        {"full": 2},
        {"full": -1},
        {"told": ((1.0, 2.0, np.nan),)},
        {"told": ((0.0, 0.0, 0.0),) * 3},
    ],
)
def test_what_no_way_leaves_is_refused(change):
    fine = Beyond(((1.0, 2.0, 3.0),), 0, (4.0, 5.0, 6.0), 7.0)
    fine.check("ada", 2)
    with pytest.raises(RuntimeInputError, match="ada has"):
        dataclasses.replace(fine, **change).check("ada", 2)
