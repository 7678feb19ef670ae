"""Bundles: what compiled code reads is what was put in."""

import numpy as np
import pytest
from numba import float64, int32, int64, njit

from surefoot.kernels.bundles import Bundle, BundleType, aligned, rows

ROW = np.dtype([("pair", "f8", 2), ("number", "i4"), ("part", "f4", (2, 3))])
KIND = BundleType(size=float64, count=int64, grid=int32[:, ::1], rows=rows(ROW))


@njit
def read(bundle, i):
    bundle.grid[1, 2] += 1
    return (
        bundle.size * bundle.count, bundle.grid[i, 2], bundle.grid.shape, bundle.pair[i, 1], bundle.number[i],
        bundle.part[i, 1, 2], bundle.part.shape, bundle.number.size,
    )  # fmt: skip


def values() -> dict:
    table = aligned(5, ROW)
    table["pair"] = np.arange(10.0).reshape(5, 2)
    table["number"] = np.arange(5) * 7
    table["part"] = np.arange(30).reshape(5, 2, 3) / 4
    return {"size": 2.5, "count": 4, "grid": np.arange(12, dtype=np.int32).reshape(3, 4), "rows": table}


def test_kernels_read_numbers_arrays_and_columns() -> None:
    bundle = Bundle(KIND, **values())
    for i in range(3):
        grid = bundle.grid.copy()
        grid[1, 2] += 1
        row = bundle.rows[i]
        assert read(bundle, i) == (
            10.0, grid[i, 2], (3, 4), row["pair"][1], row["number"], row["part"][1, 2], (5, 2, 3), 5,
        )  # fmt: skip
        assert np.array_equal(bundle.grid, grid)


def test_rows_begin_with_a_line_of_the_cache() -> None:
    for count in range(1, 5):
        table = aligned(count, ROW)
        assert len(table) == count and table.ctypes.data % 64 == 0


def test_what_does_not_fit_is_refused() -> None:
    for name, value in (
        ("grid", np.zeros((3, 4))),
        ("grid", np.zeros(3, np.int32)),
        ("grid", np.zeros((4, 3), np.int32).T),
        ("rows", np.zeros(3, np.dtype([("pair", "f8", 2)]))),
    ):
        with pytest.raises(TypeError, match=name):
            Bundle(KIND, **{**values(), name: value})
    with pytest.raises(TypeError, match="more: expected size, count"):
        Bundle(KIND, **values(), more=1)
