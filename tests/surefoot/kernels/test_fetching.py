"""Memory that is asked for ahead: nothing is read, whatever the row."""

import numpy as np
import pytest
from numba import float64, int32, njit
from numba.core.errors import TypingError

from surefoot.kernels.bundles import Bundle, BundleType, aligned, rows
from surefoot.kernels.fetching import fetch

ROW = np.dtype([("pair", "f8", 2), ("number", "i4"), ("", "i4")])
KIND = BundleType(grid=float64[:, ::1], rows=rows(ROW), numbers=int32[::1])


@njit
def total(bundle, ahead):
    found = 0.0
    for i in range(bundle.numbers.size):
        fetch(bundle.numbers, i + ahead)
        fetch(bundle.grid, i + ahead)
        fetch(bundle.pair, i + ahead)
        found += bundle.numbers[i] + bundle.grid[i, 1] + bundle.pair[i, 0]
    return found


@pytest.mark.parametrize("ahead", [0, 3, -1, 10**6, -(10**9)])
def test_rows_that_are_not_there_do_no_harm(ahead: int) -> None:
    grid, table = np.arange(12.0).reshape(4, 3), aligned(4, ROW)
    table["pair"] = 0.5
    bundle = Bundle(KIND, grid=grid, rows=table, numbers=np.arange(4, dtype=np.int32))
    assert total(bundle, ahead) == 6.0 + grid[:, 1].sum() + 2.0


def test_the_processor_is_told() -> None:
    @njit
    def first(array):
        fetch(array, 5)
        return array[0]

    assert first(np.ones(9)) == 1.0
    (code,) = first.inspect_llvm().values()
    assert "call void @llvm.prefetch" in code


def test_what_is_no_array_is_refused() -> None:
    @njit
    def wrong(number):
        fetch(number, 0)

    with pytest.raises(TypingError, match="fetch"):
        wrong(1.0)
