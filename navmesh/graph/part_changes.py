"""Parts in tiles after a change: tiles near it are looked at again, the others carried over from before."""

from typing import TYPE_CHECKING

import numpy as np

from navmesh.graph.carrying import earlier_of
from navmesh.graph.kernel_arrays import net_of
from navmesh.graph.parts import TILE, KeptTiles, parts_of_tiles
from surefoot.kernels import allocating_kernel

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["tiles_for"]

_SEEN = 3
"""Columns around a tile on which its parts depend: nodes of cells beside its own count."""


def tiles_for(graph: "NodeGraph", part: np.ndarray, radius: float) -> tuple[np.ndarray, ...]:
    """What `parts_of_tiles` gives for the ``part`` (m,) of each node for a body of ``radius`` [m]."""
    net, earlier = net_of(graph), earlier_of(graph, "parts", radius)
    if earlier is None:
        return parts_of_tiles(net, part, radius)
    part_before, start, parts, span = earlier.known
    now = _parts_now(part_before, part, earlier.changes.number)[parts]
    kept = np.ones([-(-columns // TILE) for columns in graph.surface.shape], np.bool_)
    for left, near, right, far in earlier.changes.windows:
        across = slice(max(left - _SEEN, 0) // TILE, (right + _SEEN) // TILE + 1)
        kept[across, max(near - _SEEN, 0) // TILE : (far + _SEEN) // TILE + 1] = False
    kept = kept.reshape(-1)
    _leave_mixed(kept, start, now)
    return parts_of_tiles(net, part, radius, KeptTiles(kept, start, now, span))


@allocating_kernel
def _parts_now(part_before, part, number):
    """What each part of before is now; -1 where it is gone, -2 where it is several."""
    now = np.full(part_before.size, np.int32(-1))
    for i in range(number.size):
        if number[i] >= 0:
            to = part[number[i]]
            was = now[part_before[i]]
            now[part_before[i]] = to if was == -1 or was == to else -2
    return now


@allocating_kernel
def _leave_mixed(kept, start, now):
    """Do not keep tiles with parts that have been divided, or joined to another of the tile."""
    for tile in range(kept.size):
        for at in range(start[tile], start[tile + 1]):
            if now[at] < 0:
                kept[tile] = False
            for other in range(start[tile], at):
                if now[other] == now[at]:
                    kept[tile] = False
