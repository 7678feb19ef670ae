"""Routes against an exact planner: nearly the shortest, and as long there as back."""

import numpy as np
import pytest

from benchmarks.shortest_routes import compare
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


def test_routes_round_boxes_are_nearly_the_shortest() -> None:
    found = [compare(seed, 24) for seed in range(900, 908)]
    longest = np.concatenate([each.longest for each in found])
    uneven = np.concatenate([each.uneven for each in found])
    assert len(longest) > 100 and longest.min() > 0.98
    assert longest.mean() < 1.006
    assert (longest > 1.05).mean() < 0.02 and (uneven > 1.02).mean() < 0.02


def test_the_way_back_round_three_boxes_is_as_long() -> None:
    """Routes were up to 2.6 times as long as the same way back."""
    boxes = Boxes(
        (30.0, 40.0),
        np.array([[18.0, 9.0], [23.0, 25.0], [9.0, 23.0]]),
        np.array([[4.0, 1.0], [1.0, 4.0], [4.0, 1.0]]),
        np.zeros(3),
    )
    found = compare(7, 150, boxes, 0.3)
    assert found.longest.max() < 1.05 and found.uneven.max() < 1.05
    assert (found.uneven > 1.02).mean() < 0.02
