"""Portals after a change: those near it are worked out anew, the others carried over from the graph before.

What a portal is depends on the clearance field under its two discs and as far beside them as a body can be
led off its line (`navmesh.graph.portals`).
"""

from typing import TYPE_CHECKING, Any

import numpy as np

from navmesh.graph.carrying import Earlier, earlier_of
from navmesh.graph.kernel_arrays import DOOR, door_rows, net_of
from navmesh.graph.portals import BENDS, fill_portal, is_open_to, open_portals
from navmesh.surface.columns import find_column
from surefoot.kernels import allocating_kernel, kernel
from surefoot.kernels.bundles import aligned

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["portals_for"]

_Doors = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def portals_for(graph: "NodeGraph", radius: float) -> _Doors:
    """The doors open to a body of ``radius`` [m] in CSR form: start (m + 1,), doors (p,) as of `door_rows`,
    lens (p, 2), block (p, 4); see `DOORS`."""
    net, edges = net_of(graph), (graph.edge_width, graph.edge_cells, graph.edge_gate)
    earlier = earlier_of(graph, "portals", radius)
    if earlier is None:
        start, target, portal, cells, lens, block = open_portals(net, *edges, radius)
        return start, door_rows(target, portal, cells), lens, block
    return _renewed(net, edges, radius, earlier)


def _renewed(
    net: Any, edges: tuple[np.ndarray, np.ndarray, np.ndarray], radius: float, earlier: Earlier
) -> _Doors:
    old_start, old_doors, old_lens, old_block = earlier.known
    windows = np.array(earlier.changes.windows, np.int64).reshape(-1, 4)
    number = earlier.changes.number
    start, row = _rows_before(net, *edges, radius, number, windows, old_start, old_doors["target"])
    doors, lens, block = aligned(len(row), DOOR), np.empty((len(row), 2)), np.empty((len(row), 4))
    _fill(
        net, *edges[1:], radius, number, windows, earlier.column_start, earlier.milestone,
        start, row, *_columns(old_doors), old_lens, old_block, *_columns(doors), lens, block,
    )  # fmt: skip
    return start, doors, lens, block


def _columns(doors: np.ndarray) -> tuple[np.ndarray, ...]:
    """The whole rows (p, 8) int64, and parts of them."""
    return doors.view(np.int64).reshape(-1, 8), doors["target"], doors["portal"], doors["portal_cell"]


@kernel(error_model="numpy")
def _is_near(net, windows, i, j, radius):
    """Whether the portal between nodes i and j depends on anything in the ``windows`` (w, 4)."""
    room = 2.0 * max(net.node_radius[i], net.node_radius[j]) + (BENDS + 1) * (1.1 * radius + net.cell)
    room += 8.0 * net.cell
    left = (min(net.position[i, 0], net.position[j, 0]) - room) / net.cell
    right = (max(net.position[i, 0], net.position[j, 0]) + room) / net.cell
    near = (min(net.position[i, 1], net.position[j, 1]) - room) / net.cell
    far = (max(net.position[i, 1], net.position[j, 1]) + room) / net.cell
    for w in range(windows.shape[0]):
        if left < windows[w, 2] and right > windows[w, 0] and near < windows[w, 3] and far > windows[w, 1]:
            return True
    return False


@allocating_kernel(error_model="numpy")
def _far(net, windows, radius):
    """(m,) bool: which nodes are so far from the ``windows`` that `_is_near` holds for none of their portals:
    those lead no farther than to the middle of another disc that touches their own."""
    widest = 0.0
    for i in range(net.node_radius.size):
        widest = max(widest, net.node_radius[i])
    room = 4.0 * widest + (BENDS + 1) * (1.1 * radius + net.cell) + 16.0 * net.cell
    far = np.ones(net.node_radius.size, np.bool_)
    for i in range(far.size):
        x, y = net.position[i, 0], net.position[i, 1]
        for w in range(windows.shape[0]):
            if (
                x - room < windows[w, 2] * net.cell
                and x + room > windows[w, 0] * net.cell
                and y - room < windows[w, 3] * net.cell
                and y + room > windows[w, 1] * net.cell
            ):
                far[i] = False
    return far


