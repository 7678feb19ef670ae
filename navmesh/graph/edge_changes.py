"""The edges after a change: those at whose border anything is other than before are measured anew."""

import numpy as np

from navmesh.graph.edges import border_pairs, measure_edges, rows_of_edges
from navmesh.graph.node_changes import Nodes, RenewedNodes, boxes_of, hull
from navmesh.surface.renewal import cells_in, moved_cells
from navmesh.surface.surface import Surface
from surefoot.kernels import allocating_kernel

__all__ = ["Edges", "renew_edges"]

_SEEN = 4
"""Columns around a border on which the width of an edge depends."""

Edges = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""What `navmesh.graph.edges.join_nodes` gives."""


def renew_edges(old: Edges, nodes: Nodes, before: Surface, new: RenewedNodes, surface: Surface) -> Edges:
    """The edges between the ``new`` nodes of ``surface``; the ``old`` ones were between ``nodes`` of the
    surface ``before``. Bit for bit those that `join_nodes` finds in the whole."""
    beside = hull(np.array(new.window), np.empty((0, 4), np.int64), 1, surface)
    gone = np.unique(_borders_in(beside, before, nodes.label))
    a, b = new.number[gone >> 32].astype(np.int64), new.number[gone & 0xFFFFFFFF].astype(np.int64)
    stay = (a >= 0) & (b >= 0)
    wanted = np.union1d((a[stay] << 32) | b[stay], _borders_in(beside, surface, new.nodes.label))
    one, other = (
        boxes_of(new.nodes.place[ends], surface.resolution) for ends in (wanted >> 32, wanted & 0xFFFFFFFF)
    )
    shared = np.column_stack([np.maximum(one[:, :2], other[:, :2]), np.minimum(one[:, 2:], other[:, 2:])])
    seen = hull(beside, shared, _SEEN, surface)
    key, pair, clearance = _pairs_in(seen, surface, new.nodes.label)
    these = np.isin(key, wanted)
    measured = measure_edges(key[these], pair[these], clearance[these], surface.field, new.nodes.place)
    start, target, widths, gates, cells = old
    moved = moved_cells(cells.reshape(-1), before, surface, new.window).reshape(-1, 2)
    both_ways = np.sort(np.concatenate([gone, (gone << 32) | (gone >> 32)]))
    return _merge(
        start, target, widths, gates, moved, new.number, both_ways,
        *rows_of_edges(len(new.nodes.cell), *measured),
    )  # fmt: skip


def _borders_in(window: np.ndarray, surface: Surface, label: np.ndarray) -> np.ndarray:
    return _pairs_in(window, surface, label)[0]


def _pairs_in(
    window: np.ndarray, surface: Surface, label: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The `border_pairs` in the columns of ``window``, by the cells' numbers in the whole."""
    field, where = cells_in(surface, tuple(window.tolist()))
    key, pair, clearance = border_pairs(label[where], field, 0, len(where))
    return key, where[pair], clearance


@allocating_kernel(nogil=True)
def _merge(
    start, target, width, gate, cells, number, gone,
    new_start, new_target, new_width, new_gate, new_cells,
):  # fmt: skip
    """The edges of before, renumbered, without those that are ``gone``, and the new ones, by rising ends."""
    nodes = new_start.shape[0] - 1
    was = np.full(nodes, -1, np.int32)
    for i in range(number.shape[0]):
        if number[i] >= 0:
            was[number[i]] = i
    touched = np.zeros(number.shape[0], np.bool_)
    for k in range(gone.shape[0]):
        touched[gone[k] >> 32] = True
    most = target.shape[0] + new_target.shape[0]
    to_start, to_target, to_width = np.zeros(nodes + 1, np.int32), np.empty(most, np.int32), np.empty(most)
    to_gate, to_cells = np.empty((most, 2)), np.empty((most, 2), np.int32)
    count = 0
    i = 0
    while i < nodes:
        fresh, last = new_start[i], new_start[i + 1]
        j = was[i]
        run = 0  # nodes that keep all their edges, in a row
        while (
            i + run < nodes and was[i + run] == j + run >= 0 and not touched[j + run]
            and new_start[i + run + 1] == fresh
        ):  # fmt: skip
            run += 1
            to_start[i + run] = count + start[j + run] - start[j]
        if run > 0:
            first, beyond = start[j], start[j + run]
            size = beyond - first
            to_width[count : count + size] = width[first:beyond]
            to_gate[count : count + size] = gate[first:beyond]
            to_cells[count : count + size] = cells[first:beyond]
            for e in range(size):
                to_target[count + e] = number[target[first + e]]
            count += size
            i += run
            continue
        for e in range(start[j], start[j + 1]) if j >= 0 else range(0):
            if touched[j]:
                key = (np.int64(j) << 32) | target[e]
                at = np.searchsorted(gone, key)
                if at < gone.shape[0] and gone[at] == key:
                    continue
            to = number[target[e]]
            while fresh < last and new_target[fresh] < to:
                to_target[count], to_width[count] = new_target[fresh], new_width[fresh]
                to_gate[count], to_cells[count] = new_gate[fresh], new_cells[fresh]
                count += 1
                fresh += 1
            to_target[count], to_width[count] = to, width[e]
            to_gate[count], to_cells[count] = gate[e], cells[e]
            count += 1
        while fresh < last:
            to_target[count], to_width[count] = new_target[fresh], new_width[fresh]
            to_gate[count], to_cells[count] = new_gate[fresh], new_cells[fresh]
            count += 1
            fresh += 1
        i += 1
        to_start[i] = count
    return to_start, to_target[:count], to_width[:count], to_gate[:count], to_cells[:count]
