"""Only the columns with other cells count."""

import numpy as np
import pytest

from navmesh import WalkRules
from navmesh.surface.build import find_cells, lay_grid, patch_around
from navmesh.surface.differences import differing_window
from tests.navmesh.shapes import box, plane, terrain

RULES = WalkRules(max_step=0.4)
GROUND = plane(0, 20, 0, 15)
ROCK = box(8.1, 9.4, 5.2, 6.9, 0, 1)


def columns_that_differ(old, new, ny):
    """Box of the columns of the whole with other cells: the slow way."""
    apart = []
    for cells in (old, new):
        height, gradient = cells.floor.unpacked(cells.column_start)
        lists = dict(zip(cells.list_cell.tolist(), range(len(cells.list_cell)), strict=True))
        found = []
        for c in range(len(cells.column_start) - 1):
            its = []
            for k in range(cells.column_start[c], cells.column_start[c + 1]):
                own = lists.get(k)
                blockers = (
                    b"" if own is None else cells.blocker[slice(*cells.list_start[own : own + 2])].tobytes()
                )
                its.append((cells.storey[k].tobytes(), height[k].tobytes(), gradient[k].tobytes(), blockers))
            found.append(its)
        apart.append(found)
    ix, iy = np.divmod([c for c, (a, b) in enumerate(zip(*apart, strict=True)) if a != b], ny)
    return (ix.min(), iy.min(), ix.max() + 1, iy.max() + 1) if len(ix) else None


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ([ROCK], []),
        ([], [ROCK]),
        ([ROCK], [box(8.1, 9.4, 5.2, 6.9, 0, 1.2)]),  # the same but for its top
        ([plane(6, 9, 4, 7, 2.5)], [plane(6, 9, 4, 7, 3.0)]),  # the floor on it
        ([ROCK], [box(8.12, 9.4, 5.2, 6.9, 0, 1)]),  # only what ends walking
        ([ROCK], [ROCK]),
    ],
)
def test_the_window_of_what_differs(before, after):
    grid = lay_grid(terrain(GROUND).bounds, RULES, "ground")
    old, new = (find_cells(terrain(GROUND, *things), RULES, grid) for things in (before, after))
    wide = (5, 3, 70, 50)
    fresh = find_cells(terrain(GROUND, *after), RULES, grid, wide)
    window = (16, 10, 60, 40)
    found = differing_window(old, fresh, window, patch_around(grid, wide), grid.shape[1])
    assert found == columns_that_differ(old, new, grid.shape[1])
