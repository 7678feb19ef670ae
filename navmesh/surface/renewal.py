"""The surface after a change, from that before it."""

from dataclasses import replace
from typing import Any

import numpy as np

from navmesh.level.raster import Patch
from navmesh.surface.build import Cells, Grid, Window, surface_of, whole_patch
from navmesh.surface.clearance import settle_window
from navmesh.surface.clearance_changes import renew_clearance
from navmesh.surface.columns import find_column, milestones
from navmesh.surface.floor_store import renew_floors
from navmesh.surface.splicing import copy_run, first_list, moved_list, renumber_run, runs_of, splice
from navmesh.surface.surface import Surface
from navmesh.surface.windows import cells_within
from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "cells_in",
    "cells_of_surface",
    "inside_of",
    "moved_cells",
    "renew_surface",
    "within_of",
]


def cells_of_surface(surface: Surface) -> Cells:
    """The cells that a surface is made of."""
    return Cells(
        surface.column_start, surface.storey, surface.list_cell, surface.list_start, surface.blocker,
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
    linked, moves = splice(before, fresh, window, around, whole.ny)
    floor = renew_floors(
        old.floor, old.column_start, fresh.floor, fresh.column_start, linked.column_start, window, around,
        whole.ny,
    )  # fmt: skip
    cells = Cells(
        linked.column_start, linked.storey, linked.list_cell, linked.list_start, linked.blocker, floor
    )
    new = renew_clearance(before, old.field, fresh, window, around, whole, most)
    if new is None:
        return surface_of(cells, grid), None
    left, near, right, far = new.window
    patch = Patch(whole.side, left, near, right - left, far - near)
    runs, count = runs_of(old.column_start, new.cells.column_start, new.window, patch, whole.ny)
    clearance, source, choice = np.empty(count), np.empty(count, np.int32), np.empty(count, np.uint8)
    _splice_values(
        old.list_cell, old.clearance, old.source, old.choice, moves,
        new.nearest, new.source, new.choice, _lists_in_whole(new.cells.list_cell, cells.list_cell, runs),
        runs, clearance, source, choice,
    )  # fmt: skip
    surface = Surface(
        origin=grid.origin, resolution=grid.resolution, shape=grid.shape,
        column_start=cells.column_start, milestone=milestones(cells.column_start), floor=floor,
        storey=cells.storey, clearance=clearance, choice=choice, kept_nearest=np.empty((0, 2)), source=source,
        list_cell=cells.list_cell, list_start=cells.list_start, blocker=cells.blocker,
    )  # fmt: skip
    settle_window(surface.field, surface.column_start, np.array(new.window))
    return surface, new.changed


def cells_in(surface: Surface, window: Window) -> tuple[Any, np.ndarray]:
    """The cells of the columns of ``window`` by themselves as a `NET`, links that lead out of it being cut,
    without what measuring distances takes; and the number of each of them in the whole (n,) int32."""
    start, storey, where = cells_within(
        surface.column_start, surface.storey, np.array(window), surface.shape[1]
    )
    shape, clearance = (window[2] - window[0], window[3] - window[1]), surface.clearance[where]
    part = replace(
        surface, shape=shape, column_start=start, milestone=milestones(start), storey=storey,
        clearance=clearance,
    )  # fmt: skip
    return part.field, where


def within_of(column_start: np.ndarray, around: Window, window: Window) -> np.ndarray:
    """(n,) bool: which of the cells of ``around`` by themselves (`cells_in`) are in ``window``, inside of
    that."""
    within = np.zeros(column_start[-1], np.bool_)
    ny, near, far = around[3] - around[1], window[1] - around[1], window[3] - around[1]
    for ix in range(window[0] - around[0], window[2] - around[0]):
        within[column_start[ix * ny + near] : column_start[ix * ny + far]] = True
    return within


def moved_cells(cells: np.ndarray, before: Surface, surface: Surface, window: Window) -> np.ndarray:
    """The numbers on ``surface`` of ``cells`` (k,) of the surface ``before`` it, in columns that are alike in
    both, as all outside of ``window`` are: (k,) int32."""
    low, high = window[0] * surface.shape[1], window[2] * surface.shape[1]
    shift = int(surface.column_start[high]) - int(before.column_start[high])
    return _moved_all(
        cells, before.column_start, before.milestone, surface.column_start,
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


@allocating_kernel(nogil=True)
def _moved_all(cells, old_start, old_milestone, start, low, high, shift):
    moved = np.empty(cells.shape[0], np.int32)
    for k in range(cells.shape[0]):
        c = cells[k]
        if c < low:
            moved[k] = c
        elif c >= high:
            moved[k] = c + shift
        else:
            column = find_column(old_start, old_milestone, np.int64(c))
            moved[k] = start[column] + c - old_start[column]
    return moved


@allocating_kernel
def _lists_in_whole(part, whole, runs):
    """(l,) int32: the numbers in the ``whole`` of the lists of a ``part``, both by `list_cell`, whose cells
    are the new ``runs``."""
    number = np.empty(part.shape[0], np.int32)
    for row in range(1, runs.shape[0], 2):
        first, last = first_list(part, runs[row, 1]), first_list(part, runs[row, 1] + runs[row, 2])
        to = first_list(whole, runs[row, 3])
        for own in range(first, last):
            number[own] = to + own - first
    return number


@kernel(nogil=True)
def _splice_values(
    old_list_cell, old_clearance, old_source, old_choice, moves,
    new_nearest, new_source, new_choice, number, runs, clearance, source, choice,
):  # fmt: skip
    """Fill in clearance, source and choice of the whole; ``number`` are those of the new lists."""
    for row in range(runs.shape[0]):
        first, size, at = runs[row, 1], runs[row, 2], runs[row, 3]
        if runs[row, 0] == 0:
            copy_run(old_clearance, first, size, clearance, at)
            copy_run(old_choice, first, size, choice, at)
            low, high = first_list(old_list_cell, first), first_list(old_list_cell, first + size)
            shift = moved_list(moves, low) - low
            renumber_run(old_source, first, size, at, low, high, shift, moves, source)
            continue
        for k in range(size):
            c = first + k
            x, y = new_nearest[c, 0], new_nearest[c, 1]
            clearance[at + k] = np.sqrt(x * x + y * y)
            choice[at + k] = new_choice[c]
            own = np.int64(new_source[c])
            if own >= 0:
                source[at + k] = number[own]
            else:
                source[at + k] = moved_list(moves, -2 - own) if own < -1 else -1
