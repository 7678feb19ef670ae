"""From the chain of discs to the line that a body walks: straight where it can be, round where it cannot."""

import math

import numpy as np
import pytest

from benchmarks.large_levels import large_level
from navmesh import NodeGraph, WalkRules
from navmesh.graph.kernel_arrays import make_scratch, net_of
from navmesh.graph.open_to_body import doors_of
from navmesh.routes.graph_search import advance, chain
from navmesh.routes.query_kernels import GOAL_CELL, START_CELL, start_search
from navmesh.routes.string_pulling import pull
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


def a_line_that_only_cells_mend() -> tuple[NodeGraph, np.ndarray, np.ndarray]:
    """From one corner of a small city to the other, and ends for a body of 0.3 m."""
    rules = WalkRules(max_slope=math.radians(45), max_step=0.9, headroom=2.0)
    graph = NodeGraph.build(large_level("city", 2, 1), rules, obstacle_rules=None)
    return graph, np.array([0.625, 8.625, 0.0]), np.array([54.929, 54.882, 0.0])


def test_cells_are_searched_only_where_the_line_is_blocked() -> None:
    graph, start, goal = a_line_that_only_cells_mend()
    route = graph.find_path(start, goal, 0.3)
    assert route.status == "complete" and route.length < 71.47
    searched = np.count_nonzero(graph.cache["scratch"][-1].cell_stamp)
    assert 0 < searched < 500  # of 57,600; over all of the line they were 4,675


def test_a_line_that_ends_early_has_heights_of_its_own() -> None:
    """Those of an earlier query stood there."""
    graph, start, goal = a_line_that_only_cells_mend()
    net, doors, scratch = net_of(graph), doors_of(graph, 0.3, None, None), make_scratch(graph)
    origin = graph.surface.origin
    start_search(net, doors, scratch, *(start - origin), *(goal - origin), 1.0, 1.0, 0.9)
    advance(net, doors, scratch, 1 << 60)
    count = chain(scratch)
    scratch.points[:] = np.nan
    scratch.points[0], scratch.cells[0] = scratch.ends[:3], scratch.numbers[START_CELL]
    ends = *scratch.ends[3:5], int(scratch.numbers[GOAL_CELL])
    corners, reached, _ = pull(net, doors, scratch, 1, count, 1, *ends, False)
    assert not reached and corners > 1
    np.testing.assert_allclose(scratch.points[:corners, 2], -origin[2], atol=1e-9)
