"""What is nearest to a cell where walking ends follows from how it was carried there, bit for bit."""

import numpy as np
import pytest

from navmesh.graph.kernel_arrays import net_of
from navmesh.surface.blockers import nearest_blockers
from navmesh.surface.build import (
    find_cells,
    lay_grid,
    surface_of,
    surface_with_nearest,
    whole_patch,
    without_nearest,
)
from navmesh.surface.clearance import spread_clearance
from navmesh.surface.clearance_field import centre_of, gap_at
from navmesh.surface.recall import nearest_of, nearly_nearest_of
from surefoot.kernels import allocating_kernel
from tests.navmesh.shapes import box, plane, terrain
from tests.navmesh.surface.levels import RULES, build, random_level

YARD = [plane(0, 9, 0, 9), box(2, 2.1, 1, 8, 0, 2), box(2, 7, 7.9, 8, 0, 2), box(6.9, 7, 3, 8, 0, 2)]
"""Round the walls of a yard what is nearest is carried there and back."""


@allocating_kernel
def _all_of(net, cells):
    found, nearly = np.empty((cells, 2)), np.empty((cells, 2))
    for c in range(cells):
        found[c, 0], found[c, 1] = nearest_of(net, c)
        nearly[c, 0], nearly[c, 1] = nearly_nearest_of(net, c)
    return found, nearly


def _carried(surface, grid):
    """The vectors as a build carries them over the links, and measures those beside walls."""
    patch, (nx, ny) = whole_patch(grid), grid.shape
    nearest = nearest_blockers(
        surface.list_cell, surface.list_start, surface.blocker, surface.cell_column, patch
    )
    source = np.arange(len(surface), dtype=np.int32)
    clearance, _ = spread_clearance(
        surface.column_start, surface.cell_column, surface.storey, nearest, source, grid.resolution, nx, ny
    )
    for c in np.flatnonzero(clearance < 2.0 * grid.resolution):
        x, y = centre_of(surface.field, c)
        gap, qx, qy = gap_at(surface.field, c, x, y)
        if gap < clearance[c]:
            nearest[c] = qx - x, qy - y
    return nearest


@pytest.mark.parametrize("seed", [None, 1, 5, 8])
def test_all_are_recalled_as_they_were_carried(seed):
    level = terrain(*(YARD if seed is None else random_level(seed)))
    grid = lay_grid(level.bounds, RULES, level.name)
    surface = surface_of(find_cells(level, RULES, grid), grid)
    np.testing.assert_array_equal(surface.nearest, _carried(surface, grid))


@pytest.mark.parametrize("seed", [2, 4, 6])
def test_those_that_a_build_keeps_while_it_measures_are_those_that_are_recalled(seed):
    level = terrain(*random_level(seed))
    grid = lay_grid(level.bounds, RULES, level.name)
    surface = surface_with_nearest(find_cells(level, RULES, grid), grid)
    assert len(surface.kept_nearest) == len(surface)
    np.testing.assert_array_equal(surface.kept_nearest, without_nearest(surface).nearest)


@pytest.mark.parametrize("level", [YARD, random_level(3)])
def test_and_one_by_one(level):
    graph = build(*level)
    found, nearly = _all_of(net_of(graph), len(graph.surface))
    np.testing.assert_array_equal(found, graph.surface.nearest)
    np.testing.assert_allclose(nearly, found, rtol=0.0, atol=1e-12)
