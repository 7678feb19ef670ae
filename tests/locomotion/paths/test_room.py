"""Ways keep more room from walls than the body needs, where there is room."""

import numpy as np
import pytest

from locomotion import smooth_route
from locomotion.paths.room import with_room
from tests.locomotion.paths.boxes import graph_of

RADIUS, ROOM = 0.3, 0.15


@pytest.fixture(scope="module")
def hall():
    """A floor of 20 m by 12 m with a wall in its middle from y = 0 to y = 8, and behind it two walls 0.8 m
    apart, at x = 14."""
    walls = ((9.8, 0, 0), (10.2, 8, 2)), ((13, 4, 0), (13.6, 9, 2)), ((14.4, 4, 0), (15, 9, 2))
    return graph_of(((0, 0, -1), (20, 12, 0)), *walls)


def led(graph, start, goal):
    route = graph.find_path(start, goal, radius=RADIUS)
    assert route.status == "complete"
    (leg,) = route.legs()
    return route, leg, with_room(route, leg, ROOM)


def test_round_a_corner_there_is_room(hall):
    route, leg, roomy = led(hall, (8, 2, 0), (12, 2, 0))
    assert hall.clearance_at(leg.waypoints).min() < RADIUS + 0.03
    assert hall.clearance_at(roomy.waypoints).min() > RADIUS + 0.9 * ROOM
    assert np.array_equal(roomy.waypoints[[0, -1]], leg.waypoints[[0, -1]])
    assert hall.cast_ray(roomy.waypoints[:-1], roomy.waypoints[1:], RADIUS - 1e-5).clear.all()
    points = smooth_route(route).points
    assert hall.clearance_at(points).min() > RADIUS + 0.6 * ROOM


def test_between_walls_it_goes_in_the_middle(hall):
    points = led(hall, (14.05, 2, 0), (13.95, 11, 0))[2].waypoints
    within = points[(points[:, 1] > 4.5) & (points[:, 1] < 8.5)]
    assert len(within) > 5 and np.abs(within[:, 0] - 14.0).max() < 0.06


def test_far_from_walls_nothing_changes(hall):
    _, leg, roomy = led(hall, (2, 2, 0), (7, 10, 0))
    way = leg.waypoints[-1] - leg.waypoints[0]
    off = np.cross(way, roomy.waypoints - leg.waypoints[0])[:, 2] / np.linalg.norm(way)
    assert np.abs(off).max() < 1e-9


def test_a_start_beside_a_wall_stays(hall):
    _, leg, roomy = led(hall, (9.45, 2, 0), (9.45, 6, 0))
    assert np.array_equal(roomy.waypoints[0], leg.waypoints[0])
    assert hall.clearance_at(roomy.waypoints)[2:-2].min() > RADIUS + 0.9 * ROOM
