"""Lists of blockers with the sides of zones in them."""

import numpy as np

from navmesh.zones.lists import lists_with, sides_of
from tests.navmesh.shapes import box, plane
from tests.navmesh.surface.levels import build


def test_an_outline_is_closed_unless_it_is_a_line():
    line, square = np.zeros((2, 3)), np.arange(12.0).reshape(4, 3)
    sides, start = sides_of([line, square])
    assert start.tolist() == [0, 1, 5]
    np.testing.assert_array_equal(sides[1:, :2], square[:, :2])
    np.testing.assert_array_equal(sides[1:, 2:], np.roll(square[:, :2], -1, axis=0))


def test_cells_have_their_list_and_the_sides_of_their_zones():
    surface = build(plane(0, 6, 0, 6), box(2, 3, 2, 3, 0, 2)).surface
    cell = np.array([5, 5, 40, 41, 80], np.int32)
    zone = np.array([0, 1, 1, 1, 0], np.int32)
    start = np.array([0, 4, 5], np.int32)
    lists = lists_with(surface, cell, zone, start)
    told = dict(zip(lists.row.tolist(), lists.side.tolist(), strict=True))
    for each in range(len(surface)):
        first, last = lists.list_start[lists.source[each]], lists.list_start[lists.source[each] + 1]
        rows = range(first, last)
        plain = [row for row in rows if row not in told]
        source = surface.source[each]
        old = surface.blocker[surface.list_start[source] : surface.list_start[source + 1]]
        np.testing.assert_array_equal(lists.blocker[plain], old if source >= 0 else old[:0])
        sides = [told[row] for row in rows if row in told]
        assert sides == [s for z in zone[cell == each] for s in range(start[z], start[z + 1])]
        assert np.isnan(lists.blocker[[row for row in rows if row in told]]).all()
