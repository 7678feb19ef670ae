"""The surface after a change, from that before it."""

import numpy as np

from navmesh.level.raster import Patch
from navmesh.surface.build import Cells, Grid, Window, surface_of, whole_patch
from navmesh.surface.clearance import settle_clearance
from navmesh.surface.clearance_changes import Renewed, renew_clearance
from navmesh.surface.floor_store import renew_floors
from navmesh.surface.ridges import Field
from navmesh.surface.splicing import columns_in, copy_run, links_within, renumber_run, runs_of, splice
from navmesh.surface.surface import Surface
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["cells_of_surface", "field_in", "inside_of", "links_in", "moved_cells", "renew_surface"]

_AROUND = 3
"""Columns around a cell whose lists of blockers are asked when its clearance is measured."""


def cells_of_surface(surface: Surface) -> Cells:
    """The cells that a surface is made of."""
    return Cells(
        surface.column_start, surface.cell_column, surface.link, surface.blocker_start, surface.blocker,
        surface.floor,
    )  # fmt: skip


def renew_surface(
    old: Surface, choice: np.ndarray, fresh: Cells, window: Window, around: Patch, grid: Grid, most: float
) -> tuple[Surface, np.ndarray, Window | None]:
    """The surface with the columns of ``window`` as in ``fresh``, the cells of the patch ``around``; those
    just outside of the window are alike in both. ``choice`` is that of `navmesh.surface.build.surface_of`.

    Returns it, its choices, and a window outside of which no cell is other than before, nor its clearance;
    None where that is more than about the share ``most`` of the grid.
    """
    whole = whole_patch(grid)
    before = cells_of_surface(old)
    linked = splice(before, fresh, window, around, whole.ny)
    floor = renew_floors(
        old.floor, old.column_start, fresh.floor, fresh.column_start, linked.column_start, window, around,
        whole.ny,
    )  # fmt: skip
    cells = Cells(
        linked.column_start, linked.cell_column, linked.link, linked.blocker_start, linked.blocker, floor
    )
    new = renew_clearance(before, choice, fresh, window, around, whole, most)
    if new is None:
        return *surface_of(cells, grid), None
    left, near, right, far = new.window
    patch = Patch(whole.side, left, near, right - left, far - near)
    runs, count = runs_of(old.column_start, new.cells.column_start, new.window, patch, whole.ny)
    nearest, clearance = np.empty((count, 2)), np.empty(count)
    source, chosen = np.empty(count, np.int32), np.empty(count, np.uint8)
    _splice_values(
        old.column_start, old.cell_column, old.nearest.reshape(-1), old.clearance, old.source, choice,
        new.cells.column_start, new.cells.cell_column, new.nearest, new.source, new.choice,
        runs, cells.column_start, patch, whole.ny, nearest.reshape(-1), clearance, source, chosen,
    )  # fmt: skip
    surface = Surface(
        origin=grid.origin, resolution=grid.resolution, shape=grid.shape,
        column_start=cells.column_start, cell_column=cells.cell_column, floor=floor, link=cells.link,
        clearance=clearance, nearest=nearest, source=source, blocker_start=cells.blocker_start,
        blocker=cells.blocker,
    )  # fmt: skip
    _settle(surface, new)
    return surface, chosen, new.window


def _settle(surface: Surface, new: Renewed) -> None:
    """`settle_clearance` in the window that was renewed."""
    nx, ny = surface.shape
    left, near, right, far = new.window
    wide = (
        max(left - _AROUND, 0), max(near - _AROUND, 0), min(right + _AROUND, nx), min(far + _AROUND, ny)
    )  # fmt: skip
    field, where = field_in(surface, wide)
    inside = inside_of(field.cell_column, new.window, ny)
    settle_clearance(field, inside, 0, len(inside))
    surface.clearance[where[inside]] = field.clearance[inside]
    surface.nearest[where[inside]] = field.nearest[inside]


def field_in(surface: Surface, window: Window) -> tuple[Field, np.ndarray]:
    """The `Field` of the columns of ``window``, links that lead out of it being -1, and the number of each of
    its cells in the whole (n,) int32."""
    ny = surface.shape[1]
    link, where = links_in(surface, window)
    owner, nearest, clearance, source = _taken(
        where, surface.cell_column, surface.nearest, surface.clearance, surface.source
    )
    lists = surface.blocker_start, surface.blocker  # of the whole, as the sources are
    return Field(surface.resolution, ny, owner, link, nearest, clearance, source, *lists), where


