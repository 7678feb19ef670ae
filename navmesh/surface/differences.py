"""Where cells that were found anew differ from those that were there: most of what lies beside a change is
found again as it was."""

import numpy as np

from navmesh.level.raster import Patch
from navmesh.surface.build import Cells, Window
from navmesh.surface.columns import columns_of_all
from navmesh.surface.splicing import take
from surefoot.kernels import allocating_kernel

__all__ = ["differing_window"]


def differing_window(old: Cells, fresh: Cells, window: Window, around: Patch, ny: int) -> Window | None:
    """The least part of ``window`` that holds all its columns in which ``fresh``, the cells of the patch
    ``around``, are not bit for bit those of ``old``, the whole with ``ny`` columns along y; None where there
    are none. The cells just outside of the window are alike in both."""
    inside = np.array(window) - np.tile([around.left, around.near], 2)
    one = _bits(old, window, ny)
    other = _bits(fresh, tuple(inside.tolist()), around.ny)
    alike = _alike(*one, *other).reshape(window[2] - window[0], window[3] - window[1])
    ix, iy = np.flatnonzero(~alike.all(axis=1)), np.flatnonzero(~alike.all(axis=0))
    if not len(ix):
        return None
    left, near = window[:2]
    return int(left + ix[0]), int(near + iy[0]), int(left + ix[-1] + 1), int(near + iy[-1] + 1)


def _bits(cells: Cells, window: Window, ny: int) -> tuple[np.ndarray, ...]:
    """All that there is of the columns of ``window``, floats as int64: 0.0 is not -0.0."""
    part, first = take(cells, window, ny)
    start = part.column_start
    column = columns_of_all(start)
    strip, along = np.divmod(column, window[3] - window[1])
    where = first[column] + np.arange(len(column)) - start[column]
    place = cells.floor.places(cells.column_start, (window[0] + strip) * ny + window[1] + along, where)
    floor = np.column_stack([cells.floor.height[place], cells.floor.slopes[cells.floor.slope[place]]])
    return (
        start, part.storey, floor.view(np.int64), part.list_cell, part.list_start,
        part.blocker.view(np.int64),
    )  # fmt: skip


@allocating_kernel(nogil=True)
def _alike(
    start, storey, floor, list_cell, list_start, blocker,
    to_start, to_storey, to_floor, to_list_cell, to_list_start, to_blocker,
):  # fmt: skip
    """(columns,) bool: which columns have the same cells, with the same lists of blockers, in both."""
    alike = np.empty(start.shape[0] - 1, np.bool_)
    own = to = 0
    for c in range(alike.shape[0]):
        cells = start[c + 1] - start[c]
        same = cells == to_start[c + 1] - to_start[c]
        for k in range(cells if same else 0):
            a, b = start[c] + k, to_start[c] + k
            for way in range(4):
                same &= storey[a, way] == to_storey[b, way]
            for i in range(3):
                same &= floor[a, i] == to_floor[b, i]
        first, to_first = own, to
        while own < list_cell.shape[0] and list_cell[own] < start[c + 1]:
            own += 1
        while to < to_list_cell.shape[0] and to_list_cell[to] < to_start[c + 1]:
            to += 1
        same &= own - first == to - to_first
        for i in range(own - first if same else 0):
            a, b = first + i, to_first + i
            same &= list_cell[a] - start[c] == to_list_cell[b] - to_start[c]
            size = list_start[a + 1] - list_start[a]
            same &= size == to_list_start[b + 1] - to_list_start[b]
            for k in range(size if same else 0):
                for end in range(4):
                    same &= blocker[list_start[a] + k, end] == to_blocker[to_list_start[b] + k, end]
        alike[c] = same
    return alike
