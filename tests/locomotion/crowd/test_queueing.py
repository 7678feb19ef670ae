"""Gates are used in one direction at a time, and everybody gets through."""

import numpy as np
import pytest

from benchmarks.crowd import door_figures
from locomotion.crowd import Crowd
from locomotion.crowd import layout as at
from locomotion.crowd.gates import ABREAST, find_gates
from locomotion.crowd.queueing import direct, trace_gates, waiting_wish, waits_behind
from navmesh.graph.kernel_arrays import net_of
from tests.locomotion.crowd.levels import corner, run


def test_two_groups_take_turns_in_a_corridor():
    crowd = Crowd(corner(), dt=1 / 30)
    rows = [(x, 1.0 + 0.8 * k) for x in (1.0, 2.0, 3.0) for k in range(5)]
    for x, y in rows:
        crowd.add((x, y, 0.0)).go_to([(18.0 - x, y, 0.0)])
        crowd.add((18.0 - x, y, 0.0)).go_to([(x, y, 0.0)])
    assert run(crowd, 240.0) < 0.1
    assert [walker.status for walker in crowd.walkers] == ["arrived"] * 30


def test_two_who_meet_inside_a_corridor_give_way():
    crowd = Crowd(corner())
    one, two = crowd.add((7.5, 2.5, 0.0)), crowd.add((10.0, 2.5, 0.0))
    one.go_to([(15.0, 3.0, 0.0)])
    two.go_to([(3.0, 3.0, 0.0)])
    assert run(crowd, 60.0) < 0.1
    assert one.status == two.status == "arrived"


def test_a_crowd_changes_halls_through_a_door():
    figures = door_figures(0.3, 40, np.random.default_rng(3), longest=120.0)
    assert figures["through"] == figures["arrived"] == 40
    assert figures["deepest_overlap"] < 0.1
    assert figures["least_clearance"] > 0.99 * 0.3


# --- the rules, on a gate of 4 m from x = 0 on that bodies pass to and fro
PASSAGE = 4.0
DT = 0.1


def at_gate(*bodies):
    """Rows and crossings of bodies [m] before the gate's entrance on their side, going ahead (1) or back
    (-1)."""
    rows, crossings = np.zeros((len(bodies), at.ROW)), np.zeros((len(bodies), at.CROSSING))
    for i, (before, sign) in enumerate(bodies):
        row, crossing = rows[i], crossings[i]
        crossing[[at.SIGN, at.LEFT_IN, at.LEFT_OUT]] = sign, 10.0, 10.0 - PASSAGE
        crossing[[at.IN_X, at.INTO_X]] = 0.0 if sign > 0 else PASSAGE, sign
        row[[at.MODE, at.WISH, at.RADIUS]] = at.WALKING, 1.4, 0.3
        row[[at.GATE_START, at.GATE_COUNT]] = i, 1
        row[at.RIGHT_UNTIL] = np.inf
        put(row, crossing, before)
    return rows, crossings


def put(row, crossing, before):
    row[at.LEFT_NOW] = crossing[at.LEFT_IN] + before
    row[at.X] = crossing[at.IN_X] - crossing[at.INTO_X] * before


def go_on(rows, crossings):
    direct(rows, crossings, 1, np.ones(len(rows), np.bool_), DT)


def passing(rows):
    return [int(i) for i in np.flatnonzero(rows[:, at.PASSAGE] == at.PASSING)]


def test_only_those_near_a_gate_wait_for_their_turn():
    rows, crossings = at_gate((2.6, 1.0), (2.4, 1.0))
    go_on(rows, crossings)
    assert rows[0, at.PASSAGE] == at.FAR and rows[1, at.PASSAGE] == at.PASSING


def test_one_direction_at_a_time_the_nearest_first():
    rows, crossings = at_gate((2.0, 1.0), (1.0, 1.0), (1.5, -1.0))
    rows[:2, at.GATE_WAIT] = 1.0
    go_on(rows, crossings)
    assert passing(rows) == [1]
    go_on(rows, crossings)
    assert passing(rows) == [0, 1]
    for _ in range(5):
        go_on(rows, crossings)
    assert passing(rows) == [0, 1] and rows[2, at.PASSAGE] == at.WAITING


def test_at_most_four_are_on_their_way_in():
    rows, crossings = at_gate(*((0.5 + 0.3 * k, 1.0) for k in range(6)))
    for _ in range(10):
        go_on(rows, crossings)
    assert passing(rows) == [0, 1, 2, 3]
    put(rows[0], crossings[0], -1.0)  # it is inside
    go_on(rows, crossings)
    assert passing(rows) == [0, 1, 2, 3, 4]


