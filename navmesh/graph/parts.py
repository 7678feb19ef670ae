"""The parts of a graph that one body radius leaves: nodes that can be walked to from each other, and in which
tiles of the grid each part has a place for the body."""

import numpy as np

from surefoot.kernels import allocating_kernel

__all__ = ["TILE", "leaps_by_part", "parts_of_nodes", "parts_of_tiles"]

TILE = 16
"""Columns a side of the tiles by which far places are looked for."""


@allocating_kernel
def parts_of_nodes(start, target):
    """The part of each node over the doors in CSR form: (m,) int32, numbered by their first nodes."""
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
                if part[other] < 0:
                    part[other] = parts
                    stack[size] = other
                    size += 1
        parts += 1
    return part


@allocating_kernel
def parts_of_tiles(net, part, radius):
    """Which parts have a cell with ``radius`` clear in each tile of `TILE` x `TILE` columns, or beside it.

    In CSR form: start (t + 1,) int32 and parts (p,) int32; tile tx * tiles_y + ty.
    """
    across, along = (net.nx + TILE - 1) // TILE, (net.ny + TILE - 1) // TILE
    start = np.zeros(across * along + 1, np.int32)
    found = np.empty(256, np.int32)
    count = 0
    for tx in range(across):
        for ty in range(along):
            first = count
            for ix in range(max(tx * TILE - 1, 0), min((tx + 1) * TILE + 1, net.nx)):
                low = net.column_start[ix * net.ny + max(ty * TILE - 1, 0)]
                high = net.column_start[ix * net.ny + min((ty + 1) * TILE + 1, net.ny)]
                for k in range(low, high):
                    node = net.label[k]
                    if node < 0 or net.clearance[k] < radius:
                        continue
                    known = False
                    for i in range(first, count):
                        known |= found[i] == part[node]
                    if not known:
                        if count == found.size:
                            found = np.concatenate((found, np.empty_like(found)))
                        found[count] = part[node]
                        count += 1
            start[tx * along + ty + 1] = count
    return start, found[:count].copy()


def leaps_by_part(part: np.ndarray, from_node: np.ndarray, to_node: np.ndarray) -> tuple[np.ndarray, ...]:
    """The parts that leaps lead to, grouped by the part that they start in: start (p + 1,), target (l,)."""
    count = int(part.max(initial=-1)) + 1
    source = part[from_node]
    order = np.argsort(source, kind="stable")
    start = np.searchsorted(source[order], np.arange(count + 1)).astype(np.int32)
    return start, part[to_node][order].astype(np.int32)