_SHUT, _FRESH = -1, -2
"""Of an edge, instead of the row that its portal had before: it has no portal; its portal has to be worked
out."""


@allocating_kernel(error_model="numpy", nogil=True)
def _rows_before(net, edge_width, edge_cells, edge_gate, radius, number, windows, old_start, old_target):
    """Where the portals of each node begin (m + 1,) int32; and for each portal the row that it had before,
    or -1 - e where that of edge e has to be worked out: (p,) int32."""
    nodes = net.node_radius.size
    was = np.full(nodes, -1, np.int32)
    for i in range(number.size):
        if number[i] >= 0:
            was[number[i]] = i
    kept = _far(net, windows, radius)
    door = np.empty(edge_width.size, np.int32)
    for i in range(nodes):
        kept[i] &= was[i] >= 0
        if not kept[i]:
            door[net.edge_start[i] : net.edge_start[i + 1]] = _SHUT
    for i in range(nodes):
        if kept[i]:
            continue
        before = was[i]
        at = np.int64(old_start[before]) if before >= 0 else 0
        for edge in range(net.edge_start[i], net.edge_start[i + 1]):
            j = net.edge_target[edge]
            if before >= 0 and was[j] >= 0 and not _is_near(net, windows, i, j, radius):
                last = old_start[before + 1]
                while at < last and old_target[at] < was[j]:
                    at += 1
                if at < last and old_target[at] == was[j]:
                    door[edge] = at
            elif i < j and is_open_to(
                net, i, j, edge_width[edge], edge_cells[edge, 0], edge_cells[edge, 1], edge_gate[edge], radius
            ):
                door[edge] = _FRESH
                for back in range(net.edge_start[j], net.edge_start[j + 1]):
                    if net.edge_target[back] == i:
                        door[back] = _FRESH
    start, row, count = np.zeros(nodes + 1, np.int32), np.empty(edge_width.size, np.int32), 0
    for i in range(nodes):
        if kept[i]:
            for at in range(old_start[was[i]], old_start[was[i] + 1]):
                row[count] = at
                count += 1
        else:
            for edge in range(net.edge_start[i], net.edge_start[i + 1]):
                if door[edge] != _SHUT:
                    row[count] = door[edge] if door[edge] >= 0 else -1 - edge
                    count += 1
        start[i + 1] = count
    return start, row[:count]


@allocating_kernel(error_model="numpy", nogil=True)
def _fill(
    net, edge_cells, edge_gate, radius, number, windows, old_column_start, old_milestone,
    start, row, old_words, old_target, old_portal, old_cells, old_lens, old_block,
    words, target, portal, cells, lens, block,
):  # fmt: skip
    """Write all portals; those of before in runs, as many as follow each other."""
    some_lens, some_block = lens[:, :], block[:, :]  # as in `open_portals`
    at, i = 0, 0
    while at < row.size:
        if row[at] < 0:
            while start[i + 1] <= at:
                i += 1
            edge = -1 - row[at]
            target[at] = net.edge_target[edge]
            fill_portal(
                net, i, target[at], edge_cells[edge], edge_gate[edge], radius, at,
                portal, cells, some_lens, some_block,
            )  # fmt: skip
            at += 1
            continue
        last = at + 1
        while last < row.size and row[last] == row[last - 1] + 1:
            last += 1
        first, beyond = row[at], row[last - 1] + 1
        words[at:last], lens[at:last] = old_words[first:beyond], old_lens[first:beyond]
        block[at:last] = old_block[first:beyond]
        at = last
    low, high = old_column_start.size - 1, np.int64(0)  # columns before and after all that has changed
    for w in range(windows.shape[0]):
        low = min(low, windows[w, 0] * net.ny)
        high = max(high, windows[w, 2] * net.ny)
    first, beyond = old_column_start[low], old_column_start[high]
    shift = net.column_start[high] - beyond
    for at in range(row.size):
        if row[at] < 0:
            continue
        target[at] = number[target[at]]
        for side in range(2):
            cell = cells[at, side]
            if cell >= beyond:
                cells[at, side] += shift
            elif cell >= first:
                column = find_column(old_column_start, old_milestone, np.int64(cell))
                cells[at, side] += net.column_start[column] - old_column_start[column]
