"""Clearances that are renewed around a change are those of the whole level, to the bit."""

import numpy as np
import pytest

from navmesh import WalkRules
from navmesh.surface.build import find_cells, lay_grid, patch_around, surface_of, whole_patch
from navmesh.surface.clearance_changes import renew_clearance
from navmesh.surface.renewal import cells_of_surface
from tests.navmesh.shapes import box, plane, terrain

RULES = WalkRules(max_step=0.4)


def rocks(*places):
    return terrain(plane(0, 40, 0, 30), *(box(x, x + 1.3, y, y + 0.7, 0, 1) for x, y in places))


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ([(20.1, 15.3)], []),  # all of the plain is nearer to it than to the plain's end in some turn
        ([(20.1, 15.3), (5, 5), (30, 8)], [(20.7, 15.3), (5, 5), (30, 8)]),
        ([], [(38.3, 28.9)]),
    ],
)
def test_of_rocks_on_a_plain(before, after):
    grid = lay_grid(rocks().bounds, RULES, "plain")
    old, new = (surface_of(find_cells(rocks(*places), RULES, grid), grid) for places in (before, after))
    x, y = np.array((before or after)[0])
    around = np.array([x - 2, y - 2, x + 4, y + 4]) / grid.resolution

    def columns(beyond):
        low = np.maximum(np.floor(around[:2]).astype(int) - beyond, 0)
        high = np.minimum(np.floor(around[2:]).astype(int) + beyond, grid.shape)
        return (*low.tolist(), *high.tolist())

    inner, window = columns(0), columns(8)
    fresh = find_cells(rocks(*after), RULES, grid, window)
    found = renew_clearance(
        cells_of_surface(old), old.field, fresh, inner, patch_around(grid, window), whole_patch(grid), 1.0
    )
    assert found is not None
    left, near, right, far = found.window
    assert left <= inner[0] and near <= inner[1] and right >= inner[2] and far >= inner[3]
    ix, iy = np.divmod(new.cell_column, grid.shape[1])
    inside = (ix >= left) & (ix < right) & (iy >= near) & (iy < far)
    np.testing.assert_array_equal(found.choice, new.choice[inside])
    settled = new.clearance[inside] >= 2.0 * grid.resolution
    np.testing.assert_array_equal(found.nearest[settled], new.nearest[inside][settled])
    # beyond it nothing is other than before; nor is what is known beyond what has changed
    ox, oy = np.divmod(old.cell_column, grid.shape[1])
    for window, names in ((found.window, ("clearance", "choice")), (found.changed, ("clearance", "nearest"))):
        left, near, right, far = window
        beyond = ~((ox >= left) & (ox < right) & (oy >= near) & (oy < far))
        outside = ~((ix >= left) & (ix < right) & (iy >= near) & (iy < far))
        for name in names:
            np.testing.assert_array_equal(getattr(old, name)[beyond], getattr(new, name)[outside])
    # and that is no more than there is
    apart = np.zeros(grid.shape, bool)
    one, other = (dict(zip(s.cell_column.tolist(), s.nearest.tolist(), strict=True)) for s in (old, new))
    for column in one.keys() | other.keys():
        apart.flat[column] = one.get(column) != other.get(column)
    along, across = np.nonzero(apart.any(axis=1))[0], np.nonzero(apart.any(axis=0))[0]
    least = (min(inner[0], along[0]), min(inner[1], across[0]), max(inner[2], along[-1] + 1),
             max(inner[3], across[-1] + 1))  # fmt: skip
    assert np.abs(np.subtract(found.changed, least)).max() <= 2
