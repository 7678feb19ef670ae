"""The parts of a graph that one body radius leaves: nodes that can be walked to from each other, and the
tiles of the grid in which each part has a place for the body."""

from typing import Any, NamedTuple

import numpy as np

from navmesh.graph.snapping import CANDIDATES, candidate
from navmesh.surface.clearance_field import slope_at
from navmesh.surface.floor_store import height_of
from navmesh.surface.surface import Surface
from surefoot.kernels import allocating_kernel

__all__ = ["TILE", "KeptTiles", "leaps_by_part", "parts_in_tiles", "parts_of_nodes", "parts_of_tiles"]

TILE = 16
"""Columns a side of the tiles by which far places are looked for."""


@allocating_kernel(nogil=True)
def parts_of_nodes(start, target):
    """The part of each node over the doors in CSR form, those to -1 left out: (m,) int32, numbered by their
    first nodes."""
    count = start.size - 1
    part = np.full(count, -1, np.int32)
    stack = np.empty(count, np.int32)
    parts = 0
    for first in range(count):
        if part[first] >= 0:
            continue
        part[first] = parts
        stack[0] = first
        size = 1
        while size > 0:
            size -= 1
            node = stack[size]
            for door in range(start[node], start[node + 1]):
                other = target[door]
                if other >= 0 and part[other] < 0:
                    part[other] = parts
                    stack[size] = other
                    size += 1
        parts += 1
    return part


class KeptTiles(NamedTuple):
    """What is known of some tiles."""

    kept: np.ndarray
    """(t,) bool: of which."""
    start: np.ndarray
    part: np.ndarray
    span: np.ndarray
    """As `parts_of_tiles` gives them; read where kept."""


def parts_of_tiles(
    net: Any, part: np.ndarray, radius: float, known: KeptTiles | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """In which parts a body of ``radius`` can be in each tile of `TILE` x `TILE` columns, and how high.

    In CSR form: start (t + 1,) int32; parts (p,) int32, and the least and the greatest height of the floor
    there (p, 2) float64 [m]; tile tx * tiles_y + ty. What is ``known`` of tiles is not worked out.
    """
    if known is None:
        none = np.zeros(-(-net.nx // TILE) * -(-net.ny // TILE), np.bool_)
        known = KeptTiles(none, np.empty(0, np.int32), np.empty(0, np.int32), np.empty((0, 2)))
    return _parts_of_tiles(net, part, radius, known)


@allocating_kernel(error_model="numpy", nogil=True)
def _parts_of_tiles(net, part, radius, known):
    across, along = (net.nx + TILE - 1) // TILE, (net.ny + TILE - 1) // TILE
    least, half = radius - 0.7072 * net.cell, 0.5 * net.cell
    start = np.zeros(across * along + 1, np.int32)
    found = np.empty(256, np.int32)
    span = np.empty((256, 2))
    count = 0
    for tx in range(across):
        for ty in range(along):
            first = last = count
            tile = tx * along + ty
            if known.kept[tile]:
                for at in range(known.start[tile], known.start[tile + 1]):
                    if count == found.size:
                        found = np.concatenate((found, np.empty_like(found)))
                        span = np.concatenate((span, np.empty_like(span)))
                    found[count] = known.part[at]
                    span[count, 0], span[count, 1] = known.span[at, 0], known.span[at, 1]
                    count += 1
                start[tile + 1] = count
                continue
            for ix in range(tx * TILE, min((tx + 1) * TILE, net.nx)):
                low = net.column_start[ix * net.ny + ty * TILE]
                high = net.column_start[ix * net.ny + min((ty + 1) * TILE, net.ny)]
                for k in range(low, high):
                    if net.clearance[k] < least:
                        continue
                    slope_x, slope_y = slope_at(net, k)
                    rise = half * (abs(slope_x) + abs(slope_y))
                    bottom, top = height_of(net, k) - rise, height_of(net, k) + rise
                    for i in range(1 if net.clearance[k] >= radius else CANDIDATES):
                        node = candidate(net, k, radius, i)
                        if node < 0:
                            continue
                        at = last if count > first and found[last] == part[node] else first
                        while at < count and found[at] != part[node]:
                            at += 1
                        if at == count:
                            if count == found.size:
                                found = np.concatenate((found, np.empty_like(found)))
                                span = np.concatenate((span, np.empty_like(span)))
                            found[at], span[at, 0], span[at, 1] = part[node], bottom, top
                            count += 1
                        else:
                            span[at, 0], span[at, 1] = min(span[at, 0], bottom), max(span[at, 1], top)
                        last = at
            start[tile + 1] = count
    return start, found[:count].copy(), span[:count].copy()


def leaps_by_part(part: np.ndarray, parts: int) -> tuple[np.ndarray, np.ndarray]:
    """The leaps from each of so many ``parts``, of which ``part`` (l,) are those that they start in: start
    (p + 1,), leap (l,) int32."""
    order = np.argsort(part, kind="stable")
    start = np.searchsorted(part[order], np.arange(parts + 1)).astype(np.int32)
    return start, order.astype(np.int32)


def parts_in_tiles(
    tiles: tuple[np.ndarray, np.ndarray, np.ndarray], surface: Surface, cells: np.ndarray, part: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What `parts_of_tiles` gave with one ``part`` more, in the tiles of these ``cells`` (k,)."""
    start, parts, spans = tiles
    ix, iy = np.divmod(surface.columns(cells), surface.shape[1])
    more = ix // TILE * ((surface.shape[1] + TILE - 1) // TILE) + iy // TILE
    rise = 0.5 * surface.resolution * np.abs(surface.gradients(cells)).sum(axis=1)
    height = surface.heights(cells)
    high = np.column_stack([height - rise, height + rise])
    tile = np.concatenate([np.repeat(np.arange(len(start) - 1), np.diff(start)), more])
    part_of = np.concatenate([parts, np.full(len(more), part)])
    span = np.concatenate([spans, high])
    order = np.lexsort((part_of, tile))
    tile, part_of, span = tile[order], part_of[order], span[order]
    fresh = np.flatnonzero(np.append(True, (np.diff(tile) != 0) | (np.diff(part_of) != 0))[: len(tile)])
    if len(fresh):
        low, top = np.minimum.reduceat(span[:, 0], fresh), np.maximum.reduceat(span[:, 1], fresh)
        span = np.column_stack([low, top])
    start = np.searchsorted(tile[fresh], np.arange(len(start))).astype(np.int32)
    return start, part_of[fresh].astype(np.int32), np.ascontiguousarray(span)
