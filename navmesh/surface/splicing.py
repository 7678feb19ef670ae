"""Cells of a window put in the place of those that were there.

What is not in the window lies in runs, from one strip of the window to the next: all of a run moves by the
same number of places.
"""

import numpy as np

from navmesh.level.raster import Patch
from navmesh.surface.build import LinkedCells, Window
from navmesh.surface.windows import columns_in, storeys_within
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["copy_run", "renumber_run", "runs_of", "splice", "take"]

_BLOCK = 2048
"""So many numbers are moved at a time, before it is looked whether all could be moved alike."""


def splice(old: LinkedCells, new: LinkedCells, window: Window, patch: Patch, ny: int) -> LinkedCells:
    """``old`` with the columns of ``window`` as in ``new``, the cells of ``patch``; those just outside of the
    window are alike in both. ``ny``: of the whole grid."""
    runs, count = runs_of(old.column_start, new.column_start, window, patch, ny)
    blockers = 0
    for fresh, first, size, _ in runs.tolist():
        lists = (new if fresh else old).blocker_start
        blockers += int(lists[first + size]) - int(lists[first])
    # numpy takes large arrays in large pages, which is twice as fast
    found = LinkedCells(
        np.empty(len(old.column_start), np.int32), np.empty(count, np.int32), np.empty((count, 4), np.uint8),
        np.empty(count + 1, np.int32), np.empty((blockers, 4)),
    )  # fmt: skip
    _columns(
        old.column_start, old.cell_column, new.column_start, np.array(window), patch, ny, runs,
        found.column_start, found.cell_column,
    )  # fmt: skip
    _fill(
        old.storey.reshape(-1), old.blocker_start, old.blocker.reshape(-1),
        new.storey.reshape(-1), new.blocker_start, new.blocker.reshape(-1),
        runs, found.storey.reshape(-1), found.blocker_start, found.blocker.reshape(-1),
    )  # fmt: skip
    return found


def runs_of(
    old_start: np.ndarray, new_start: np.ndarray, window: Window, patch: Patch, ny: int
) -> tuple[np.ndarray, int]:
    """The runs of `runs_around`, and the number of cells of the whole."""
    runs = np.empty((2 * (window[2] - window[0]) + 1, 4), np.int64)
    return runs, int(runs_around(old_start, new_start, np.array(window), patch, ny, runs))


@kernel
def runs_around(old_start, new_start, window, patch, ny, runs):
    """The runs of cells of the whole, in order: rows of ``runs`` (2·strips + 1, 4): whether they are new, the
    first cell, the number of cells, and where the first comes to lie in the whole. Returns the number of
    cells of the whole."""
    at, done, row = 0, 0, 0
    for ix in range(window[0], window[2]):
        here = ix * ny
        begin, end = old_start[here + window[1]], old_start[here + window[3]]
        inside = (ix - patch.left) * patch.ny - patch.near
        first, last = new_start[inside + window[1]], new_start[inside + window[3]]
        runs[row, 0], runs[row, 1], runs[row, 2], runs[row, 3] = 0, done, begin - done, at
        at += begin - done
        runs[row + 1, 0], runs[row + 1, 1], runs[row + 1, 2], runs[row + 1, 3] = 1, first, last - first, at
        at += last - first
        done = end
        row += 2
    runs[row, 0], runs[row, 1], runs[row, 2], runs[row, 3] = 0, done, old_start[-1] - done, at
    return at + old_start[-1] - done


