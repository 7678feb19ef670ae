"""A window of cells is put in the place of those that were there."""

import numpy as np
import pytest

from navmesh.level.raster import Patch
from navmesh.surface.build import LinkedCells, lists_of
from navmesh.surface.columns import columns_of_all
from navmesh.surface.splicing import moved_list, renumber_run, splice, take
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
    of = np.repeat(height, storey)
    return LinkedCells(start, beside, *lists_of(storey), np.tile(of[:, None], 4))


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
    within = inside[columns_of_all(expected.column_start)]
    count = np.diff(expected.list_start)
    expected.blocker[:] += 0.5 * np.repeat(within[expected.list_cell], count)[:, None]
    found, moves = splice(old, new, window, Patch(0.25, 0, 0, NX, NY), NY)
    for name in ("column_start", "list_cell", "list_start", "blocker"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name), name)
    # links from outside into the window are those of the old part, which knew as many storeys there as it had
    np.testing.assert_array_equal(found.storey[within], expected.storey[within])
    # lists of cells outside are found again
    column = columns_of_all(old.column_start)[old.list_cell]
    for own in np.flatnonzero(~inside[column]):
        cell = found.column_start[column[own]] + old.list_cell[own] - old.column_start[column[own]]
        assert found.list_cell[moved_list(moves, own)] == cell


def test_a_window_taken_is_what_lies_there():
    counts = np.random.default_rng(4).integers(0, 4, NX * NY)
    whole = cells(counts, 0.0)
    part, first = take(whole, (1, 1, 3, 3), NY)
    there = [1 * NY + 1, 1 * NY + 2, 2 * NY + 1, 2 * NY + 2]
    np.testing.assert_array_equal(first, whole.column_start[there])
    np.testing.assert_array_equal(np.diff(part.column_start), counts[there])
    storeys = np.concatenate([np.arange(counts[c]) for c in there])
    lists = lists_of(storeys)
    np.testing.assert_array_equal(part.list_cell, lists[0])
    np.testing.assert_array_equal(part.list_start, lists[1])
    height = np.concatenate([100.0 * c + np.arange(counts[c]) for c in there])
    np.testing.assert_array_equal(part.blocker[:, 0], np.repeat(height, storeys))


@pytest.mark.parametrize(
    "first, size, at", [(0, 5000, 0), (0, 5000, 40), (3000, 6500, 2500), (9000, 1000, 9700)]
)
def test_numbers_of_lists_move_with_the_lists(first, size, at):
    rng = np.random.default_rng(size)
    begin = np.array([0, 1200, 3000, 7000])  # of the lists that move alike
    moves = np.column_stack([begin, [0, 17, -5, 300]]).astype(np.int64)
    numbers = rng.integers(-1, 10_000, 10_000).astype(np.int32)
    numbers[::3] = np.clip(numbers[::3], 3000, 6999)
    numbers[first : first + 4500] = rng.integers(3000, 7000, 10_000)[first : first + 4500]
    whole = np.full(20_000, -7, np.int32)
    renumber_run(numbers, first, size, at, 3000, 7000, -5, moves, whole)
    by = moves[np.searchsorted(begin, numbers, side="right") - 1, 1]
    expected = np.where(numbers < 0, -1, numbers + by)
    np.testing.assert_array_equal(whole[at : at + size], expected[first : first + size])
    assert (whole[:at] == -7).all() and (whole[at + size :] == -7).all()
