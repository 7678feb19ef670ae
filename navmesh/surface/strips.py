"""The cells of a whole level, found strip by strip: so triangles are put into the columns of a few strips at
a time, and threads can share the strips.

A strip is found with a margin on both sides, which is thrown away (`navmesh.surface.build.find_cells`). So
the cells are the same to the bit, whatever the strips.
"""

import math
from dataclasses import fields
from itertools import pairwise
from typing import Any

import numpy as np

from navmesh.level.terrain import Terrain
from navmesh.rules import WalkRules
from navmesh.surface.build import (
    Cells,
    Grid,
    check_floor,
    find_cells,
    found_cells,
    patch_around,
    reach_of,
)
from navmesh.surface.floor_store import SIDE, join_floors, pack_floors
from navmesh.surface.storeys import storeys_of
from navmesh.threads import in_threads
from surefoot.freed_memory import give_back

__all__ = ["all_cells"]

_COLUMNS = 1_000_000
"""So many columns has a strip, at most; what is found out about one takes 50 to 100 MB."""
_NARROWEST = 5
"""A strip is at least so many times as wide as a margin."""
_EACH = 2
"""Strips for each thread: one with much in it keeps nobody waiting for long."""
_WIDE = 16
"""Only where strips are so many times as wide as a margin are there several for a thread."""
_SPARE = 4  # columns that a margin has beside `reach_of`


def all_cells(terrain: Terrain, rules: WalkRules, grid: Grid, threads: int = 1) -> Cells:
    """The cells of ``terrain``, found by so many ``threads``. Raises `NavmeshError` when there is nothing to
    walk on."""
    margin = reach_of(rules) + _SPARE
    bounds = _bounds(grid, margin, threads)
    if len(bounds) == 2:
        return find_cells(terrain, rules, grid)
    _ = terrain.solid  # of the whole terrain, found before the threads ask for it

    def strip(first: int, last: int) -> Cells:
        return _strip(terrain, rules, grid, first, last, margin)

    cells = _joined(in_threads(strip, list(pairwise(bounds)), threads))
    check_floor(cells, terrain, rules)
    return cells


def _bounds(grid: Grid, margin: int, threads: int) -> list[int]:
    """Where the strips begin and end, along x: where blocks of columns do (`navmesh.surface.floor_store`)."""
    nx, ny = grid.shape
    rounds = min(_EACH, nx // (threads * _WIDE * margin)) if threads > 1 else 1
    rounds = max(rounds, math.ceil(nx * ny / (_COLUMNS * threads)))
    strips = max(1, min(rounds * threads, nx // (_NARROWEST * margin)))
    whole = SIDE // math.gcd(SIDE, ny)
    return [nx * strip // strips // whole * whole for strip in range(strips)] + [nx]


def _strip(terrain: Terrain, rules: WalkRules, grid: Grid, first: int, last: int, margin: int) -> Cells:
    """The cells of the columns from ``first`` up to, not including, ``last`` along x. Columns are those of
    the whole, cells are counted from the strip's first; `column_start` and `list_start` lack their ends."""
    nx, ny = grid.shape
    window = (max(first - margin, 0), 0, min(last + margin, nx), ny)
    patch = patch_around(grid, window)
    found = found_cells(terrain, rules, grid, window)
    start = found.column_start[:-1].reshape(patch.nx, patch.ny)
    begin, end = start[first - patch.left, 0], start[last - patch.left, 0]
    start = start[first - patch.left : last - patch.left, -patch.near : ny - patch.near] - begin
    lists = slice(*np.searchsorted(found.list_cell, (begin, end)))
    rows = found.list_start[lists.start], found.list_start[lists.stop]
    start = start.ravel()
    return Cells(
        start,
        storeys_of(found.column_start, found.cell_column, found.link)[begin:end].copy(),
        found.list_cell[lists] - begin,
        found.list_start[lists] - rows[0],
        found.blocker[rows[0] : rows[1]].copy(),
        pack_floors(
            np.append(start, np.int32(end - begin)), found.height[begin:end], found.gradient[begin:end]
        ),
    )


def _joined(strips: list[Cells]) -> Cells:
    """All cells, from those of the strips, which lose theirs."""
    parts = [{field.name: getattr(strip, field.name) for field in fields(Cells)} for strip in strips]
    del strips[:]
    count = np.cumsum([0, *(len(part["storey"]) for part in parts)])
    lists = np.cumsum([0, *(len(part["blocker"]) for part in parts)])
    for k, part in enumerate(parts):
        part["column_start"] += np.int32(count[k])
        part["list_cell"] += np.int32(count[k])
        part["list_start"] += np.int32(lists[k])
    end = {"column_start": count[-1], "list_start": lists[-1]}
    whole: dict[str, Any] = {"floor": join_floors([part.pop("floor") for part in parts])}
    for name in list(parts[0]):
        arrays = [part.pop(name) for part in parts]
        whole[name] = np.concatenate([*arrays, np.array([end[name]], np.int32)] if name in end else arrays)
        del arrays
        give_back()  # or all strips' memory stays until the end
    return Cells(**whole)
