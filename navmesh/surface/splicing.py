"""Cells of a window put in the place of those that were there.

What is not in the window lies in runs, from one strip of the window to the next: all of a run moves by the
same number of places.
"""

import numpy as np

from navmesh.level.raster import Patch
from navmesh.surface.build import LinkedCells, Window
from navmesh.surface.windows import columns_in, storeys_within
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["copy_run", "first_list", "moved_list", "renumber_run", "runs_of", "splice", "take"]

_BLOCK = 2048
"""So many numbers are moved at a time, before it is looked whether all could be moved alike."""


def splice(
    old: LinkedCells, new: LinkedCells, window: Window, patch: Patch, ny: int
) -> tuple[LinkedCells, np.ndarray]:
    """``old`` with the columns of ``window`` as in ``new``, the cells of ``patch``; those just outside of the
    window are alike in both. And how the lists of blockers move: rows (r, 2) int64 of the first list of old
    that does, and by how much, up to the next row's. ``ny``: of the whole grid."""
    runs, count = runs_of(old.column_start, new.column_start, window, patch, ny)
    lists = np.empty((len(runs), 3), np.int64)
    room, blockers = _list_runs(old.list_cell, old.list_start, new.list_cell, new.list_start, runs, lists)
    # numpy takes large arrays in large pages, which is twice as fast
    found = LinkedCells(
        np.empty(len(old.column_start), np.int32), np.empty((count, 4), np.uint8),
        np.empty(room, np.int32), np.empty(room + 1, np.int32), np.empty((blockers, 4)),
    )  # fmt: skip
    _columns(old.column_start, new.column_start, np.array(window), patch, ny, runs, found.column_start)
    _fill(
        old.storey.reshape(-1), old.list_cell, old.list_start, old.blocker.reshape(-1),
        new.storey.reshape(-1), new.list_cell, new.list_start, new.blocker.reshape(-1),
        runs, lists, found.storey.reshape(-1), found.list_cell, found.list_start, found.blocker.reshape(-1),
    )  # fmt: skip
    kept = lists[::2]
    return found, np.column_stack([kept[:, 0], kept[:, 2] - kept[:, 0]])


@kernel
def first_list(list_cell, cell):
    """The first list of blockers that is of ``cell`` or one after it; ``list_cell`` as in `Surface`."""
    low, high = np.int64(0), np.int64(list_cell.shape[0])
    while low < high:
        middle = (low + high) >> 1
        if list_cell[middle] < cell:
            low = middle + 1
        else:
            high = middle
    return low


@kernel
def moved_list(moves, own):
    """The number that list ``own`` of before has after a change, ``moves`` being those of `splice`; anything
    where the change has replaced it."""
    low, high = np.int64(0), np.int64(moves.shape[0])
    while high - low > 1:
        middle = (low + high) >> 1
        if moves[middle, 0] <= own:
            low = middle
        else:
            high = middle
    return own + moves[low, 1]


@kernel
def _list_runs(old_cell, old_start, new_cell, new_start, runs, lists):
    """Fill in ``lists`` (r, 3): for each of the ``runs`` of cells the first of its lists, how many there are,
    and the number of the first in the whole. Returns how many lists the whole has, and how many blockers."""
    count = blockers = 0
    for row in range(runs.shape[0]):
        cell, start = (new_cell, new_start) if runs[row, 0] == 1 else (old_cell, old_start)
        first = first_list(cell, runs[row, 1])
        last = first_list(cell, runs[row, 1] + runs[row, 2])
        lists[row, 0], lists[row, 1], lists[row, 2] = first, last - first, count
        count += last - first
        blockers += start[last] - start[first]
    return count, blockers


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


@kernel(nogil=True)
def _columns(old_start, new_start, window, patch, ny, runs, start):
    """Fill in ``column_start`` of the whole."""
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


@kernel(nogil=True)
def _fill(
    old_storey, old_cell, old_start, old_blocker, new_storey, new_cell, new_start, new_blocker,
    runs, lists, storey, list_cell, list_start, blocker,
):  # fmt: skip
    """Fill in the whole. Storeys and blockers are flat."""
    blockers = 0
    for row in range(runs.shape[0]):
        first, size, at = runs[row, 1], runs[row, 2], runs[row, 3]
        own, count, to = lists[row, 0], lists[row, 1], lists[row, 2]
        fresh = runs[row, 0] == 1
        part_cell, part_start = (new_cell, new_start) if fresh else (old_cell, old_start)
        begin, end = part_start[own], part_start[own + count]
        copy_run(new_storey if fresh else old_storey, 4 * first, 4 * size, storey, 4 * at)
        add_run(part_cell, own, count, at - first, list_cell, to)
        add_run(part_start, own, count, blockers - begin, list_start, to)
        copy_run(
            new_blocker if fresh else old_blocker, 4 * begin, 4 * (end - begin), blocker, 4 * blockers
        )  # fmt: skip
        blockers += end - begin
    list_start[list_start.shape[0] - 1] = blockers


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
def renumber_run(numbers, first, size, at, low, high, shift, moves, whole):
    """Copy a run of ``numbers`` of lists (n,) into the ``whole``, as the numbers that these lists have there;
    -1 stays. Nearly all are from ``low`` up to, not including, ``high``, which move by ``shift``; the others
    as ``moves`` say, see `splice`."""
    for begin in range(first, first + size, _BLOCK):
        end = min(begin + _BLOCK, first + size)
        given, taken = numbers[begin:end], whole[begin + at - first : end + at - first]
        least, most = _shift(given, shift, taken)
        if least < low or most >= high:
            for k in range(end - begin):
                if given[k] >= high or 0 <= given[k] < low:
                    taken[k] = moved_list(moves, np.int64(given[k]))


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
        cells.column_start, cells.storey, cells.list_cell, cells.list_start, cells.blocker, np.array(window),
        ny,
    )  # fmt: skip
    return LinkedCells(*arrays), first


@allocating_kernel
def _take(column_start, storey, list_cell, list_start, blocker, window, ny):
    start, first = columns_in(column_start, window, ny)
    to_storey = np.empty((start[-1], 4), np.uint8)
    storeys_within(storey, start, first, window, to_storey)
    across, along = window[2] - window[0], window[3] - window[1]
    lists = np.empty((across, 2), np.int64)  # of each strip: the first, and the one after the last
    count = blockers = 0
    for i in range(across):
        here = (window[0] + i) * ny
        lists[i, 0] = first_list(list_cell, column_start[here + window[1]])
        lists[i, 1] = first_list(list_cell, column_start[here + window[3]])
        count += lists[i, 1] - lists[i, 0]
        blockers += list_start[lists[i, 1]] - list_start[lists[i, 0]]
    to_cell, to_start = np.empty(count, np.int32), np.empty(count + 1, np.int32)
    to_blocker = np.empty((blockers, 4))
    count = blockers = 0
    for i in range(across):
        shift = start[i * along] - column_start[(window[0] + i) * ny + window[1]]
        begin, end = list_start[lists[i, 0]], list_start[lists[i, 1]]
        for own in range(lists[i, 0], lists[i, 1]):
            to_cell[count] = list_cell[own] + shift
            to_start[count] = list_start[own] - begin + blockers
            count += 1
        to_blocker[blockers : blockers + end - begin] = blocker[begin:end]
        blockers += end - begin
    to_start[count] = blockers
    return start, to_storey, to_cell, to_start, to_blocker, first
