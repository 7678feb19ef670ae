"""The field of a window is that of the whole there."""

import numpy as np

from navmesh.surface.renewal import field_in
from navmesh.surface.ridges import field_of
from tests.navmesh.surface.levels import build, random_level


def test_the_field_of_a_window():
    surface = build(*random_level(4)).surface
    whole, (part, where) = field_of(surface), field_in(surface, (5, 8, 30, 25))
    ix, iy = np.divmod(surface.cell_column[where], surface.shape[1])
    assert ix.min() == 5 and ix.max() == 29 and iy.min() == 8 and iy.max() == 24
    for name in ("cell_column", "nearest", "clearance", "source"):
        np.testing.assert_array_equal(getattr(part, name), getattr(whole, name)[where], name)
    assert part.blocker_start is surface.blocker_start and part.blocker is surface.blocker
    inside = np.full(len(surface) + 1, -1)
    inside[where] = np.arange(len(where))
    np.testing.assert_array_equal(part.link, inside[surface.link[where]])