def moved_cells(cells: np.ndarray, before: Surface, surface: Surface, window: Window) -> np.ndarray:
    """The numbers on ``surface`` of ``cells`` (k,) of the surface ``before`` it, in columns that are alike in
    both, as all outside of ``window`` are: (k,) int32."""
    low, high = window[0] * surface.shape[1], window[2] * surface.shape[1]
    shift = int(surface.column_start[high]) - int(before.column_start[high])
    return _moved_all(
        cells, before.cell_column, before.column_start, surface.column_start,
        int(before.column_start[low]), int(before.column_start[high]), shift,
    )  # fmt: skip


def inside_of(columns: np.ndarray, window: Window, ny: int) -> np.ndarray:
    """(k,) bool: which of the grid's ``columns`` (k,) are in ``window``."""
    return _inside_of(columns, np.array(window), ny)


@allocating_kernel
def _inside_of(columns, window, ny):
    inside = np.empty(columns.shape[0], np.bool_)
    for k in range(columns.shape[0]):
        ix = columns[k] // ny
        iy = columns[k] - ix * ny
        inside[k] = window[0] <= ix < window[2] and window[1] <= iy < window[3]
    return inside


def links_in(surface: Surface, window: Window) -> tuple[np.ndarray, np.ndarray]:
    """The links (n, 4) int32 among the cells of ``window``, and the numbers (n,) int32 of these."""
    ny = surface.shape[1]
    return _links_in(surface.column_start, surface.link, np.array(window), ny)


@allocating_kernel
def _links_in(column_start, link, window, ny):
    start, first = columns_in(column_start, window, ny)
    found, where = np.empty((start[-1], 4), np.int32), np.empty(start[-1], np.int32)
    links_within(link, start, first, window, found)
    for c in range(first.shape[0]):
        for k in range(start[c], start[c + 1]):
            where[k] = first[c] + k - start[c]
    return found, where


@allocating_kernel
def _taken(where, cell_column, nearest, clearance, source):
    count = where.shape[0]
    owner, to_clearance = np.empty(count, np.int32), np.empty(count)
    to_nearest, to_source = np.empty((count, 2)), np.empty(count, np.int32)
    for k in range(count):
        c = where[k]
        owner[k], to_clearance[k] = cell_column[c], clearance[c]
        to_nearest[k, 0], to_nearest[k, 1] = nearest[c, 0], nearest[c, 1]
        to_source[k] = source[c]
    return owner, to_nearest, to_clearance, to_source


@kernel(inline="always")
def _moved(cell, column, old_start, start):
    """The number of a cell of an unchanged column in the whole."""
    return start[column] + cell - old_start[column]


@allocating_kernel
def _moved_all(cells, old_column, old_start, start, low, high, shift):
    moved = np.empty(cells.shape[0], np.int32)
    for k in range(cells.shape[0]):
        c = cells[k]
        if c < low:
            moved[k] = c
        elif c >= high:
            moved[k] = c + shift
        else:
            moved[k] = _moved(c, old_column[c], old_start, start)
    return moved


@kernel
def _splice_values(
    old_start, old_column, old_nearest, old_clearance, old_source, old_choice,
    new_start, new_column, new_nearest, new_source, new_choice,
    runs, start, patch, ny, nearest, clearance, source, choice,
):  # fmt: skip
    """Fill in nearest, flat, clearance, source and choice of the whole."""
    for row in range(runs.shape[0]):
        first, size, at = runs[row, 1], runs[row, 2], runs[row, 3]
        if runs[row, 0] == 0:
            copy_run(old_nearest, 2 * first, 2 * size, nearest, 2 * at)
            copy_run(old_clearance, first, size, clearance, at)
            copy_run(old_choice, first, size, choice, at)
            renumber_run(old_source, 1, first, size, at, old_column, old_start, start, source)
            continue
        for k in range(size):
            c = first + k
            x, y = new_nearest[c, 0], new_nearest[c, 1]
            nearest[2 * (at + k)], nearest[2 * (at + k) + 1] = x, y
            clearance[at + k] = np.sqrt(x * x + y * y)
            choice[at + k] = new_choice[c]
            s = new_source[c]
            if s >= 0:
                inside = new_column[s]
                ix = inside // patch.ny
                column = (ix + patch.left) * ny + inside - ix * patch.ny + patch.near
                source[at + k] = start[column] + s - new_start[inside]
            else:
                source[at + k] = _moved(-2 - s, old_column[-2 - s], old_start, start) if s < -1 else -1
