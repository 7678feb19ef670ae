import numpy as np
import trimesh

from runtime.playtest.sides import Side
from tests.runtime.playtest.levels import box, site_of


def test_what_is_in_a_box_is_what_is_found_by_looking_at_all():
    rng = np.random.default_rng(4)
    low = rng.uniform(0.0, 18.0, (12, 3)) * (1.0, 1.0, 0.1)
    parts = [box(0, 20, 0, 15, -1, 0)]
    parts += [box(x, x + 2, y, y + 2, z, z + 0.4) for x, y, z in low]
    site = site_of(trimesh.util.concatenate(parts))
    cells = np.sort(rng.choice(len(site.graph.surface), len(site.graph.surface) // 2, replace=False))
    side = Side(site.graph.surface, cells)
    assert (side.places == site.graph.surface.centers(cells)).all()
    for _ in range(50):
        a, b = np.sort(rng.uniform(-4.0, 24.0, (2, 3)), axis=0)
        a[2], b[2] = a[2] - 5.0, b[2] * 0.1
        inside = np.flatnonzero(((side.places >= a) & (side.places <= b)).all(axis=1))
        assert np.array_equal(side.rows_within(a, b), inside)
        assert np.array_equal(side.within(a, b), side.places[inside])
    assert not len(Side(site.graph.surface, cells[:0]).within(low[0], low[0] + 9.0))


def test_cells_of_parts_are_those_with_their_number():
    floors = [box(0, 4, 0, 4, -1, 0), box(8, 12, 0, 4, -1, 0), box(16, 20, 0, 4, -1, 0)]
    site = site_of(trimesh.util.concatenate(floors))
    for parts in ([0], [2, 0], [1, 2], [0, 1, 2]):
        expected = np.flatnonzero(np.isin(site.cell_part, parts))
        assert np.array_equal(site.cells_of(*parts), expected)
        assert np.array_equal(site.side(np.isin(np.arange(3), parts)).cells, expected)
    assert np.array_equal(site.everywhere.cells, np.flatnonzero(site.cell_part >= 0))
    assert not len(site.side(np.zeros(3, bool)).cells)
