"""Clearances after a change, without going over the whole level.

The two passes of `navmesh.surface.clearance` are gone through again for a rectangle of columns. What the
cells around it knew after each turn of a pass is recalled from before the change, by following their choices
back to the place itself. So the passes can be gone through as they were before, too. If the cells along the
rectangle's edge know the same after each turn both times, and none of it comes from a list of blockers that
has been found anew, nothing changes beyond, and all is bit for bit as if the passes had gone over the whole.
If not, the rectangle grows on that side. In the end, the cells that know other things than before lie in a
smaller rectangle, and what depends on clearances is renewed around that only.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from navmesh.level.raster import Patch, middle_of
from navmesh.surface.blockers import nearest_in_list
from navmesh.surface.build import LinkedCells, Window
from navmesh.surface.clearance import sweep
from navmesh.surface.columns import columns_of_all
from navmesh.surface.recall import came_from
from navmesh.surface.splicing import first_list, splice, take
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["Renewed", "renew_clearance"]

_MARGIN = 24
"""Columns around a change that are looked at first."""
_GROWTH = 0.5
"""Share of its extent by which the rectangle grows on a side where something changes beyond it."""


@dataclass(frozen=True, slots=True, eq=False)
class Renewed:
    """The cells of a rectangle of columns after a change, and what they know."""

    window: Window
    """The rectangle."""
    changed: Window
    """Outside of these columns of it no cell is other than before, nor its clearance, nor the place that is
    nearest to it; that place may have been carried there another way."""
    cells: LinkedCells
    """Of the rectangle; links that lead out of it are -1."""
    nearest: np.ndarray
    """(n, 2) float64, of these cells, before `settle_clearance`."""
    source: np.ndarray
    """(n,) int32: a list of the rectangle, -1, or -2 - l for the list l of the whole before."""
    choice: np.ndarray
    """(n,) uint8."""


def renew_clearance(
    old: LinkedCells,
    field: Any,
    fresh: LinkedCells,
    window: Window,
    around: Patch,
    whole: Patch,
    most: float,
) -> Renewed | None:
    """What comes of putting the columns of ``window`` from ``fresh``, the cells of the patch ``around``, in
    the place of those of ``old``, all cells of the grid ``whole``, whose `NET` is known. None where more
    than the share ``most`` of the grid would have to be looked at."""
    edge = np.array([0, 0, whole.nx, whole.ny])
    inner = _grown(np.array(window), np.full(4, _MARGIN), edge)
    while np.prod(inner[2:] - inner[:2]) <= most * whole.nx * whole.ny:
        outer = _grown(inner, np.ones(4, np.int64), edge)
        patch = Patch(whole.side, *outer[:2].tolist(), *(outer[2:] - outer[:2]).tolist())
        rectangle = tuple(outer.tolist())
        before, first = take(old, rectangle, whole.ny)
        limits = inner, np.array(window), _guarded(inner, edge)
        around_it = patch, field, whole, first, *limits
        disturbed, *was = _swept(*_arrays(before), *around_it)
        if not disturbed.any():
            cells, _ = splice(before, fresh, _seen_from(patch, window), _patch_from(patch, around), patch.ny)
            _, *now = _swept(*_arrays(cells), *around_it)
            disturbed, changed = _differences(
                before.column_start, before.list_cell, *was[:2],
                cells.column_start, cells.list_cell, *now[:2],
                patch, *limits,
            )  # fmt: skip
            if not disturbed.any():
                known, source, choice = now
                # `settle_clearance` looks a column farther
                reach = _grown(changed, np.ones(4, np.int64), edge)
                return Renewed(rectangle, tuple(reach.tolist()), cells, known[-1], source[-1], choice)
        extent = np.tile(inner[2:] - inner[:2], 2)
        inner = _grown(inner, np.where(disturbed, np.ceil(_GROWTH * extent), 0).astype(np.int64), edge)
    return None


def _seen_from(patch: Patch, window: Window) -> Window:
    """A window of the grid, counted from the corner of ``patch``."""
    left, near, right, far = window
    return left - patch.left, near - patch.near, right - patch.left, far - patch.near


def _patch_from(patch: Patch, other: Patch) -> Patch:
    return Patch(other.side, other.left - patch.left, other.near - patch.near, other.nx, other.ny)


def _arrays(cells: LinkedCells) -> tuple[np.ndarray, ...]:
    return (
        cells.column_start, columns_of_all(cells.column_start), cells.storey, cells.list_cell,
        cells.list_start, cells.blocker,
    )  # fmt: skip


def _grown(window: np.ndarray, by: np.ndarray, edge: np.ndarray) -> np.ndarray:
    low = np.maximum(window[:2] - by[:2], edge[:2])
    high = np.minimum(window[2:] + by[2:], edge[2:])
    return np.concatenate([low, high])


def _guarded(inner: np.ndarray, edge: np.ndarray) -> np.ndarray:
    """``inner`` with the sides that are at the edge of the grid moved out of sight: nothing lies beyond."""
    return np.where(inner == edge, edge + np.array([-2, -2, 2, 2]), inner)


@allocating_kernel
def _recalled(old, c, column, turn, patch, hops):
    """What cell ``c`` of ``column`` knew after ``turn``: (x, y, the list that it is from or -1, the column of
    that, room for hops)."""
    count = 0
    while True:
        other, turn, dx, dy = came_from(old, c, column, turn)
        if other < 0:
            break
        if count == hops.shape[0]:
            hops = np.concatenate((hops, np.empty_like(hops)))
        hops[count, 0], hops[count, 1] = dx, dy
        count += 1
        c = other
        column += dx * patch.ny + dy
    own = np.int64(old.source[c])
    if own < 0 or old.list_cell[own] != c:  # it has been told of something nearer since
        own = first_list(old.list_cell, c)
        if own == old.list_cell.shape[0] or old.list_cell[own] != c:
            return np.inf, np.inf, np.int64(-1), column, hops
    mx, my = middle_of(patch, column)
    x, y = nearest_in_list(old.blocker, old.list_start[own], old.list_start[own + 1], mx, my)
    for k in range(count - 1, -1, -1):  # one by one, as they were added
        if hops[k, 0] != 0:
            x += hops[k, 0] * patch.side
        if hops[k, 1] != 0:
            y += hops[k, 1] * patch.side
    return x, y, own, column, hops


@kernel(forceinline=True)
def _inside(patch, column, window):
    """Whether a column of ``patch`` is in ``window``."""
    ix = column // patch.ny
    iy = column - ix * patch.ny
    return window[0] <= ix + patch.left < window[2] and window[1] <= iy + patch.near < window[3]


@allocating_kernel(nogil=True)
def _swept(
    column_start, cell_column, storey, list_cell, list_start, blocker,
    patch, old, whole, first, inner, window, guarded,
):  # fmt: skip
    """Both passes over the cells of ``patch``; those outside of ``inner`` know what they knew before.

    ``first`` (columns,) is the first of a column's cells before, ``guarded`` is ``inner`` without the sides
    beyond which there is nothing. Returns, for each side, whether cells beyond ``inner`` there knew lists
    of the ``window`` that has been found anew; and where none did, what each cell knows after each turn
    (4, n, 2) float64, of which list that is (4, n) int32, see `Renewed.source`, and the choices (n,) uint8.
    """
    cells = storey.shape[0]
    nearest, source = np.full((cells, 2), np.inf), np.full(cells, -1, np.int32)
    squared, choice, fixed = np.full(cells, np.inf), np.zeros(cells, np.uint8), np.empty(cells, np.bool_)
    known, known_source = np.full((4, cells, 2), np.inf), np.full((4, cells), -1, np.int32)
    disturbed = np.zeros(4, np.bool_)
    hops = np.empty((64, 2), np.int64)
    listed = _lists_by_cell(list_cell, cells)
    for c in range(cells):
        own = listed[c]
        column = cell_column[c]
        fixed[c] = not _inside(patch, column, inner)
        if fixed[c]:
            before = first[column] + c - column_start[column]
            choice[c] = old.choice[before]
            there = _of_whole(patch, whole, column)
            for turn in range(4):
                x, y, origin, at, hops = _recalled(old, before, there, turn, whole, hops)
                known[turn, c, 0], known[turn, c, 1] = x, y
                known_source[turn, c] = _named(old, origin, at, column_start, listed, patch, whole)
                if origin >= 0 and _inside(whole, at, window):
                    _mark(disturbed, patch, column, guarded, 0)
        elif own >= 0:
            mx, my = middle_of(patch, column)
            x, y = nearest_in_list(blocker, list_start[own], list_start[own + 1], mx, my)
            nearest[c, 0], nearest[c, 1], squared[c], source[c] = x, y, x * x + y * y, own
    if not disturbed.any():
        for turn in range(2):
            sweep(
                turn, column_start, cell_column, storey, nearest, squared, source, choice,
                patch.side, patch.nx, patch.ny, fixed, known, known_source,
            )  # fmt: skip
    return disturbed, known, known_source, choice


@allocating_kernel
def _lists_by_cell(list_cell, cells):
    """(n,) int32: the list of each cell, or -1."""
    listed = np.full(cells, -1, np.int32)
    for own in range(list_cell.shape[0]):
        listed[list_cell[own]] = own
    return listed


@allocating_kernel(nogil=True)
def _differences(
    was_start, was_list, was_known, was_source, start, list_cell, known, source,
    patch, inner, window, guarded,
):  # fmt: skip
    """Where the cells of ``patch`` know other things than they did, after a change within ``window``: for
    each side whether the change goes on beyond ``inner`` there, and the least window that holds that change
    and all columns in which something else is known in the end."""
    disturbed, box = np.zeros(4, np.bool_), window.copy()
    listed = _lists_by_cell(list_cell, known.shape[1])
    column_of_list = np.empty(was_list.shape[0], np.int64)
    at = 0
    for own in range(was_list.shape[0]):
        while was_start[at + 1] <= was_list[own]:
            at += 1
        column_of_list[own] = at
    for column in range(start.shape[0] - 1):
        if not _inside(patch, column, inner):
            continue
        cells = start[column + 1] - start[column]
        same = cells == was_start[column + 1] - was_start[column]
        steady = same  # after every turn
        for k in range(cells if same else 0):
            a, b = was_start[column] + k, start[column] + k
            for turn in range(4):
                same = (
                    was_known[turn, a, 0] == known[turn, b, 0] and was_known[turn, a, 1] == known[turn, b, 1]
                )
                own = np.int64(was_source[turn, a])
                if own >= 0:
                    at = column_of_list[own]
                    same &= not _inside(patch, at, window)
                    own = listed[start[at] + was_list[own] - was_start[at]] if same else own
                same &= own == source[turn, b]
                steady &= same
            if not same:
                break
        if not steady and _at_edge(patch, column, guarded):
            _mark(disturbed, patch, column, guarded, 1)
        if not same:
            ix = column // patch.ny
            iy = column - ix * patch.ny + patch.near
            ix += patch.left
            box[0], box[1] = min(box[0], ix), min(box[1], iy)
            box[2], box[3] = max(box[2], ix + 1), max(box[3], iy + 1)
    return disturbed, box


@kernel(forceinline=True)
def _of_whole(patch, whole, column):
    """The column of the ``whole`` that a column of ``patch`` is, int64."""
    ix = np.int64(column) // patch.ny
    return (ix + patch.left) * whole.ny + column - ix * patch.ny + patch.near


@kernel
def _named(old, origin, column, column_start, listed, patch, whole):
    """A list of the whole before, of a cell of ``column``, as `Renewed.source` has it; right where its column
    is not changed."""
    if origin < 0:
        return -1
    ix = column // whole.ny - patch.left
    iy = column - column // whole.ny * whole.ny - patch.near
    if not (0 <= ix < patch.nx and 0 <= iy < patch.ny):
        return -2 - origin
    c = column_start[ix * patch.ny + iy] + old.list_cell[origin] - old.column_start[column]
    return listed[c] if c < listed.shape[0] else -1


@kernel(forceinline=True)
def _at_edge(patch, column, inner):
    ix = column // patch.ny
    iy = column - ix * patch.ny + patch.near
    ix += patch.left
    return ix == inner[0] or ix == inner[2] - 1 or iy == inner[1] or iy == inner[3] - 1


@kernel
def _mark(disturbed, patch, column, inner, within):
    """Mark the sides of ``inner`` that a column lies beyond, or within along the edge."""
    ix = column // patch.ny
    iy = column - ix * patch.ny + patch.near
    ix += patch.left
    if ix < inner[0] + within:
        disturbed[0] = True
    if iy < inner[1] + within:
        disturbed[1] = True
    if ix >= inner[2] - within:
        disturbed[2] = True
    if iy >= inner[3] - within:
        disturbed[3] = True
