"""Obstacles close together are taken in one line."""

import numpy as np
import pytest

from locomotion.paths.aligned_obstacles import lined_up
from tests.locomotion.paths.boxes import SKILLS, graph_of

JUMPS = {"jump": SKILLS["jump"]}
START, GOAL = (3.0, -8.0, 0.0), (13.0, 28.0, 0.8)


def terraces(apart):
    """Two steps of 0.4 m, ``apart`` [m] from each other, up along y."""
    return graph_of(
        ((0, -10, -1), (16, 4, 0)), ((0, 4, -1), (16, 4 + apart, 0.4)), ((0, 4 + apart, -1), (16, 32, 0.8))
    )


@pytest.fixture(scope="module")
def near():
    return terraces(6.0)


def route_of(graph):
    return graph.find_path(START, GOAL, radius=0.3, skills=JUMPS)


def columns(route):
    """x [m] of the links that a route takes."""
    return [float(route.graph.links.edge[use.link, 0]) for use in route.links]


def test_a_sidestep_between_two_obstacles_is_taken_out(near):
    route = route_of(near)
    before = columns(route)
    assert before[0] < before[1]  # the shortest route takes the second further on
    moved = lined_up(route, JUMPS)
    first, second = columns(moved)
    assert first == second
    assert route.length <= moved.length < route.length + 4.0
    assert [near.links.obstacle[use.link] for use in moved.links] == [
        near.links.obstacle[use.link] for use in route.links
    ]


def test_the_moved_route_is_a_whole_route(near):
    moved = lined_up(route_of(near), JUMPS)
    assert moved.status == "complete"
    assert moved.waypoints[0] == pytest.approx(START, abs=0.1) and moved.waypoints[-1] == pytest.approx(GOAL)
    assert moved.length == pytest.approx(np.linalg.norm(np.diff(moved.waypoints, axis=0), axis=1).sum())
    for use in moved.links:
        assert moved.waypoints[use.first] == pytest.approx(near.links.start[use.link])
        assert moved.waypoints[use.last] == pytest.approx(near.links.end[use.link])
    assert lined_up(moved, JUMPS) is moved


def test_links_that_are_closed_or_beyond_the_skill_are_not_used(near):
    route = route_of(near)
    free = lined_up(route, JUMPS)
    used = [use.link for use in free.links]
    closed = [link for link in used if link not in [use.link for use in route.links]]
    assert closed
    costs = np.zeros(len(near.links))
    costs[closed] = np.inf
    other = lined_up(route, JUMPS, costs)
    assert not set(closed) & {use.link for use in other.links}
    assert lined_up(route, {"jump": (0.5, 0.7)}) is route


def test_obstacles_far_apart_and_routes_without_any_stay_as_they_are(near):
    level = near.find_path(START, (13.0, -2.0, 0.0), radius=0.3)
    assert lined_up(level, JUMPS) is level
    far = route_of(terraces(19.0))
    assert columns(far)[0] != columns(far)[1]
    assert lined_up(far, JUMPS) is far
