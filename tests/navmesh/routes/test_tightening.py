"""Corners that nothing holds are let go: routes are nearly the shortest, and as long there as back."""

import numpy as np

from benchmarks.shortest_routes import compare
from benchmarks.visibility import Boxes


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
