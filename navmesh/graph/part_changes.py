"""Parts in tiles after a change: tiles near it are looked at again, the others carried over from before.

A part that is divided goes on as the one in which its widest disc is. Where its discs are that are in others
now, tiles are looked at again, too: most often what a change cuts off is small.
"""

from typing import TYPE_CHECKING

import numpy as np

from navmesh.graph.carrying import earlier_of
from navmesh.graph.kernel_arrays import net_of
from navmesh.graph.node_changes import boxes_of
from navmesh.graph.parts import TILE, KeptTiles, Tiles, parts_of_tiles
from surefoot.kernels import allocating_kernel, kernel

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["tiles_for"]

_SEEN = 3
"""Columns around a tile on which its parts depend: nodes of cells beside its own count."""


def tiles_for(graph: "NodeGraph", part: np.ndarray, radius: float) -> Tiles:
    """What `parts_of_tiles` gives for the ``part`` (m,) of each node for a body of ``radius`` [m]."""
    net, earlier = net_of(graph), earlier_of(graph, "parts", radius)
    if earlier is None:
        return parts_of_tiles(net, part, radius)
    part_before, before = earlier.known
    heir, strays = _heirs(part_before, part, earlier.changes.number)
    place = np.column_stack([graph.positions[strays, :2] - graph.surface.origin[:2], graph.radii[strays]])
    windows = np.array(earlier.changes.windows, np.int64).reshape(-1, 4)
    kept = np.ones([-(-columns // TILE) for columns in graph.surface.shape], np.bool_)
    _leave_near(kept, np.concatenate([windows, boxes_of(place, graph.surface.resolution)]))
    kept, now = kept.reshape(-1), heir[before.part]
    _leave_mixed(kept, before.start, now)
    return parts_of_tiles(net, part, radius, KeptTiles(kept, before._replace(part=now)))


@allocating_kernel(nogil=True)
def _heirs(part_before, part, number):
    """What each part of before is now, -1 where it is gone: (p,) int32; and the nodes that were in it and are
    in another part (k,) int32."""
    heir, strays, count = np.full(part_before.size, np.int32(-1)), np.empty(number.size, np.int32), 0
    for i in range(number.size):  # the widest first
        if number[i] >= 0:
            to = part[number[i]]
            if heir[part_before[i]] < 0:
                heir[part_before[i]] = to
            elif heir[part_before[i]] != to:
                strays[count] = number[i]
                count += 1
    return heir, strays[:count].copy()


@kernel
def _leave_near(kept, windows):
    """Do not keep tiles (tx, ty) that depend on columns of ``windows`` (w, 4)."""
    for w in range(windows.shape[0]):
        for tx in range(
            max(windows[w, 0] - _SEEN, 0) // TILE, min((windows[w, 2] + _SEEN) // TILE + 1, kept.shape[0])
        ):
            for ty in range(
                max(windows[w, 1] - _SEEN, 0) // TILE, min((windows[w, 3] + _SEEN) // TILE + 1, kept.shape[1])
            ):
                kept[tx, ty] = False


@kernel
def _leave_mixed(kept, start, now):
    """Do not keep tiles with parts that are gone, or have been joined to another of the tile."""
    for tile in range(kept.size):
        for at in range(start[tile], start[tile + 1]):
            if now[at] < 0:
                kept[tile] = False
            for other in range(start[tile], at):
                if now[other] == now[at]:
                    kept[tile] = False