def test_the_other_side_goes_once_it_has_waited_and_the_gate_is_empty():
    rows, crossings = at_gate((0.5, 1.0), (1.0, -1.0), (2.0, 1.0))
    rows[0, at.PASSAGE] = at.PASSING
    rows[1, [at.PASSAGE, at.GATE_WAIT]] = at.WAITING, 8.0
    go_on(rows, crossings)
    assert passing(rows) == [0], "no more are let in on the side that goes"
    put(rows[0], crossings[0], -PASSAGE - 0.6)  # it is out
    go_on(rows, crossings)
    assert passing(rows) == [1]


def test_of_two_that_meet_inside_the_outnumbered_one_goes_back():
    rows, crossings = at_gate((-1.0, 1.0), (-0.5, 1.0), (-1.0, -1.0))
    go_on(rows, crossings)
    go_on(rows, crossings)
    assert passing(rows) == [0, 1] and rows[2, at.PASSAGE] == at.RETREATING
    put(rows[2], crossings[2], 1.3)
    go_on(rows, crossings)
    assert rows[2, at.PASSAGE] == at.WAITING


def test_who_comes_out_has_the_right_of_way_for_six_metres():
    rows, crossings = at_gate((-PASSAGE - 0.6, 1.0))
    go_on(rows, crossings)
    assert rows[0, at.GATE_NEXT] == 1.0 and rows[0, at.WEIGHT] == 6.0
    rows[0, at.LEFT_NOW] = crossings[0, at.LEFT_OUT] - 6.1
    go_on(rows, crossings)
    assert rows[0, at.WEIGHT] == 1.0


def test_those_who_wait_leave_the_way_out_free():
    rows, crossings = at_gate((1.0, 1.0), (1.0, 1.0), (2.5, 1.0))
    rows[:, at.PASSAGE] = at.WAITING
    rows[1, at.Y] = 0.5  # a little to the left of the entrance
    nobody = np.zeros(10, dtype=np.int64)
    x, y = waiting_wish(rows, crossings, 1, nobody, 0)
    assert y < 0.0 and abs(x) < 1e-9, "to the right, before anything else"
    rows[0, at.Y] = -0.8
    x, y = waiting_wish(rows, crossings, 0, nobody, 0)
    assert x < 0.0 and y < 0.0  # to its spot, 1.3 m back and 1 m to the right
    assert np.hypot(x, y) <= 0.5 * 1.4 + 1e-9


def test_one_waits_behind_another_that_waits_nearer_to_the_same_entrance():
    rows, crossings = at_gate((1.5, 1.0), (1.0, 1.0))
    near = np.array([1, 0])
    assert not waits_behind(rows, crossings, 0, near, 1), "the other is on its way in"
    rows[1, at.PASSAGE] = at.WAITING
    assert waits_behind(rows, crossings, 0, near, 1)
    assert not waits_behind(rows, crossings, 1, np.array([0, 1]), 1)
    put(rows[0], crossings[0], 2.5)  # out of touch
    assert not waits_behind(rows, crossings, 0, near, 1)
    crossings[1, at.SIGN] = -1.0
    put(rows[0], crossings[0], 1.5)
    assert not waits_behind(rows, crossings, 0, near, 1)


def test_a_route_through_the_corridor_has_one_gate_both_ways():
    graph = corner()
    crowd = Crowd(graph)
    walker = crowd.add((2.0, 2.5, 0.0))
    net, gates = net_of(graph), find_gates(graph, ABREAST * 0.3)
    found = []
    for goal in ((15.0, 2.5, 0.0), (2.0, 2.5, 0.0)):
        walker.go_to([goal])
        (crossing,) = trace_gates(net, *gates, ABREAST * 0.3, crowd.routes.table(0))
        assert crossing[at.LEFT_IN] - crossing[at.LEFT_OUT] == pytest.approx(6.0 + 2 * 0.75, abs=0.5)
        found.append(crossing)
        crowd.rows[0, at.X : at.Z + 1] = np.subtract(goal, graph.surface.origin)
        assert len(trace_gates(net, *gates, 0.3, crowd.routes.table(0))) == 0  # wide enough for it
    there, back = found
    assert there[at.SIGN] == -back[at.SIGN]
    assert there[at.INTO_X] > 0.9 and back[at.INTO_X] < -0.9
    assert there[at.IN_X] < back[at.IN_X] - 5.0
