"""The parts of a graph that one body radius leaves: nodes that can be walked to from each other, and the
tiles of the grid in which each part has a place for the body."""

from typing import Any, NamedTuple

import numpy as np

from navmesh.graph.snapping import CANDIDATES, candidate
from navmesh.surface.clearance_field import slope_at
from navmesh.surface.floor_store import height_of
from navmesh.surface.surface import Surface
from surefoot.kernels import allocating_kernel

__all__ = [
    "BLOCK", "TILE", "KeptTiles", "Tiles", "parts_in_tiles", "parts_of_nodes", "parts_of_tiles",
]  # fmt: skip

TILE = 16
"""Columns a side of the tiles by which far places are looked for."""
BLOCK = 2
"""Columns a side of the blocks of a tile, of which a bit each says whether a part has a place there."""


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


class Tiles(NamedTuple):
    """In which parts a body can be in each tile of `TILE` x `TILE` columns, and where there."""

    start: np.ndarray
    """(t + 1,) int32: the first of each tile tx * tiles_y + ty."""
    part: np.ndarray
    """(p,) int32."""
    span: np.ndarray
    """(p, 2) float64 [m]: the least and the greatest height of the floor there."""
    block: np.ndarray
    """(p,) int64: in which blocks; bit 8 bx + by is that of columns from (`BLOCK` bx, `BLOCK` by) on."""


class KeptTiles(NamedTuple):
    """What is known of some tiles."""

    kept: np.ndarray
    """(t,) bool: of which."""
    tiles: Tiles
    """Read where kept."""


def parts_of_tiles(net: Any, part: np.ndarray, radius: float, known: KeptTiles | None = None) -> Tiles:
    """In which parts a body of ``radius`` can be in each tile. What is ``known`` is not worked out."""
    if known is None:
        none = np.zeros(-(-net.nx // TILE) * -(-net.ny // TILE), np.bool_)
        nothing = np.empty(0, np.int32)
        known = KeptTiles(none, Tiles(nothing, nothing, np.empty((0, 2)), np.empty(0, np.int64)))
    return Tiles(*_parts_of_tiles(net, part, radius, known.kept, known.tiles))


@allocating_kernel(error_model="numpy", nogil=True)
def _parts_of_tiles(net, part, radius, kept, known):
    across, along = (net.nx + TILE - 1) // TILE, (net.ny + TILE - 1) // TILE
    least, half = radius - 0.7072 * net.cell, 0.5 * net.cell
    start = np.zeros(across * along + 1, np.int32)
    found = np.empty(256, np.int32)
    span = np.empty((256, 2))
    block = np.empty(256, np.int64)
    count = 0
    for tx in range(across):
        for ty in range(along):
            first = last = count
            tile = tx * along + ty
            if kept[tile]:
                for at in range(known.start[tile], known.start[tile + 1]):
                    if count == found.size:
                        found = np.concatenate((found, np.empty_like(found)))
                        span = np.concatenate((span, np.empty_like(span)))
                        block = np.concatenate((block, np.empty_like(block)))
                    found[count], block[count] = known.part[at], known.block[at]
                    span[count, 0], span[count, 1] = known.span[at, 0], known.span[at, 1]
                    count += 1
                start[tile + 1] = count
                continue
            for column in range(TILE * TILE):
                ix, iy = tx * TILE + column // TILE, ty * TILE + column % TILE
                if ix >= net.nx or iy >= net.ny:
                    continue
                bit = np.int64(1) << (TILE // BLOCK * (column // TILE // BLOCK) + column % TILE // BLOCK)
                for k in range(net.column_start[ix * net.ny + iy], net.column_start[ix * net.ny + iy + 1]):
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
                                block = np.concatenate((block, np.empty_like(block)))
                            found[at], span[at, 0], span[at, 1], block[at] = part[node], bottom, top, bit
                            count += 1
                        else:
                            span[at, 0], span[at, 1] = min(span[at, 0], bottom), max(span[at, 1], top)
                            block[at] |= bit
                        last = at
            start[tile + 1] = count
    return start, found[:count].copy(), span[:count].copy(), block[:count].copy()


def parts_in_tiles(tiles: Tiles, surface: Surface, cells: np.ndarray, part: int) -> Tiles:
    """``tiles`` with one ``part`` more, which has a place in each of these ``cells`` (k,)."""
    ix, iy = np.divmod(surface.columns(cells), surface.shape[1])
    more = ix // TILE * ((surface.shape[1] + TILE - 1) // TILE) + iy // TILE
    bit = np.int64(1) << (TILE // BLOCK * (ix % TILE // BLOCK) + iy % TILE // BLOCK)
    rise = 0.5 * surface.resolution * np.abs(surface.gradients(cells)).sum(axis=1)
    height = surface.heights(cells)
    high = np.column_stack([height - rise, height + rise])
    count = len(tiles.start) - 1
    tile = np.concatenate([np.repeat(np.arange(count), np.diff(tiles.start)), more])
    part_of = np.concatenate([tiles.part, np.full(len(more), part)])
    span, block = np.concatenate([tiles.span, high]), np.concatenate([tiles.block, bit])
    order = np.lexsort((part_of, tile))
    tile, part_of, span, block = tile[order], part_of[order], span[order], block[order]
    fresh = np.flatnonzero(np.append(True, (np.diff(tile) != 0) | (np.diff(part_of) != 0))[: len(tile)])
    if len(fresh):
        low, top = np.minimum.reduceat(span[:, 0], fresh), np.maximum.reduceat(span[:, 1], fresh)
        span, block = np.column_stack([low, top]), np.bitwise_or.reduceat(block, fresh)
    start = np.searchsorted(tile[fresh], np.arange(count + 1)).astype(np.int32)
    return Tiles(start, part_of[fresh].astype(np.int32), np.ascontiguousarray(span), block)
