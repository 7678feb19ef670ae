"""What counts as a number where a caller hands one in."""

from decimal import Decimal

import numpy as np
import pytest

from surefoot.numeric import as_floats, as_point, is_finite, is_whole


@pytest.mark.parametrize("value", [0, -1.5, np.float32(2), np.int64(3), Decimal("0.5"), True, np.array(1.0)])
def test_finite_numbers(value):
    assert is_finite(value)


@pytest.mark.parametrize(
    "value", [float("nan"), float("inf"), -np.inf, 10**400, "1", None, 1j, [1.0], np.zeros(2), object()]
)
def test_all_else_is_not_one_finite_number(value):
    assert not is_finite(value)


@pytest.mark.parametrize(
    ("value", "whole"),
    [(0, True), (7, True), (np.uint8(3), True), (10**30, True), (-1, False), (np.int64(-1), False),
     (True, False), (1.0, False), (np.float64(2), False), ("1", False), (None, False)],
)  # fmt: skip
def test_whole_numbers_count_from_nought(value, whole):
    assert is_whole(value) is whole


def test_numbers_of_any_shape_become_floats():
    given = as_floats([[1, 2], [3, np.inf]])
    assert given is not None and given.dtype == np.float64 and given.tolist() == [[1.0, 2.0], [3.0, np.inf]]
    assert as_floats(5).shape == ()
    assert as_floats(np.array([True, False])).tolist() == [1.0, 0.0]


@pytest.mark.parametrize(
    "value", ["1", ["1", "2"], [[1, 2], [3]], [1, None, "x"], 1j, {"a": 1}, b"1", [object()], [10**400]]
)
def test_what_holds_no_numbers_or_uneven_rows_is_none(value):
    assert as_floats(value) is None


def test_the_array_is_a_copy():
    """What a caller does to its own array later does not count."""
    given = np.zeros(3)
    taken = as_floats(given)
    given[0] = 1.0
    assert taken.tolist() == [0.0, 0.0, 0.0]


def test_a_point_is_three_finite_numbers():
    assert as_point((1, 2.0, 3)).tolist() == [1.0, 2.0, 3.0]
    for wrong in ((1.0, 2.0), [[1.0, 2.0, 3.0]], (1.0, 2.0, float("nan")), "abc", None, (1.0, "x", 2.0)):
        assert as_point(wrong) is None
