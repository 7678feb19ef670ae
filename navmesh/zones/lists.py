"""What the cells near zones know of them: the lists of blockers with outlines in them."""

from typing import NamedTuple

import numpy as np

from navmesh.surface.surface import Surface
from surefoot.kernels import allocating_kernel

__all__ = ["Lists", "lists_with", "sides_of"]


class Lists(NamedTuple):
    """The lists of blockers of a surface with those of the cells that know zones."""

    source: np.ndarray
    """(n,) int32, as of `Surface`; those from l on are lists of no single cell."""
    list_start: np.ndarray
    """(l + 1 + lists,) int32."""
    blocker: np.ndarray
    """(k, 4) float64 [m]: those of outlines are nan, as if the zones were open."""
    row: np.ndarray
    """(s,) int32: the rows of ``blocker`` that are sides of outlines."""
    side: np.ndarray
    """(s,) int32: which sides, counted over all zones."""


def sides_of(outlines: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """The sides (s, 4) [m] of all ``outlines`` (k, 3), x, y of both ends; those of outline i are
    start[i]:start[i + 1]."""
    sides = []
    for outline in outlines:
        flat = outline[:, :2]
        ends = flat[1:] if len(flat) == 2 else np.roll(flat, -1, axis=0)
        sides.append(np.concatenate([flat[: len(ends)], ends], axis=1))
    start = np.concatenate([[0], np.cumsum([len(each) for each in sides])]).astype(np.int32)
    return np.concatenate(sides), start


def lists_with(surface: Surface, cell: np.ndarray, zone: np.ndarray, side_start: np.ndarray) -> Lists:
    """Lists for cells that know zones: that which each had, and the sides of its zones. ``cell`` and ``zone``
    (e,) int32 say which know which, by rising cell and zone."""
    known, first, count = np.unique(cell, return_index=True, return_counts=True)
    width = int(count.max(initial=0))
    source = surface.source[known]
    key = np.full((len(known), 2 + width), -1, np.int32)
    has = source >= 0
    key[has, 0], key[has, 1] = surface.list_start[source[has]], surface.list_start[source[has] + 1]
    for turn in range(width):
        more = count > turn
        key[more, 2 + turn] = zone[first[more] + turn]
    order = np.lexsort(key.T[::-1])
    fresh = np.ones(len(known), bool)
    fresh[1:] = (key[order[1:]] != key[order[:-1]]).any(axis=1)
    of_cell = np.empty(len(known), np.int64)
    of_cell[order] = np.cumsum(fresh) - 1
    end, rows, row, side = _written(key[order[fresh]], side_start, surface.blocker)
    all_source = surface.source.copy()
    all_source[known] = len(surface.list_cell) + of_cell
    return Lists(
        all_source, np.concatenate([surface.list_start, end + len(surface.blocker)]).astype(np.int32),
        np.concatenate([surface.blocker, rows]), row + np.int32(len(surface.blocker)), side,
    )  # fmt: skip


@allocating_kernel
def _written(key, side_start, blocker):
    """The lists of ``key`` (l, 2 + z): first and last of one of before, and zones. Returns the end of each,
    their rows, and which of these are sides, and of which number."""
    size = sides = 0
    for i in range(key.shape[0]):
        size += key[i, 1] - key[i, 0]
        for j in range(2, key.shape[1]):
            if key[i, j] >= 0:
                sides += side_start[key[i, j] + 1] - side_start[key[i, j]]
    size += sides
    end, rows = np.empty(key.shape[0], np.int64), np.full((size, 4), np.nan)
    row, side = np.empty(sides, np.int32), np.empty(sides, np.int32)
    at = found = 0
    for i in range(key.shape[0]):
        for k in range(key[i, 0], key[i, 1]):
            for c in range(4):
                rows[at, c] = blocker[k, c]
            at += 1
        for j in range(2, key.shape[1]):
            zone = key[i, j]
            for s in range(side_start[zone], side_start[zone + 1]) if zone >= 0 else range(0):
                row[found], side[found] = at, s
                found += 1
                at += 1
        end[i] = at
    return end, rows, row, side
