"""The way to an obstacle is straight from as far as the run-up needs, and straight on behind it."""

from itertools import pairwise

import numpy as np
import pytest

from locomotion import Smoothing, smooth_route
from locomotion.paths.smoothing import RUNNING
from tests.locomotion.paths.boxes import SKILLS, graph_of


@pytest.fixture(scope="module")
def terrace():
    """A floor, and along it, from y = 4 on, a platform of 0.4 m."""
    return graph_of(((0, -30, -1), (80, 4, 0)), ((0, 4, -1), (80, 16, 0.4)))


def straight_around(graph, start, goal, smoothing=RUNNING, direction=None):
    """[m] that the path is straight before its first obstacle and behind it."""
    route = graph.find_path(start, goal, radius=0.3, skills=SKILLS)
    path = smooth_route(route, smoothing, direction)
    (obstacle, *_) = path.obstacles
    beside = np.abs(path.points[:, 0] - obstacle.position[0])
    ahead = obstacle.position[1] - path.points[:, 1]
    edge = int(np.flatnonzero(np.diff(np.sign(ahead)))[0])
    bent = np.flatnonzero(beside > 0.02)
    first = max(bent[bent <= edge], default=-1) + 1
    last = min(bent[bent > edge], default=len(ahead)) - 1
    return float(ahead[first : edge + 1].max()), float(-ahead[last]), path


@pytest.mark.parametrize("start", [(20, -20, 0), (40, 0, 0), (60, 3, 0)])
def test_where_there_is_room_the_run_up_is_whole_from_any_side(terrace, start):
    before, behind, path = straight_around(terrace, start, (45, 12, 0.4))
    assert before >= RUNNING.run_up - 0.3 and behind >= RUNNING.landing - 0.5
    way = np.diff(path.points[:, :2], axis=0)
    corners = [np.cross([*a, 0], [*b, 0])[2] for a, b in pairwise(way)]
    assert np.abs(corners).max() < 0.1  # nowhere does it turn at once


def test_other_bodies_keep_to_the_links(terrace):
    before, _, _ = straight_around(terrace, (20, -20, 0), (45, 12, 0.4), Smoothing((0.3,), 0.25, 2.0))
    assert before < 4.0


def test_it_does_not_go_back_from_a_run_up_that_will_do(terrace):
    _, _, path = straight_around(terrace, (40, -2, 0), (40, 12, 0.4))
    assert np.diff(path.points[:, 1]).min() >= 0.0
    _, _, path = straight_around(terrace, (40, 0, 0), (40, 12, 0.4), direction=np.array([0.0, 3.0]))
    assert np.diff(path.points[:, 1]).min() >= 0.0


def test_one_that_stands_too_near_goes_back_first(terrace):
    before, _, path = straight_around(terrace, (40, 2, 0), (40, 12, 0.4))
    assert path.points[:, 1].min() == pytest.approx(4.0 - RUNNING.run_up, abs=0.5)
    assert before >= RUNNING.run_up - 0.3


def test_walls_make_it_as_long_as_there_is_room():  # 0.4 m is kept to turn round in
    graph = graph_of(((0, -1.5, -1), (40, 4, 0)), ((0, 4, -1), (40, 9, 0.4)))
    before, behind, _ = straight_around(graph, (5, 1, 0), (30, 8, 0.4))
    assert before == pytest.approx(4.8, abs=0.25) and behind == pytest.approx(4.7, abs=0.25)


def test_between_two_obstacles_the_way_never_leads_back():
    graph = graph_of(((0, -20, -1), (40, 4, 0)), ((0, 4, -1), (40, 9, 0.4)), ((0, 9, -1), (40, 30, -0.7)))
    route = graph.find_path((10, -6, 0), (10, 20, -0.7), radius=0.3, skills=SKILLS)
    path = smooth_route(route)
    assert [obstacle.affordance for obstacle in path.obstacles] == ["jump", "drop"]
    on_top = (path.points[:, 1] > 4.0) & (path.points[:, 1] < 9.0)
    assert np.diff(path.points[on_top, 1]).min() >= -1e-9
