"""The arrays of a surface and of its graph that kernels read, bundled as one argument.

There is one type for all. Cells are measured before there is a graph, or are a part of a level: what is not
there yet is empty, and no kernel that works on them reads it. With a type of its own for that time, what
measures distances would be compiled twice.
"""

from typing import Any

import numpy as np
from numba import float64, int32, int64, uint8

from surefoot.kernels.bundles import BundleType, aligned, rows

__all__ = ["NET", "NODE", "NO_GRAPH"]

NODE = np.dtype([("position", "f8", 3), ("node_radius", "f8")])

NET = BundleType(
    cell=float64,
    nx=int64,
    ny=int64,
    column_start=int32[::1],
    milestone=int32[::1],
    floor_shift=int32[::1],
    floor_height=float64[::1],
    floor_slope=int32[::1],
    slopes=float64[:, ::1],
    storey=uint8[:, ::1],
    clearance=float64[::1],
    choice=uint8[::1],
    nearest=float64[:, ::1],
    source=int32[::1],
    list_cell=int32[::1],
    list_start=int32[::1],
    blocker=float64[:, ::1],
    label=int32[::1],
    nodes=rows(NODE),
    node_cell=int32[::1],
    edge_start=int32[::1],
    edge_target=int32[::1],
)
"""The surface and the graph.

cell: side of a grid square [m]; nx, ny: columns. The arrays of `Surface` themselves: column_start
(nx*ny + 1,), milestone (⌈n / 32⌉ + 1,), see `navmesh.surface.columns`, and, for each cell, storey (4),
clearance, choice, source; list_cell (l,), list_start (l + 1,), blocker (k, 4); nearest (n, 2) if zones change
it, else (0, 2), see `navmesh.surface.recall.nearest_of`. Height and slope of a cell are found by floor_shift,
floor_height, floor_slope and slopes, see `navmesh.surface.floor_store.height_of`. Of `NodeGraph`: label of
each cell; position (3), node_radius and node_cell of each node; edge_start (m + 1,), edge_target (e,).
"""

_NONE = np.empty(0, np.int32)
NO_GRAPH: dict[str, Any] = {
    "floor_shift": _NONE, "floor_height": np.empty(0), "floor_slope": _NONE, "slopes": np.empty((0, 2)),
    "label": _NONE, "nodes": aligned(0, NODE), "node_cell": _NONE,
    "edge_start": _NONE, "edge_target": _NONE,
}  # fmt: skip
"""What a `NET` says of floor and graph before these are there."""
