"""The arrays that the search kernels read, bundled so that a call passes three arguments, not fifty.

`navmesh.surface.net.NET` is the graph with its field of clearances, `DOORS` is what one body radius makes of
it, and `SCRATCH` is the memory of one search at a time. What is read together lies together: a door is one
line of the cache, and what a search knows of a node half of one. All coordinates are relative to the
surface's origin.
"""

from typing import TYPE_CHECKING, Any

import numpy as np
from numba import float64, int32, int64

from navmesh.graph.parts import Tiles
from navmesh.grouping import by_group
from navmesh.routes.graph_search import LABELS
from navmesh.surface.net import NODE
from surefoot.kernels.bundles import Bundle, BundleType, aligned, rows

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["DOOR", "DOORS", "SCRATCH", "door_rows", "make_doors", "make_scratch", "net_of", "tile_fields"]

DOOR = np.dtype([("portal", "f8", 6), ("portal_cell", "i4", 2), ("target", "i4"), ("", "i4")])
"""A row of `DOORS.doors`."""
_LABEL = np.dtype(
    [
        ("cost", "f8"), ("total", "f8"), ("apex", "f8", 3), ("left", "f8", 3), ("right", "f8", 3),
        ("node", "i4"), ("parent", "i4"), ("via", "i4"), ("aside", "i4"), ("", "f8", 3),
    ]
)  # fmt: skip
_SEEN = np.dtype([("stamp", "i8"), ("label", "i4", LABELS), ("label_total", "f8", LABELS)])

_NO_SLOTS = np.empty(0, np.int32)

DOORS = BundleType(
    radius=float64,
    weighted=int64,
    start=int32[::1],
    doors=rows(DOOR),
    lens=float64[:, ::1],
    block=float64[:, ::1],
    head=int32[::1],
    following=int32[::1],
    node_cost=float64[::1],
    whole=int32[::1],
    leap_start=int32[::1],
    leap_id=int32[::1],
    leap_from=float64[:, ::1],
    leap_from_cell=int32[::1],
    leap_to=float64[:, ::1],
    leap_to_cell=int32[::1],
    leap_cost=float64[::1],
    leap_closed=int32[::1],
    widest=float64,
    part=int32[::1],
    region=int32[::1],
    ring=int32[::1],
    part_whole=int32[::1],
    anywhere=int64,
    part_leap_start=int32[::1],
    part_leap=int32[::1],
    tile_start=int32[::1],
    tile_part=int32[::1],
    tile_span=float64[:, ::1],
    tile_block=int64[::1],
    part_row_start=int32[::1],
    part_row=int32[::1],
    row_tile=int32[::1],
)
"""What one body radius makes of the graph.

radius [m]; the doors, edges that the body passes, of node i are start[i]:start[i + 1]. Where there are zones
(`navmesh.zones`) it has those of a list of slots, too: head[i] is the first, following[s] the next after slot
s, until -1; slot s is door target.size - following.size + s. For each door: target, the node behind, or -1
where a blocked zone is in the way; portal (6): x, y, z of its left and of its right end as seen walking
through; portal_cell (2): the cells of the ends; lens (2): the part of it (0 left, 1 right) that lies in both
shrunk discs, all of it where they do not overlap; block (4): x, y of what ends walking at its left and at its
right end, inf where nothing does. node_cost (m,), at least 1: factor on the length walked in each node;
weighted: whether any factor is not 1. The leaps are the typed links on offer, grouped by the node they start
from: leap_start (m + 1,), leap_id (l,), leap_from, leap_to (l, 3), leap_from_cell, leap_to_cell (l,),
leap_cost (l,) [m]; leap_closed (l,): 1 for those in whose way a blocked zone is. Those of a piece of a disc
are among those of whole (m,), the node that it is a piece of; of other nodes it is the node itself. widest:
radius [m] of the widest disc. part (m,): which nodes can be walked to from each other, see
`navmesh.graph.parts`; region (p,): the same for parts that open zones join, by its first part, and ring (p,)
the next part of it; part_whole (p,): as whole; part_leap_start (p + 1,), part_leap (l,): the leaps from each
part; anywhere: the part that stands in tiles for those near zones, or -1; tile_start (t + 1,), tile_part
(r,), tile_span (r, 2), tile_block (r,): `navmesh.graph.parts.Tiles`; part_row_start (p + 1,), part_row (r,):
which of these rows each part has, and row_tile (r,) the tile of each.
"""

SCRATCH = BundleType(
    numbers=int64[::1],
    ends=float64[::1],
    seen=rows(_SEEN),
    labels=rows(_LABEL),
    heap_key=float64[::1],
    heap_item=int32[::1],
    reached=int64[::1],
    part_stack=int32[::1],
    nodes=int32[::1],
    edges=int32[::1],
    points=float64[:, ::1],
    cells=int32[::1],
    corner=float64[:, ::1],
    corner_at=int32[::1],
    arc=float64[:, ::1],
    bend=float64[:, ::1],
    trial=float64[:, ::1],
    trial_cell=int32[::1],
    kept=float64[:, ::1],
    kept_nodes=int32[::1],
    kept_leaps=int32[:, ::1],
    saved=float64[:, ::1],
    saved_cell=int32[::1],
    stack=float64[:, ::1],
    stack_cell=int32[::1],
    cell_stamp=int64[::1],
    cell_best=float64[::1],
    cell_parent=int32[::1],
)
"""Memory for one search at a time.

numbers: the stamp of the current search and its counters, see `navmesh.routes.graph_search`; ends: start and
goal. For each node: stamp, the last search that came to it; label (LABELS): the numbers of its labels, or -1,
and label_total, their totals, or inf. For each label: node, cost, total, apex, left, right (3), parent, via:
the door, or the number of doors + leap; aside: whether it has been set aside. heap_key, heap_item: the open
list; reached: for each part the last search that can get to it, part_stack: regions that it gets to;
nodes, edges: the chain found; points, cells: the corners pulled; corner, corner_at: those of the funnel; arc:
those that round one of them; bend: those that lead a line round a place; trial, trial_cell: corners to be put
in the place of one; kept, kept_nodes, kept_leaps: the best line so far; saved, saved_cell: corners to go back
to; stack, stack_cell: corners still to be reached; cell_stamp, cell_best, cell_parent: what
`navmesh.routes.cell_search` knows of each cell.
"""