@kernel
def _columns(old_start, old_owner, new_start, window, patch, ny, runs, start, owner):
    """Fill in ``column_start`` and ``cell_column`` of the whole."""
    column = 0  # of the whole, up to which all is filled in
    for row in range(runs.shape[0]):
        first, at = runs[row, 1], runs[row, 3]
        if runs[row, 0] == 1:
            ix = window[0] + row // 2
            end = ix * ny + window[3]
            inside = (ix - patch.left) * patch.ny - patch.near - ix * ny
            for c in range(column, end):
                start[c] = new_start[inside + c] - first + at
        else:
            last = row == runs.shape[0] - 1
            end = start.shape[0] if last else (window[0] + row // 2) * ny + window[1]
            add_run(old_start, column, end - column, at - first, start, column)
        column = end
    for row in range(runs.shape[0]):
        first, size, at = runs[row, 1], runs[row, 2], runs[row, 3]
        if runs[row, 0] == 0:
            copy_run(old_owner, first, size, owner, at)
            continue
        ix = window[0] + row // 2
        for c in range(ix * ny + window[1], ix * ny + window[3]):
            for k in range(start[c], start[c + 1]):
                owner[k] = c


@kernel
def _fill(old_storey, old_list, old_blocker, new_storey, new_list, new_blocker, runs, storey, lists, blocker):
    """Fill in the whole. Storeys and blockers are flat."""
    blockers = 0
    for row in range(runs.shape[0]):
        first, size, at = runs[row, 1], runs[row, 2], runs[row, 3]
        fresh = runs[row, 0] == 1
        part_list, part_blocker = (new_list, new_blocker) if fresh else (old_list, old_blocker)
        begin, end = part_list[first], part_list[first + size]
        copy_run(part_blocker, 4 * begin, 4 * (end - begin), blocker, 4 * blockers)
        add_run(part_list, first, size, blockers - begin, lists, at)
        blockers += end - begin
        copy_run(new_storey if fresh else old_storey, 4 * first, 4 * size, storey, 4 * at)
    lists[lists.shape[0] - 1] = blockers


@kernel
def copy_run(values, first, size, whole, at):
    """Copy ``size`` of the ``values`` (k,), from ``first`` on, into the ``whole`` from ``at`` on."""
    given, taken = values[first : first + size], whole[at : at + size]
    for k in range(size):  # over slices it compiles to vector code
        taken[k] = given[k]


@kernel
def add_run(values, first, size, by, whole, at):
    """As `copy_run`, with ``by`` added to each."""
    given, taken, step = values[first : first + size], whole[at : at + size], np.int32(by)
    for k in range(size):
        taken[k] = np.int32(given[k] + step)


@kernel
def renumber_run(numbers, each, first, size, at, old_column, old_start, start, whole):
    """Copy a run of ``numbers`` of cells (k,), ``each`` of them for a cell, into the ``whole``, as the
    numbers that these cells have there; those below 0 stay. Nearly all are of the run, which moves as one."""
    shift, last = at - first, first + size
    for begin in range(each * first, each * last, _BLOCK):
        end = min(begin + _BLOCK, each * last)
        given, taken = numbers[begin:end], whole[begin + each * shift : end + each * shift]
        least, most = _shift(given, shift, taken)
        if least < first or most >= last:
            for k in range(end - begin):
                m = given[k]
                if m >= last or 0 <= m < first:
                    taken[k] = start[old_column[m]] + m - old_start[old_column[m]]


@kernel
def _shift(given, shift, taken):
    """Fill ``taken`` with the numbers ``given`` (k,) and ``shift`` added, except to those below 0. Returns
    the least of those that it was added to, and the greatest."""
    none, step = np.int32(0x7FFFFFFF), np.int32(shift)
    least, most = none, np.int32(-1)
    for k in range(given.shape[0]):
        m = given[k]
        most = max(most, m)
        least = min(least, m if m >= 0 else none)
        taken[k] = np.int32(m + step) if m >= 0 else m
    return least, most


def take(cells: LinkedCells, window: Window, ny: int) -> tuple[LinkedCells, np.ndarray]:
    """The columns of ``window`` by themselves, links that lead out of it being cut, and which is the first
    cell of each of them in the whole: (columns,) int32. ``ny``: of the whole grid."""
    *arrays, first = _take(
        cells.column_start, cells.storey, cells.blocker_start, cells.blocker, np.array(window), ny
    )  # fmt: skip
    return LinkedCells(*arrays), first


@allocating_kernel
def _take(column_start, storey, blocker_start, blocker, window, ny):
    start, first = columns_in(column_start, window, ny)
    count = start[-1]
    owner, lists = np.empty(count, np.int32), np.empty(count + 1, np.int32)
    to_storey = np.empty((count, 4), np.uint8)
    lists[0] = 0
    storeys_within(storey, start, first, window, to_storey)
    for c in range(first.shape[0]):
        for k in range(start[c], start[c + 1]):
            m = first[c] + k - start[c]
            owner[k] = c
            lists[k + 1] = lists[k] + blocker_start[m + 1] - blocker_start[m]
    to_blocker = np.empty((lists[count], 4))
    for c in range(first.shape[0]):
        begin, size = blocker_start[first[c]], lists[start[c + 1]] - lists[start[c]]
        to_blocker[lists[start[c]] : lists[start[c + 1]]] = blocker[begin : begin + size]
    return start, owner, to_storey, lists, to_blocker, first
