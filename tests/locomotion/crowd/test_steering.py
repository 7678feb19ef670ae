"""The velocity that a body wants along its route."""

import math

import numpy as np
import pytest

from locomotion.crowd import Crowd
from locomotion.crowd import layout as at
from locomotion.crowd.steering import follow
from navmesh.graph.kernel_arrays import net_of
from navmesh.graph.spatial_queries import project
from tests.locomotion.crowd.levels import corner, graph_of, hall

DT = 0.01


def sent(graph, start, goals, speed=1.4):
    crowd = Crowd(graph)
    walker = crowd.add((*start, 0.0))
    walker.go_to([(*goal, 0.0) for goal in goals], speed=speed)
    return crowd, crowd.rows[0]


def wanted(crowd, crowded=False, dt=DT):
    return np.array(follow(net_of(crowd.graph), crowd.rows[0], crowd.routes.rows, 0, dt, crowded))


def put(crowd, x, y):
    crowd.rows[0, [at.X, at.Y]] = np.subtract((x, y), crowd.graph.surface.origin[:2])
    crowd.rows[0, at.CELL] = project(crowd.graph, np.array([[x, y, 0.0]]))[0][0]


def test_it_wants_its_speed_towards_the_next_corner():
    crowd, row = sent(hall(), (2.0, 2.0), [(8.0, 8.0)])
    assert wanted(crowd) == pytest.approx([1.4 / math.sqrt(2.0)] * 2, abs=1e-6)
    assert row[at.LEFT_NOW] == pytest.approx(6.0 * math.sqrt(2.0), abs=1e-6)


def test_it_brakes_for_its_goal_and_notes_that_it_has_come():
    """With four fifths of its acceleration, 4 m/s²."""
    crowd, row = sent(hall(), (2.0, 2.0), [(12.0, 2.0)], speed=3.0)
    for left in (2.0, 1.0, 0.5, 0.2):
        put(crowd, 12.0 - left, 2.0)
        assert wanted(crowd)[0] == pytest.approx(min(3.0, math.sqrt(2.0 * 3.2 * left)))
        assert row[at.NOTE] == at.QUIET
    put(crowd, 11.9, 2.0)
    assert not wanted(crowd).any() and row[at.NOTE] == at.ARRIVED


def test_others_near_it_make_it_keep_to_the_right():
    crowd, _ = sent(hall(), (2.0, 2.0), [(12.0, 2.0)])
    x, y = wanted(crowd, crowded=True)
    assert math.atan2(y, x) == pytest.approx(-0.05) and math.hypot(x, y) == pytest.approx(1.4)


def test_time_without_headway_counts():
    crowd, row = sent(hall(), (2.0, 2.0), [(12.0, 2.0)])
    for x, waited in ((2.0, 0.0), (2.2, DT), (2.2, 2 * DT), (2.3, 0.0)):  # 0.25 m are headway
        put(crowd, x, 2.0)
        wanted(crowd)
        assert row[at.WAITED] == pytest.approx(waited)


def test_it_cuts_corners_that_it_sees_past_but_visits_its_goals():
    crowd, row = sent(corner(), (3.0, 0.8), [(9.0, 2.5), (15.0, 5.2)])
    corners = crowd.routes.table(0)
    goal = int(np.flatnonzero(corners[:, at.VIA])[0])
    assert 1 < goal < len(corners) - 1  # a corner before the first goal, and one after it
    wanted(crowd)
    assert row[at.NEXT] == 1.0
    put(crowd, 5.6, 2.45)  # in line with the corridor
    for _ in range(goal):
        wanted(crowd)
    assert row[at.NEXT] == goal
    put(crowd, 8.2, 2.5)  # sees on, but has not been there
    wanted(crowd)
    assert row[at.NEXT] == goal
    put(crowd, 8.6, 2.5)
    wanted(crowd)
    assert row[at.NEXT] > goal


def test_it_notes_how_long_it_has_not_seen_its_corner():
    floor = graph_of((0.0, 0.0, 4.0, 8.0, 0.0), (4.0, 0.0, 8.0, 3.0, 0.0))
    crowd, row = sent(floor, (2.0, 7.0), [(7.0, 2.0)])
    row[at.NEXT] = row[at.ROUTE_COUNT] - 1  # its last corner is behind the other one
    for _ in range(3):
        wanted(crowd)
    assert row[at.BLIND] == pytest.approx(3 * 4 * DT)  # it looks every fourth tick
    put(crowd, 3.0, 2.0)
    wanted(crowd)
    assert row[at.BLIND] == 0.0


def test_bodies_look_in_turn():
    crowd, row = sent(hall(), (2.0, 2.0), [(12.0, 2.0)])
    row[at.BLIND] = 1.0
    looked = []
    for age in range(8):
        row[at.AGE] = age
        row[at.BLIND] = 1.0
        follow(net_of(crowd.graph), row, crowd.routes.rows, 3, DT, False)
        looked.append(row[at.BLIND] == 0.0)
    assert looked == [False, True, False, False, False, True, False, False]
