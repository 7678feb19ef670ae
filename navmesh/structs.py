"""The arrays that the search kernels read, bundled so that a call passes three arguments, not fifty.

Passing an array to a compiled function costs about 0.1 µs; a Numba structref costs 0.7 µs however many arrays
it holds. `Net` is the graph with its field of clearances, `Doors` is what one body radius makes of it, and
`Scratch` is the memory of one search at a time. All coordinates are relative to the surface's origin.

`Net` and `Doors` hold each array twice: as a view that kernels read, whose uses are not counted, and among
their ``owners``, which keep its memory.
"""

from typing import TYPE_CHECKING, Any

import numpy as np
from numba import njit, types
from numba.core import cgutils
from numba.experimental import structref
from numba.extending import intrinsic

if TYPE_CHECKING:
    from navmesh.graph import NodeGraph

__all__ = ["Doors", "Net", "Scratch", "make_doors", "make_net", "make_scratch", "net_of"]


class _Fields(types.StructRef):
    def preprocess_fields(self, fields):
        return tuple((name, types.unliteral(kind)) for name, kind in fields)


@structref.register
class _NetType(_Fields):
    pass


@structref.register
class _DoorsType(_Fields):
    pass


@structref.register
class _ScratchType(_Fields):
    pass


class Net(structref.StructRefProxy):
    """The graph and its field: the arrays of `make_net` under the same names."""


class Doors(structref.StructRefProxy):
    """The portals of every edge for one body radius: the arrays of `make_doors` under the same names."""


class Scratch(structref.StructRefProxy):
    """Memory of one search: see `make_scratch`."""


_NET = (
    "cell", "nx", "ny", "column_start", "cell_column", "height", "gradient", "link", "clearance", "nearest",
    "label", "position", "node_cell", "node_radius", "edge_start", "edge_target", "owners",
)  # fmt: skip
_DOORS = (
    "radius", "start", "target", "portal", "portal_cell", "lens", "block", "node_cost", "weighted",
    "leap_start", "leap_id", "leap_from", "leap_from_cell", "leap_to", "leap_to_cell", "leap_cost", "owners",
)  # fmt: skip
_SCRATCH = (
    "numbers", "stamp", "cost", "total", "entry", "parent", "via", "heap_key", "heap_node", "ends", "nodes",
    "edges", "points", "cells",
    "corner", "corner_at", "arc", "stack", "stack_cell", "cell_stamp", "cell_best", "cell_parent",
)  # fmt: skip

for _proxy, _type, _names in (
    (Net, _NetType, _NET),
    (Doors, _DoorsType, _DOORS),
    (Scratch, _ScratchType, _SCRATCH),
):
    structref.define_constructor(_proxy, _type, list(_names))
    structref.define_attributes(_type)
    structref.define_boxing(_type, _proxy)


@intrinsic
def _uncounted(typingctx, values):
    """The tuple ``values`` with views of its arrays that do not count as uses of their memory.

    Numba counts a use whenever it takes an array out of a struct, which costs more than what most kernels do
    with it.
    """

    def code(context, builder, signature, arguments):
        parts = []
        for i, kind in enumerate(signature.args[0]):
            part = builder.extract_value(arguments[0], i)
            if isinstance(kind, types.Array):
                view = context.make_array(kind)(context, builder, part)
                view.meminfo = cgutils.get_null_value(view.meminfo.type)
                view.parent = cgutils.get_null_value(view.parent.type)
                part = view._getvalue()
            parts.append(part)
        return context.make_tuple(builder, signature.return_type, parts)

    return values(values), code


@njit(cache=True)
def make_net(*values):
    """Bundle the surface and the graph.

    cell: side of a grid square [m]; nx, ny: columns; column_start (nx*ny+1,) int32; cell_column (n,) int32;
    height (n,), gradient (n, 2) float64; link (n, 4) int32; clearance (n,), nearest (n, 2) float64; label
    (n,) int32; position (m, 3) float64, node_cell (m,) int32, node_radius (m,) float64; edge_start (m+1,),
    edge_target (e,) int32.
    """
    return Net(*_uncounted(values), values)


@njit(cache=True)
def make_doors(*values):
    """Bundle what one body radius makes of the graph.

    radius [m]; the doors, edges that the body passes, of node i are start[i]:start[i + 1], start (m + 1,)
    int32; target (p,) int32: the node behind; portal (p, 6) float64: x, y, z of its left and of its right end
    as seen walking through; portal_cell (p, 2) int32: the cells of the ends; lens (p, 2) float64: the part of
    it (0 left, 1 right) that lies in both shrunk discs, all of it where they do not overlap; block (p, 4)
    float64: x, y of what ends walking at its left and at its right end, inf where nothing does; node_cost
    (m,) float64, at least 1: factor on the length walked in each node; weighted: whether any factor is not 1.
    The leaps are the typed links on offer, grouped by the node they start from: leap_start (m+1,), leap_id
    (l,) int32, leap_from, leap_to (l, 3) float64, leap_from_cell, leap_to_cell (l,) int32, leap_cost (l,)
    float64 [m].
    """
    return Doors(*_uncounted(values), values)


@njit(cache=True)
def make_scratch(nodes, edges):
    """Memory for one search over a graph of ``nodes`` nodes and ``edges`` directed edges.

    numbers (16,) int64: the stamp of the current search and its counters, see `navmesh.search`; stamp, cost,
    total, entry (3 coordinates and the cell's place is not kept), parent, via: per node; heap_key, heap_node:
    the open list; ends (8,) float64: start and goal; nodes, edges: the chain found; points, cells: the
    corners pulled; corner, corner_at: those of the funnel; arc: those that round one of them; stack,
    stack_cell: corners still to be reached; cell_stamp, cell_best, cell_parent: per cell, once
    `navmesh.detour` needs them.
    """
    room = max(nodes, 16)
    return Scratch(
        np.zeros(16, np.int64),
        np.zeros(nodes, np.int64),
        np.empty(nodes, np.float64),
        np.empty(nodes, np.float64),
        np.empty((nodes, 3), np.float64),
        np.empty(nodes, np.int32),
        np.empty(nodes, np.int32),
        np.empty(edges + room, np.float64),
        np.empty(edges + room, np.int32),
        np.zeros(8, np.float64),
        np.empty(room + 1, np.int32),
        np.empty(room + 1, np.int32),
        np.empty((64, 3), np.float64),
        np.empty(64, np.int32),
        np.empty((64, 2), np.float64),
        np.empty(64, np.int32),
        np.empty((2, 2), np.float64),
        np.empty((14, 2), np.float64),
        np.empty(14, np.int32),
        np.zeros(0, np.int64),
        np.empty(0, np.float64),
        np.empty(0, np.int32),
    )


def net_of(graph: "NodeGraph") -> Any:
    """The graph's `Net`, made once."""
    net = graph.cache.get("net")
    if net is None:
        surface = graph.surface
        net = graph.cache["net"] = make_net(
            surface.resolution,
            surface.shape[0],
            surface.shape[1],
            surface.column_start,
            surface.cell_column,
            surface.height,
            surface.gradient,
            surface.link,
            surface.clearance,
            surface.nearest,
            graph.label,
            np.ascontiguousarray(graph.positions - surface.origin),
            graph.node_cell,
            graph.radii,
            graph.edge_start,
            graph.edge_target,
        )
    return net
