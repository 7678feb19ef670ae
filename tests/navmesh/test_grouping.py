"""Groups are what sorting by them gives."""

import numpy as np

from navmesh.grouping import by_group, grouped


def test_numbers_are_listed_by_group():
    start, leap = by_group(np.array([0, 0, 1, 2, 0], np.int32), 4)
    assert [leap[start[p] : start[p + 1]].tolist() for p in range(4)] == [[0, 1, 4], [2], [3], []]


def test_values_are_sorted_by_group_and_stay_in_order_within_it():
    rng = np.random.default_rng(0)
    group, value = rng.integers(0, 9, 100), rng.random((100, 2))
    start, numbers, values = grouped(group, 11, np.arange(100), value)
    order = np.argsort(group, kind="stable")
    np.testing.assert_array_equal(numbers, order)
    np.testing.assert_array_equal(values, value[order])
    np.testing.assert_array_equal(start, np.searchsorted(group[order], np.arange(12)))


def test_values_are_grouped_in_their_order():
    start, values = grouped(np.array([2, 0, 2, 1]), 4, np.array([10, 11, 12, 13]))
    assert start.tolist() == [0, 1, 2, 4, 4]
    assert values.tolist() == [11, 13, 10, 12]
