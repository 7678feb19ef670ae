"""Links between cells as the storeys that they lead to."""

import numpy as np
import pytest

from navmesh import NavmeshError
from navmesh.surface.storeys import APART, MOST, check_storeys, storeys_of
from tests.navmesh.surface.levels import build, random_level


@pytest.mark.parametrize("seed", range(4))
def test_links_as_numbers_of_cells_say_the_same(seed):
    surface = build(*random_level(seed)).surface
    link = surface.link
    start, column, ny = surface.column_start, surface.cell_column, surface.shape[1]
    for k in range(len(surface)):
        for way, step in enumerate((ny, 1, -ny, -1)):
            storey = int(surface.storey[k, way])
            expected = -1 if storey == APART else int(start[column[k] + step]) + storey
            assert link[k, way] == expected
            assert expected < 0 or column[expected] == column[k] + step
    cells = np.random.default_rng(seed).integers(0, len(surface), 50)
    np.testing.assert_array_equal(surface.links(cells), link[cells])
    np.testing.assert_array_equal(storeys_of(start, column, link), surface.storey)


def test_too_many_floors_above_each_other_are_refused():
    check_storeys(np.array([0, MOST, MOST]), "tower")
    with pytest.raises(NavmeshError, match="tower: 256 floors above each other; expected at most 255"):
        check_storeys(np.array([0, 0, MOST + 1]), "tower")
