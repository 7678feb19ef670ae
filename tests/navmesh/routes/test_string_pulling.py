"""From the chain of discs to the line that a body walks: straight where it can be, round where it cannot."""

import math

import numpy as np
import pytest

from tests.navmesh.routes.path_references import build, rounded_shortest
from tests.navmesh.shapes import box, join, plane


def test_round_a_corner_the_path_is_nearly_the_shortest() -> None:
    graph = build(*join(plane(0.0, 20.0, 0.0, 20.0), box(0.0, 10.0, 9.0, 9.2, 0.0, 3.0)))
    for start, goal in (((2.0, 5.0), (2.0, 14.0)), ((8.0, 3.0), (8.5, 16.0)), ((5.0, 2.0), (14.0, 18.0))):
        for radius in (0.3, 0.6, 1.2):
            route = graph.find_path((*start, 0.0), (*goal, 0.0), radius)
            wall = [np.array(corner) for corner in ((10.0, 9.0), (10.0, 9.2))]
            shortest = rounded_shortest(start, goal, sum(wall) / 2, radius)
            assert route.status == "complete"
            assert shortest * 0.99 < route.length < shortest * 1.02


def test_a_straight_way_has_two_waypoints() -> None:
    graph = build(*plane(0.0, 30.0, 0.0, 10.0))
    route = graph.find_path((1.5, 2.0, 0.0), (28.0, 8.0, 0.0), 0.5)
    assert len(route.waypoints) == 2
    assert route.length == pytest.approx(math.hypot(26.5, 6.0), rel=1e-9)
    assert np.allclose(route.waypoints[0], (1.5, 2.0, 0.0), atol=1e-9)
