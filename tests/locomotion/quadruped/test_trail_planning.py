"""Trails to goals, made of a planner's paths."""

import math

import numpy as np
import pytest

from locomotion import Ground
from locomotion.quadruped import Place, lay_trail, load_body
from locomotion.quadruped.trail_planning import find_way, first_heading, last_free_arc, turn_onto
from tests.locomotion.quadruped.scenes import Straight, floor, plane, quads, wall

DOG = load_body("dog")
HERE = Place(0.0, 0.0, 0.0, 0.0)


class Reaches(Straight):
    """Knows straight lines to goals with x of at most 5 m."""

    def __init__(self):
        super().__init__()
        self.asked = []

    def way(self, start, goal, direction):
        self.asked.append((start.tolist(), np.round(direction / np.linalg.norm(direction), 6).tolist()))
        if goal[0] > 5.0:
            raise ValueError("too far")
        return super().way(start, goal, direction)


def test_goals_that_lie_ahead_are_one_trail():
    planner, goals = Reaches(), [(2.0, 0.0, 0.0), (4.0, 1.0, 0.0)]
    trail, ways = find_way(planner, DOG, plane(), goals, HERE)
    assert [way.points[-1].tolist() for way in ways] == [list(goal) for goal in goals]
    assert trail.point(trail.length) == pytest.approx([4.0, 1.0], abs=1e-6)
    assert trail.length == pytest.approx(2.0 + math.hypot(2.0, 1.0), abs=0.1)
    # the second is asked for from the first, in the direction of arrival
    assert planner.asked == [([0.0, 0.0, 0.0], [1.0, 0.0]), ([2.0, 0.0, 0.0], [1.0, 0.0])]


@pytest.mark.parametrize("beyond", [(0.5, 0.2, 0.0), (9.0, 0.0, 0.0)])
def test_a_goal_behind_or_out_of_reach_waits_for_its_turn(beyond):
    trail, ways = find_way(Reaches(), DOG, plane(), [(3.0, 0.0, 0.0), beyond], HERE)
    assert len(ways) == 1 and trail.length == pytest.approx(3.0)


def test_where_there_is_no_way_the_planner_says_why():
    with pytest.raises(ValueError, match="too far"):
        find_way(Reaches(), DOG, plane(), [(9.0, 0.0, 0.0)], HERE)


@pytest.mark.parametrize(("yaw", "turn"), [(0.0, 0.5), (1.5, -1.0), (0.5 - math.pi, math.pi), (3.0, -2.5)])
def test_it_turns_to_where_its_front_belongs(yaw, turn):
    direction = np.array([math.cos(0.5), math.sin(0.5), 0.0])
    trail = lay_trail(np.stack([np.zeros(3), 4.0 * direction]), DOG, plane())
    found = turn_onto(trail, DOG, Place(0.0, 0.0, 0.0, yaw))
    assert abs(math.remainder(found - turn, 2.0 * math.pi)) < 1e-6 and abs(found) <= math.pi
    assert first_heading(trail, DOG) == pytest.approx(0.5)


def test_it_stops_before_a_wall_that_its_head_would_touch():
    trail = lay_trail([[0, 0, 0], [6, 0, 0]], DOG, plane())
    end = 4.0
    assert last_free_arc(trail, DOG, plane(), end) == end
    nose = end + DOG.length - DOG.trunk.loin
    near = Ground.from_arrays(*quads(floor(), wall((nose - 0.1, -2.0), (nose - 0.1, 2.0))))
    found = last_free_arc(trail, DOG, near, end)
    assert end - 0.5 < found < end - 0.05
    # beside it there is no room anywhere: it goes as far as it was told
    walls = [wall((-3.0, y), (9.0, y)) for y in (-0.05, 0.05)]
    assert last_free_arc(trail, DOG, Ground.from_arrays(*quads(floor(), *walls)), end) == end
