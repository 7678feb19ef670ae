"""Columns of cells, worked out from where the columns begin."""

import numpy as np
import pytest

from navmesh.surface.columns import columns_of, columns_of_all, milestones

COUNTS = {
    "one floor": np.ones(1000, np.int32),
    "holes": np.random.default_rng(1).integers(0, 2, 1000),
    "storeys": np.random.default_rng(2).integers(0, 9, 700),
    "a tower beside nothing": np.repeat([0, 200, 0, 1, 0], [300, 2, 900, 3, 400]),
    "one cell": np.array([0, 0, 1, 0]),
    "nothing": np.zeros(50, np.int32),
}


@pytest.mark.parametrize("name", COUNTS)
def test_of_every_cell(name):
    counts = COUNTS[name]
    start = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    expected = np.repeat(np.arange(len(counts)), counts)
    np.testing.assert_array_equal(columns_of_all(start), expected)
    milestone = milestones(start)
    np.testing.assert_array_equal(milestone[:-1], expected[::32])
    np.testing.assert_array_equal(columns_of(start, milestone, np.arange(start[-1])), expected)
