"""Routes against an exact planner: nearly the shortest, and as long there as back."""

import numpy as np
import pytest

from benchmarks.visibility import Boxes, shortest_ways


def one_box() -> Boxes:
    return Boxes((20.0, 20.0), np.array([[10.0, 10.0]]), np.array([[2.0, 1.0]]), np.zeros(1))


def test_the_exact_planner_goes_round_a_corner_on_an_arc() -> None:
    # from straight below a corner of the box to straight left of it: a quarter of a circle
    start, goal = np.array([[7.6, 8.5]]), np.array([[7.6, 11.5]])
    direct = shortest_ways(one_box(), start, goal, 0.3)[0]
    assert direct == pytest.approx(3.0)
    start, goal = np.array([[8.0, 8.7]]), np.array([[7.7, 9.0]])
    assert shortest_ways(one_box(), start, goal, 0.3)[0] == pytest.approx(0.3 * np.pi / 2, rel=0.005)


def test_the_exact_planner_says_where_there_is_no_way() -> None:
    wall = Boxes((20.0, 20.0), np.array([[10.0, 10.0]]), np.array([[0.1, 12.0]]), np.zeros(1))
    assert shortest_ways(wall, np.array([[2.0, 2.0]]), np.array([[18.0, 2.0]]), 0.3)[0] == np.inf
