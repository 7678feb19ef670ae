"""Which column a cell is in: worked out from where the columns begin, not kept for every cell.

Cells are numbered column by column. *Milestones*, the columns of every 32nd cell, say about where to look; in
a level with one floor the first look finds it.
"""

import numpy as np

from surefoot.kernels import allocating_kernel, kernel

__all__ = ["about_column", "column_of", "columns_of", "columns_of_all", "find_column", "milestones"]

_SHIFT = 5
_SIDE = 1 << _SHIFT


@kernel(error_model="numpy")
def find_column(column_start, milestone, k):
    """The column of cell ``k``, int64."""
    low, high = np.int64(milestone[k >> _SHIFT]), np.int64(milestone[(k >> _SHIFT) + 1])
    guess = min(low + (k & (_SIDE - 1)), high)  # right where every column has one cell
    if column_start[guess] > k:
        high = guess - 1
    elif column_start[guess + 1] > k:
        return guess
    else:
        low = guess + 1
    while low < high:  # the last column that begins at k or before it
        middle = (low + high + 1) >> 1
        if column_start[middle] <= k:
            low = middle
        else:
            high = middle - 1
    return low


@kernel(error_model="numpy", forceinline=True)
def about_column(net, k):
    """Where `column_of` looks first."""
    return np.int64(net.milestone[k >> _SHIFT]) + (k & (_SIDE - 1))


@kernel(error_model="numpy", forceinline=True)
def column_of(net, k):
    """The column of cell ``k``, int64; ``net`` has column_start and milestone."""
    return find_column(net.column_start, net.milestone, np.int64(k))


@allocating_kernel(nogil=True)
def milestones(column_start):
    """(⌈n / 32⌉ + 1,) int32: the columns of the cells 0, 32, 64 …, and of the last one."""
    cells = np.int64(column_start[-1])
    milestone = np.zeros(((cells + _SIDE - 1) >> _SHIFT) + 1, np.int32)
    column, last = np.int64(0), np.int64(column_start.shape[0] - 2)
    for block in range(milestone.shape[0] if cells > 0 else 0):
        cell = min(block << _SHIFT, cells - 1)
        column = min(column + _SIDE, last)
        while column_start[column] > cell:
            column -= 1
        while column_start[column + 1] <= cell:
            column += 1
        milestone[block] = column
    return milestone


@allocating_kernel
def columns_of(column_start, milestone, cells):
    """(k,) int32: the columns of ``cells`` (k,) int64."""
    columns = np.empty(cells.shape[0], np.int32)
    for i in range(cells.shape[0]):
        columns[i] = find_column(column_start, milestone, cells[i])
    return columns


def columns_of_all(column_start: np.ndarray) -> np.ndarray:
    """(n,) int32: the columns of all cells."""
    return np.repeat(np.arange(len(column_start) - 1, dtype=np.int32), np.diff(column_start))
