"""The walkable surface as cells: joined both ways, and where they are in the world."""

import numpy as np
import pytest

from navmesh.surface.surface import DIRECTIONS, Surface
from tests.navmesh.surface.levels import build, random_level


@pytest.fixture(scope="module")
def surface():
    made = build(*random_level(3)).surface
    assert isinstance(made, Surface) and len(made) > 500
    return made


def test_links_lead_to_the_neighbour_and_back(surface):
    ny = surface.shape[1]
    for d in range(4):
        cells = np.flatnonzero(surface.link[:, d] >= 0)
        there = surface.link[cells, d]
        assert np.array_equal(surface.link[there, (d + 2) % 4], cells)
        step = DIRECTIONS[d, 0] * ny + DIRECTIONS[d, 1]
        assert np.array_equal(surface.cell_column[there], surface.cell_column[cells] + step)


def test_cells_of_a_column_come_lowest_first(surface):
    for column in np.flatnonzero(np.diff(surface.column_start) > 1):
        cells = slice(surface.column_start[column], surface.column_start[column + 1])
        assert (np.diff(surface.height[cells]) > 0.0).all()
        assert (surface.cell_column[cells] == column).all()


def test_places_on_a_cells_floor_rise_with_its_slope(surface):
    cells = np.arange(0, len(surface), 7)
    centers = surface.centers(cells)
    assert np.array_equal(centers, surface.centers()[cells])
    local = centers[:, :2] - surface.origin[:2]
    assert surface.lifted(local, cells) == pytest.approx(centers)
    moved = surface.lifted(local + np.array([0.1, 0.0]), cells)
    assert moved[:, 2] - centers[:, 2] == pytest.approx(0.1 * surface.gradient[cells, 0])


def test_the_nearest_place_is_as_far_as_the_clearance_says(surface):
    ended = surface.source >= 0
    assert np.linalg.norm(surface.nearest[ended], axis=1) == pytest.approx(surface.clearance[ended])
    assert ended.any() and (surface.source[~ended] == -1).all()
    assert surface.source.max() < len(surface.list_cell)


def test_lists_of_blockers_are_those_of_their_cells(surface):
    start = surface.blocker_start
    assert start[0] == 0 and start[-1] == len(surface.blocker)
    np.testing.assert_array_equal(np.flatnonzero(np.diff(start)), surface.list_cell)
    np.testing.assert_array_equal(start[surface.list_cell], surface.list_start[:-1])
