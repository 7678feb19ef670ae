"""Windows: rectangles of columns, by themselves and in the whole."""

import numpy as np

from surefoot.kernels import allocating_kernel, kernel

__all__ = ["columns_in", "links_in", "links_within"]


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
def links_within(link, start, first, window, found):
    """Fill in the links of the cells of a ``window``, by the cells' numbers in it; -1 for those that lead
    out. ``start`` and ``first`` are those of `columns_in`. Cells of a strip are in a row, in the window and
    in the whole, so all links to a strip change by the same number."""
    across, along = window[2] - window[0], window[3] - window[1]
    for i in range(across if along > 0 else 0):
        left, here, right = max(i - 1, 0) * along, i * along, min(i + 1, across - 1) * along
        size = start[here + along] - start[here]
        given = link[first[here] : first[here] + size]
        taken = found[start[here] : start[here] + size]
        by = np.int32(start[here] - first[here])
        ahead, back = np.int32(start[right] - first[right]), np.int32(start[left] - first[left])
        for k in range(size):
            for d in range(4):
                m = given[k, d]
                shift = ahead if d == 0 else (back if d == 2 else by)
                taken[k, d] = np.int32(m + shift) if m >= 0 else m
        if i == 0:
            taken[:, 2] = -1
        if i == across - 1:
            taken[:, 0] = -1
        taken[: start[here + 1] - start[here], 3] = -1
        taken[start[here + along - 1] - start[here] :, 1] = -1


@allocating_kernel
def links_in(column_start, link, window, ny):
    """The links (n, 4) int32 among the cells of ``window``, and the numbers (n,) int32 of these."""
    start, first = columns_in(column_start, window, ny)
    found, where = np.empty((start[-1], 4), np.int32), np.empty(start[-1], np.int32)
    links_within(link, start, first, window, found)
    for c in range(first.shape[0]):
        for k in range(start[c], start[c + 1]):
            where[k] = first[c] + k - start[c]
    return found, where