def _table(dtype: np.dtype, **columns: np.ndarray) -> np.ndarray:
    table = aligned(len(next(iter(columns.values()))), dtype)
    for name, values in columns.items():
        table[name] = values
    return table


def net_of(graph: "NodeGraph") -> Any:
    """The graph's `navmesh.surface.net.NET`, made once."""
    net = graph.cache.get("net")
    if net is None:
        net = graph.cache["net"] = _net(graph)
    return net


def _net(graph: "NodeGraph") -> Any:
    surface = graph.surface
    return surface.net(
        floor_shift=surface.floor.shift(surface.column_start),
        floor_height=surface.floor.height,
        floor_slope=surface.floor.slope,
        slopes=surface.floor.slopes,
        label=graph.label,
        nodes=_table(NODE, position=graph.positions - surface.origin, node_radius=graph.radii),
        node_cell=graph.node_cell,
        edge_start=graph.edge_start,
        edge_target=graph.edge_target,
    )


def door_rows(target: np.ndarray, portal: np.ndarray, portal_cell: np.ndarray) -> np.ndarray:
    """The doors' table of `DOORS` from its columns."""
    return _table(DOOR, portal=portal, portal_cell=portal_cell, target=target)


def tile_fields(tiles: Tiles, parts: int) -> dict[str, np.ndarray]:
    """The fields of `DOORS` for ``tiles`` with so many ``parts``."""
    start, row = by_group(tiles.part, parts)
    return {
        "tile_start": tiles.start, "tile_part": tiles.part, "tile_span": tiles.span,
        "tile_block": tiles.block, "part_row_start": start, "part_row": row,
        "row_tile": np.repeat(np.arange(len(tiles.start) - 1, dtype=np.int32), np.diff(tiles.start)),
    }  # fmt: skip


def make_doors(
    radius: float,
    portals: tuple[np.ndarray, ...],
    costs: np.ndarray,
    weighted: bool,
    leaps: dict,
    parts: dict,
    widest: float,
) -> Bundle:
    """`DOORS` from ``portals`` (start, `door_rows`, lens, block and, where there are zones, head and
    following), which all `DOORS` of a radius share, the costs of the nodes, the ``leap`` arrays and those of
    the parts."""
    start, doors, lens, block, *slots = portals
    head, following = slots or (_NO_SLOTS, _NO_SLOTS)
    return Bundle(
        DOORS,
        radius=radius,
        weighted=weighted,
        start=start,
        doors=doors,
        lens=lens,
        block=block,
        head=head,
        following=following,
        node_cost=costs,
        widest=widest,
        **leaps,
        **parts,
    )


def _most_opened(graph: "NodeGraph") -> int:
    """How many entries the open list can get: whenever a label is expanded, one for each way on."""
    zones = graph.zone_state
    slots = 0 if zones is None else zones.slots
    return LABELS * (len(graph.edge_target) + len(graph.links) + slots) + 1


def make_scratch(graph: "NodeGraph") -> Any:
    """`SCRATCH` for searches over the graph, with room for all that can come up. Most of it is never touched
    and so takes no memory."""
    nodes, cells = len(graph.radii), len(graph.surface)
    labels = LABELS * nodes
    opened = _most_opened(graph)
    chain = labels + 1
    corners = cells + 4096
    scratch: Any = Bundle(
        SCRATCH,
        numbers=np.zeros(16, np.int64),
        ends=np.zeros(12),
        seen=aligned(nodes, _SEEN),
        labels=aligned(labels, _LABEL),
        heap_key=np.empty(opened),
        heap_item=np.empty(opened, np.int32),
        reached=np.zeros(nodes + 1, np.int64),
        part_stack=np.empty(nodes + 1, np.int32),
        nodes=np.empty(chain, np.int32),
        edges=np.empty(chain, np.int32),
        points=np.empty((corners, 3)),
        cells=np.empty(corners, np.int32),
        corner=np.empty((2 * chain + 2, 2)),
        corner_at=np.empty(2 * chain + 2, np.int32),
        arc=np.empty((2, 2)),
        bend=np.empty((2, 2)),
        trial=np.empty((4, 2)),
        trial_cell=np.empty(4, np.int32),
        kept=np.empty((corners, 3)),
        kept_nodes=np.empty(chain, np.int32),
        kept_leaps=np.empty((len(graph.links.obstacle), 2), np.int32),
        saved=np.empty((16, 2)),
        saved_cell=np.empty(16, np.int32),
        stack=np.empty((14, 2)),
        stack_cell=np.empty(14, np.int32),
        cell_stamp=np.zeros(cells, np.int64),
        cell_best=np.empty(cells),
        cell_parent=np.empty(cells, np.int32),
    )
    scratch.slots = 0 if graph.zone_state is None else graph.zone_state.slots
    return scratch
