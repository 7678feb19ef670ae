"""Portals after a change: those near it are worked out anew, the others carried over from the graph before.

What a portal is depends on the clearance field under its two discs and as far beside them as a body can be
led off its line (`navmesh.graph.portals`).
"""

from typing import TYPE_CHECKING, Any

import numpy as np

from navmesh.graph.carrying import Earlier, earlier_of
from navmesh.graph.kernel_arrays import net_of
from navmesh.graph.portals import BENDS, fill_portal, is_open_to, open_portals
from navmesh.surface.columns import find_column
from surefoot.kernels import allocating_kernel, kernel

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["portals_for"]


def portals_for(graph: "NodeGraph", radius: float) -> tuple[np.ndarray, ...]:
    """The graph's portals for a body of ``radius`` [m]: what `open_portals` gives."""
    net, edges = net_of(graph), (graph.edge_width, graph.edge_cells, graph.edge_gate)
    earlier = earlier_of(graph, "portals", radius)
    if earlier is None:
        return open_portals(net, *edges, radius)
    return _renewed(net, edges, radius, earlier)


def _renewed(
    net: Any, edges: tuple[np.ndarray, np.ndarray, np.ndarray], radius: float, earlier: Earlier
) -> tuple[np.ndarray, ...]:
    start, doors, lens, block = earlier.known
    windows = np.array(earlier.changes.windows, np.int64).reshape(-1, 4)
    return _renew(
        net, *edges, radius, earlier.changes.number, windows, earlier.column_start, earlier.milestone,
        start, doors["target"], doors["portal"], doors["portal_cell"], lens, block,
    )  # fmt: skip


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
def _renew(
    net, edge_width, edge_cells, edge_gate, radius, number, windows, old_column_start, old_milestone,
    old_start, old_target, old_portal, old_cells, old_lens, old_block,
):  # fmt: skip
    nodes = net.node_radius.size
    was = np.full(nodes, -1, np.int32)
    for i in range(number.size):
        if number[i] >= 0:
            was[number[i]] = i
    door = np.full(edge_width.size, -1, np.int32)  # -1: shut, -2: to be worked out, else its row of before
    count = 0
    for i in range(nodes):
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
                    count += 1
            elif i < j and is_open_to(
                net, i, j, edge_width[edge], edge_cells[edge, 0], edge_cells[edge, 1], edge_gate[edge], radius
            ):
                door[edge] = -2
                for back in range(net.edge_start[j], net.edge_start[j + 1]):
                    if net.edge_target[back] == i:
                        door[back] = -2
                count += 2
    low, high = old_column_start.size - 1, np.int64(0)  # columns before and after all that has changed
    for w in range(windows.shape[0]):
        low = min(low, windows[w, 0] * net.ny)
        high = max(high, windows[w, 2] * net.ny)
    first, beyond = old_column_start[low], old_column_start[high]
    shift = net.column_start[high] - beyond
    start, target = np.zeros(nodes + 1, np.int32), np.empty(count, np.int32)
    portal, cells = np.empty((count, 6)), np.empty((count, 2), np.int32)
    lens, block = np.empty((count, 2)), np.empty((count, 4))
    rows = portal[:, :], cells[:, :], lens[:, :], block[:, :]  # as in `open_portals`
    count = 0
    for i in range(nodes):
        for edge in range(net.edge_start[i], net.edge_start[i + 1]):
            at, j = door[edge], net.edge_target[edge]
            if at == -1:
                continue
            target[count] = j
            if at == -2:
                fill_portal(net, i, j, edge_cells[edge], edge_gate[edge], radius, count, *rows)
            else:
                portal[count], lens[count], block[count] = old_portal[at], old_lens[at], old_block[at]
                for side in range(2):
                    cell = old_cells[at, side]
                    if cell >= beyond:
                        cell += shift
                    elif cell >= first:
                        column = find_column(old_column_start, old_milestone, np.int64(cell))
                        cell += net.column_start[column] - old_column_start[column]
                    cells[count, side] = cell
            count += 1
        start[i + 1] = count
    return start, target, portal, cells, lens, block
