"""The surface after a change, from that before it."""

from dataclasses import replace
from typing import Any

import numpy as np

from navmesh.level.raster import Patch
from navmesh.surface.build import Cells, Grid, Window, surface_of, whole_patch
from navmesh.surface.clearance import settle_window
from navmesh.surface.clearance_changes import renew_clearance
from navmesh.surface.floor_store import renew_floors
from navmesh.surface.splicing import copy_run, renumber_run, runs_of, splice
from navmesh.surface.surface import Surface
from navmesh.surface.windows import cells_within
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["cells_in", "cells_of_surface", "inside_of", "moved_cells", "renew_surface"]


def cells_of_surface(surface: Surface) -> Cells:
    """The cells that a surface is made of."""
    return Cells(
        surface.column_start, surface.cell_column, surface.storey, surface.blocker_start, surface.blocker,
        surface.floor,
    )  # fmt: skip


def renew_surface(
    old: Surface, fresh: Cells, window: Window, around: Patch, grid: Grid, most: float
) -> tuple[Surface, Window | None]:
    """The surface with the columns of ``window`` as in ``fresh``, the cells of the patch ``around``; those
    just outside of the window are alike in both.

    Returns it, and a window outside of which no cell is other than before, nor its clearance;
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
        linked.column_start, linked.cell_column, linked.storey, linked.blocker_start, linked.blocker, floor
    )
    new = renew_clearance(before, old.field, fresh, window, around, whole, most)
    if new is None:
        return surface_of(cells, grid), None
    left, near, right, far = new.window
    patch = Patch(whole.side, left, near, right - left, far - near)
    runs, count = runs_of(old.column_start, new.cells.column_start, new.window, patch, whole.ny)
    clearance, source, choice = np.empty(count), np.empty(count, np.int32), np.empty(count, np.uint8)
    _splice_values(
        old.column_start, old.cell_column, old.clearance, old.source, old.choice,
        new.cells.column_start, new.cells.cell_column, new.nearest, new.source, new.choice,
        runs, cells.column_start, patch, whole.ny, clearance, source, choice,
    )  # fmt: skip
    surface = Surface(
        origin=grid.origin, resolution=grid.resolution, shape=grid.shape,
        column_start=cells.column_start, cell_column=cells.cell_column, floor=floor, storey=cells.storey,
        clearance=clearance, choice=choice, kept_nearest=np.empty((0, 2)), source=source,
        blocker_start=cells.blocker_start, blocker=cells.blocker,
    )  # fmt: skip
    settle_window(surface.field, surface.column_start, np.array(new.window))
    return surface, new.window


def cells_in(surface: Surface, window: Window) -> tuple[Any, np.ndarray]:
    """The cells of the columns of ``window`` by themselves as a `FIELD`, links that lead out of it being cut,
    without what measuring distances takes; and the number of each of them in the whole (n,) int32."""
    start, column, storey, where = cells_within(
        surface.column_start, surface.storey, np.array(window), surface.shape[1]
    )
    shape, clearance = (window[2] - window[0], window[3] - window[1]), surface.clearance[where]
    part = replace(
        surface, shape=shape, column_start=start, cell_column=column, storey=storey, clearance=clearance
    )
    return part.field, where


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
    old_start, old_column, old_clearance, old_source, old_choice,
    new_start, new_column, new_nearest, new_source, new_choice,
    runs, start, patch, ny, clearance, source, choice,
):  # fmt: skip
    """Fill in clearance, source and choice of the whole."""
    for row in range(runs.shape[0]):
        first, size, at = runs[row, 1], runs[row, 2], runs[row, 3]
        if runs[row, 0] == 0:
            copy_run(old_clearance, first, size, clearance, at)
            copy_run(old_choice, first, size, choice, at)
            renumber_run(old_source, 1, first, size, at, old_column, old_start, start, source)
            continue
        for k in range(size):
            c = first + k
            x, y = new_nearest[c, 0], new_nearest[c, 1]
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
