"""The columns of a window, by themselves."""

import numpy as np

from navmesh.surface.windows import columns_in


def test_a_window_counts_its_own_cells_and_knows_where_they_are_in_the_whole():
    counts = np.array([[1, 2, 0, 1], [0, 3, 1, 1], [2, 1, 1, 0]])
    whole = np.concatenate([[0], np.cumsum(counts.ravel())]).astype(np.int32)
    start, first = columns_in(whole, np.array([1, 1, 3, 3]), 4)
    assert start.tolist() == [0, 3, 4, 5, 6]
    assert first.tolist() == [4, 7, 11, 12]
    start, first = columns_in(whole, np.array([1, 2, 1, 3]), 4)
    assert start.tolist() == [0] and not len(first)
