"""Bodies move out of each other and along walls."""

import numpy as np
import pytest

from locomotion.crowd import layout as at
from locomotion.crowd.moving import part, slide
from navmesh.graph.kernel_arrays import net_of
from navmesh.graph.spatial_queries import project
from tests.locomotion.crowd.levels import corner, graph_of, hall

RADIUS = 0.3


def bodies(x, weights, radii=(RADIUS, RADIUS)):
    """Rows of two bodies at ``x`` on the x axis, and their places."""
    rows = np.zeros((2, at.ROW))
    rows[:, at.RADIUS], rows[:, at.WEIGHT] = radii, weights
    return rows, np.array(x, dtype=float), np.zeros(2)


def part_both(rows, x, y, rounds=1):
    for _ in range(rounds):
        for i in (0, 1):
            part(rows, x, y, i, np.array([1 - i]), 1)


def test_an_overlap_is_parted_by_weight():
    rows, x, y = bodies([0.0, 0.4], weights=(3.0, 1.0))
    part(rows, x, y, 0, np.array([1]), 1)
    # 0.2 m of overlap: the heavy one makes a quarter of nine tenths of it
    assert x.tolist() == pytest.approx([-0.2 * 0.9 * 0.25, 0.4]) and not y.any()
    part_both(rows, x, y, rounds=20)
    assert x[1] - x[0] == pytest.approx(2.0 * RADIUS, abs=1e-3)
    assert x[1] - 0.4 > -x[0]  # the light one has moved farther


def test_bodies_that_do_not_touch_stay_where_they_are():
    rows, x, y = bodies([0.0, 0.9], weights=(1.0, 1.0), radii=(0.3, 0.6))
    part_both(rows, x, y)
    assert x.tolist() == [0.0, 0.9]


def test_two_in_the_same_place_part_too():
    rows, x, y = bodies([1.0, 1.0], weights=(1.0, 1.0))
    part_both(rows, x, y, rounds=20)
    assert x[1] - x[0] == pytest.approx(2.0 * RADIUS, abs=1e-3)


def slid(graph, start, wanted, radius=RADIUS):
    """Where a body at ``start`` (x, y) that wants to be at ``wanted`` gets."""
    origin = graph.surface.origin[:2]
    (cell,), _ = project(graph, np.array([[*start, 0.0]]))
    here, there = (np.subtract(each, origin).tolist() for each in (start, wanted))
    k, *place = slide(net_of(graph), int(cell), *here, *there, radius)
    assert project(graph, np.array([[*(place + origin), 0.0]]))[0][0] == k
    return place + origin


def test_in_the_open_a_step_ends_where_it_is_meant_to():
    assert slid(hall(), (10.0, 5.0), (10.2, 5.1)) == pytest.approx([10.2, 5.1])


def test_a_step_into_a_wall_slides_along_it():
    """The edge of the hall is at y = 0."""
    x, y = slid(hall(), (10.0, 0.4), (10.3, 0.1))
    assert x == pytest.approx(10.3, abs=0.02) and y == pytest.approx(RADIUS, abs=0.01)


def test_a_step_over_the_edge_ends_before_it():
    x, y = slid(hall(), (10.0, 0.35), (10.1, -0.4))
    assert RADIUS - 0.01 < y < 0.36 and 9.99 < x < 10.11


def test_one_that_is_pressed_against_a_wall_comes_no_nearer():
    x, y = slid(hall(), (10.0, 0.2), (10.1, 0.1))
    assert y >= 0.2 - 1e-9 and 9.99 < x < 10.11


def test_who_is_too_wide_for_a_corridor_stays_before_it():
    """The corridor from x = 6 on is 1 m wide."""
    for radius, gets_in in ((0.45, True), (0.6, False)):
        place = np.array([5.2, 2.5])
        for _ in range(40):
            place = slid(corner(), place, place + np.array([0.05, 0.0]), radius)
        assert (place[0] > 6.5) == gets_in, radius


def test_nobody_crosses_to_a_floor_that_is_not_linked():
    split = graph_of((0.0, 0.0, 4.0, 4.0, 0.0), (4.0, 0.0, 8.0, 4.0, 1.0))
    x, _ = slid(split, (3.6, 2.0), (4.4, 2.0))
    assert x <= 4.0 - 0.99 * RADIUS
