"""Windows: rectangles of columns, by themselves and in the whole."""

import numpy as np

from navmesh.surface.storeys import APART
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["cells_within", "columns_in", "storeys_within"]


@allocating_kernel
def columns_in(column_start, window, ny):
    """``column_start`` of the columns of ``window`` by themselves, and the first cell of each in the
    whole."""
    across, along = window[2] - window[0], window[3] - window[1]
    start, first = np.empty(across * along + 1, np.int32), np.empty(across * along, np.int32)
    start[0] = 0
    for i in range(across):
        here = (window[0] + i) * ny + window[1]
        for j in range(along):
            c = i * along + j
            first[c] = column_start[here + j]
            start[c + 1] = start[c] + column_start[here + j + 1] - first[c]
    return start, first


@kernel
def storeys_within(storey, start, first, window, found):
    """Fill in the storeys of the cells of a ``window``; `APART` for those that lead out. ``start`` and
    ``first`` are those of `columns_in`. Cells of a strip are in a row, in the window and in the whole."""
    across, along = window[2] - window[0], window[3] - window[1]
    for i in range(across if along > 0 else 0):
        here = i * along
        size = start[here + along] - start[here]
        taken = found[start[here] : start[here] + size]
        given = storey[first[here] : first[here] + size]
        for k in range(size):
            for way in range(4):
                taken[k, way] = given[k, way]
        if i == 0:
            taken[:, 2] = APART
        if i == across - 1:
            taken[:, 0] = APART
        taken[: start[here + 1] - start[here], 3] = APART
        taken[start[here + along - 1] - start[here] :, 1] = APART


@allocating_kernel
def cells_within(column_start, storey, window, ny):
    """The cells of a ``window`` by themselves: ``column_start``, the storeys of each, and its number in the
    whole (n,) int32."""
    start, first = columns_in(column_start, window, ny)
    count = start[-1]
    found, where = np.empty((count, 4), np.uint8), np.empty(count, np.int32)
    storeys_within(storey, start, first, window, found)
    for c in range(first.shape[0]):
        for k in range(start[c], start[c + 1]):
            where[k] = first[c] + k - start[c]
    return start, found, where
