"""A window of cells is put in the place of those that were there."""

import numpy as np
import pytest

from navmesh.level.raster import Patch
from navmesh.surface.build import LinkedCells
from navmesh.surface.splicing import renumber_run, splice
from navmesh.surface.storeys import APART

NX, NY = 4, 3


def cells(counts, first):
    """So many storeys in each column, linked to the same storeys of its neighbours; a storey has as many
    blockers as its number."""
    start = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    column = np.repeat(np.arange(NX * NY, dtype=np.int32), counts)
    storey = np.arange(len(column)) - start[column]
    beside = np.full((len(column), 4), APART, np.uint8)
    for k, (c, s) in enumerate(zip(column, storey, strict=True)):
        for d, (dx, dy) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))):
            x, y = c // NY + dx, c % NY + dy
            if 0 <= x < NX and 0 <= y < NY and s < counts[x * NY + y]:
                beside[k, d] = s
    height = first + 100.0 * column + storey
    blockers = np.concatenate([[0], np.cumsum(storey)]).astype(np.int32)
    of = np.repeat(height, storey)
    return LinkedCells(start, column, beside, blockers, np.tile(of[:, None], 4))


@pytest.mark.parametrize("window", [(1, 1, 3, 2), (0, 0, 4, 3), (2, 0, 4, 3), (1, 1, 1, 1)])
def test_inside_it_is_as_in_the_new_and_outside_as_in_the_old(window):
    rng = np.random.default_rng(3)
    inside = np.zeros((NX, NY), bool)
    inside[window[0] : window[2], window[1] : window[3]] = True
    inside = inside.ravel()
    old_counts, new_counts = rng.integers(1, 4, (2, NX * NY))
    # just outside of the window both are alike
    beside = ~inside & np.array([
        any(0 <= c // NY + dx < NX and 0 <= c % NY + dy < NY and inside[(c // NY + dx) * NY + c % NY + dy]
            for dx, dy in ((1, 0), (0, 1), (-1, 0), (0, -1)))
        for c in range(NX * NY)
    ])  # fmt: skip
    new_counts[beside] = old_counts[beside]
    old, new = cells(old_counts, 0.0), cells(new_counts, 0.5)
    whole_counts = np.where(inside, new_counts, old_counts)
    expected = cells(whole_counts, 0.0)
    shift = 0.5 * inside[expected.cell_column]
    expected.blocker[:] += np.repeat(shift, np.diff(expected.blocker_start))[:, None]
    found = splice(old, new, window, Patch(0.25, 0, 0, NX, NY), NY)
    for name in ("column_start", "cell_column", "blocker_start", "blocker"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name), name)
    # links from outside into the window are those of the old part, which knew as many storeys there as it had
    within = inside[found.cell_column]
    np.testing.assert_array_equal(found.storey[within], expected.storey[within])


@pytest.mark.parametrize(
    "first, size, at", [(0, 5000, 0), (0, 5000, 40), (3000, 6500, 2500), (9000, 1000, 9700)]
)
def test_numbers_of_cells_move_with_the_cells(first, size, at):
    rng = np.random.default_rng(size)
    column = np.sort(rng.integers(0, 4000, 10_000)).astype(np.int32)
    old_start = np.searchsorted(column, np.arange(4001)).astype(np.int32)
    start = (old_start + rng.integers(0, 50, 4001).cumsum()).astype(np.int32)
    numbers = rng.integers(-1, 10_000, 20_000).astype(np.int32)
    numbers[::3] = np.clip(numbers[::3], first, first + size - 1)
    numbers[2 * first : 2 * first + 4500] = rng.integers(first, first + size, 20_000)[
        2 * first : 2 * first + 4500
    ]
    whole = np.full(30_000, -7, np.int32)
    renumber_run(numbers, 2, first, size, at, column, old_start, start, whole)
    for k in range(2 * first, 2 * (first + size)):
        m = numbers[k]
        inside = first <= m < first + size
        expected = m if m < 0 else m + at - first if inside else start[column[m]] + m - old_start[column[m]]
        assert whole[k + 2 * (at - first)] == expected
    assert (whole[: 2 * at] == -7).all() and (whole[2 * (at + size) :] == -7).all()
