"""A surface packed for a file is the same when it is unpacked; what is no surface is refused."""

import numpy as np
import pytest

from navmesh.graph.packed_surface import columns_of, pack_surface, unpack_surface
from tests.navmesh.shapes import plane
from tests.navmesh.surface.levels import arrays_of, build, random_level


@pytest.fixture(scope="module")
def surface():
    return build(*random_level(4), plane(2, 7, 2, 7, 3.0)).surface


def unpacked(surface, **odd):
    return unpack_surface({**pack_surface(surface), **odd}, surface.resolution, surface.shape)


def test_all_of_a_surface_with_storeys_comes_back(surface):
    back = unpacked(surface)
    assert np.diff(surface.column_start).max() > 1
    found = arrays_of(back)
    for name, expected in arrays_of(surface).items():
        np.testing.assert_array_equal(found[name], expected, err_msg=name)


def test_cells_know_their_columns(surface):
    cells = np.arange(len(surface))[::-7]
    np.testing.assert_array_equal(
        columns_of(np.diff(surface.column_start), cells), surface.cell_column[cells]
    )


def test_links_that_lead_nowhere_or_to_one_place_are_refused(surface):
    storey = pack_surface(surface)["storey"]
    beyond, same = storey.copy(), storey.copy()
    beyond[-1] = 1  # the last cell is in the last row of the floor
    above = int(np.flatnonzero(np.diff(surface.cell_column) == 0)[0])  # and the next cell in the same column
    same[above : above + 2, 0] = 1
    for odd in (beyond, same):
        with pytest.raises(ValueError, match="leads to no cell beside it, or to one that another leads to"):
            unpacked(surface, storey=odd)


def test_clearances_beyond_the_grid_are_refused(surface):
    blocker = pack_surface(surface)["blocker"] + 100.0
    with pytest.raises(ValueError, match="beyond the grid"):
        unpacked(surface, blocker=blocker)
