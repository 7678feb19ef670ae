"""Cells of a window put in the place of those that were there."""

import numpy as np

from navmesh.surface.build import Cells, Window
from surefoot.kernels import allocating_kernel

__all__ = ["splice"]


def splice(old: Cells, new: Cells, window: Window, ny: int) -> Cells:
    """``old`` with the columns of ``window`` as in ``new``; those just outside of it are alike in both."""
    column_start, cell_column, old_at, new_at = _places(
        old.column_start, new.column_start, np.array(window), ny
    )
    count = len(cell_column)
    height, gradient, link = np.empty(count), np.empty((count, 2)), np.empty((count, 4), np.int32)
    blocker_start = np.zeros(count + 1, np.int32)
    for part, at in ((old, old_at), (new, new_at)):
        kept = at >= 0
        blocker_start[1:][at[kept]] = np.diff(part.blocker_start)[kept]
    blocker_start = np.cumsum(blocker_start, dtype=np.int32)
    blocker = np.empty((blocker_start[-1], 4))
    for part, at in ((old, old_at), (new, new_at)):
        _copy(
            part.column_start, part.cell_column, part.height, part.gradient, part.link,
            part.blocker_start, part.blocker, at,
            column_start, height, gradient, link, blocker_start, blocker,
        )  # fmt: skip
    return Cells(column_start, cell_column, height, gradient, link, blocker_start, blocker)


@allocating_kernel
def _places(old_start, new_start, window, ny):
    """``column_start`` and ``cell_column`` of the whole, and where each old and each new cell comes to lie in
    it, or -1."""
    columns = len(old_start) - 1
    old_at = np.full(old_start[-1], -1, np.int32)
    new_at = np.full(new_start[-1], -1, np.int32)
    start = np.empty(columns + 1, np.int32)
    owner = np.empty(old_start[-1] + new_start[-1], np.int32)
    count = 0
    for c in range(columns):
        start[c] = count
        ix = c // ny
        iy = c - ix * ny
        inside = window[0] <= ix < window[2] and window[1] <= iy < window[3]
        first, last = (new_start[c], new_start[c + 1]) if inside else (old_start[c], old_start[c + 1])
        for k in range(first, last):
            if inside:
                new_at[k] = count
            else:
                old_at[k] = count
            owner[count] = c
            count += 1
    start[columns] = count
    return start, owner[:count].copy(), old_at, new_at


@allocating_kernel
def _copy(
    start, owner, height, gradient, link, blocker_start, blocker, at,
    whole_start, to_height, to_gradient, to_link, to_blocker_start, to_blocker,
):  # fmt: skip
    for k in range(len(at)):
        n = at[k]
        if n < 0:
            continue
        to_height[n] = height[k]
        to_gradient[n, 0], to_gradient[n, 1] = gradient[k, 0], gradient[k, 1]
        for i in range(blocker_start[k + 1] - blocker_start[k]):
            to_blocker[to_blocker_start[n] + i] = blocker[blocker_start[k] + i]
        for d in range(4):
            m = link[k, d]
            # the same one of its column's cells: also where that column is from the other part
            to_link[n, d] = whole_start[owner[m]] + m - start[owner[m]] if m >= 0 else -1
