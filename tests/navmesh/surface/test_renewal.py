"""The cells of a window are those of the whole there."""

import numpy as np

from navmesh.surface.columns import columns_of
from navmesh.surface.renewal import cells_in
from navmesh.surface.storeys import links_of
from tests.navmesh.surface.levels import build, random_level


def test_the_cells_of_a_window():
    surface = build(*random_level(4)).surface
    part, where = cells_in(surface, (5, 8, 30, 25))
    ix, iy = np.divmod(surface.cell_column[where], surface.shape[1])
    assert ix.min() == 5 and ix.max() == 29 and iy.min() == 8 and iy.max() == 24
    np.testing.assert_array_equal(
        columns_of(part.column_start, part.milestone, np.arange(len(where))), (ix - 5) * 17 + iy - 8
    )
    np.testing.assert_array_equal(part.clearance, surface.clearance[where])
    inside = np.full(len(surface) + 1, -1)
    inside[where] = np.arange(len(where))
    np.testing.assert_array_equal(links_of(part), inside[surface.link[where]])
