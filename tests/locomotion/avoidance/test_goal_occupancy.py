"""Who stands at a goal, and how far a late one gets."""

import numpy as np
import pytest

from locomotion.avoidance.goal_occupancy import ROOM, free_points, is_before, who_stands_at
from locomotion.avoidance.yielding import SPACING, Course

GOAL = np.array([10.0, 0.0, 0.0])


def disc(x, y=0.0, speed=0.0, z=0.0, radius=0.3):
    return [x, y, z, speed, 0.0, radius]


def course(length=0.0):
    points = np.column_stack([SPACING * np.arange(101), np.zeros(101), np.zeros(101)])
    return Course(
        points, np.full(101, 1.4), speed=1.4, pace=1.0, length=length, reach=0.0, radius=0.3,
        acceleration=1.0, braking=1.0, eagerness=1.0, slowest=0.0, sharpest=1.0, begins=0.5,
        aside=True, whole=True, stops=1.0,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("discs", "taken"),
    [
        ([disc(10.0)], [0]),
        ([disc(10.0, speed=0.5)], []),  # it goes on
        ([disc(10.0, z=3.0)], []),  # on another storey
        ([disc(8.0)], []),  # in the way, but not at the goal
        ([disc(10.0), disc(9.2), disc(8.4), disc(5.0)], [0, 1, 2]),  # a queue, and somebody else
        ([disc(10.0), disc(9.2, speed=0.5), disc(8.0)], [0]),  # a queue that moves on
    ],
)
def test_who_stands_at_a_goal(discs, taken):
    rows = np.array(discs)
    assert who_stands_at(GOAL, 0.3, rows) == pytest.approx(rows[taken])


@pytest.mark.parametrize("length", [0.0, 0.75])
def test_a_late_one_stops_before_the_last_of_the_queue(length):
    group = np.array([disc(10.0), disc(9.2)])
    front = (free_points(course(length), group) - 1) * SPACING
    assert 9.2 - 0.6 - ROOM - SPACING <= front < 9.2 - 0.6 - ROOM
    assert free_points(course(length), np.array([disc(10.0, 2.0)])) == 101


def test_one_that_stands_in_the_group_is_before_it():
    group = np.array([disc(10.0)])
    assert is_before(np.array([disc(9.3)]), 0.0, group)
    assert not is_before(np.array([disc(8.8)]), 0.0, group)
    assert is_before(np.array([disc(8.8)]), 0.5, group)  # with its nose
