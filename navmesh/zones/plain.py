"""A graph with zones as one without, of what there is with those that are blocked now."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from navmesh.graph.edges import rows_of_edges
from navmesh.zones.leaps import link_room
from navmesh.zones.zones import zones_of
from surefoot.kernels import allocating_kernel

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["plain_graph"]


def plain_graph(graph: "NodeGraph") -> "NodeGraph":
    """``graph`` without zones, as it is now; kept until a zone is blocked or opened. Takes time in proportion
    to the level, unless all zones are open. Its nodes are numbered anew."""
    zones = graph.zone_state
    if zones is None:
        return graph
    if not zones.blocked.any():
        return zones.undivided
    with zones.lock:
        kept = graph.cache.get("plain")
        if kept is None or kept[0] != zones.changes:
            kept = graph.cache["plain"] = zones.changes, _made(graph)
        return kept[1]


def _made(graph: "NodeGraph") -> "NodeGraph":
    switches, surface = zones_of(graph).switches, graph.surface
    there = np.flatnonzero(graph.radii >= 0.0)
    number = np.full(len(graph) + 1, -1, np.int32)
    number[there] = np.arange(len(there))
    source = np.repeat(np.arange(len(graph)), np.diff(graph.edge_start))
    once = np.flatnonzero((source < graph.edge_target) & (number[source] >= 0))
    once = once[number[graph.edge_target[once]] >= 0]
    slot = _slots_in_use(switches.head, switches.following)
    first = np.append(source[once], switches.target[slot ^ 1])
    second = np.append(graph.edge_target[once], switches.target[slot])
    ends = number[np.column_stack([first, second])]
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    of_bases = graph.edge_width[once], graph.edge_gate[once], graph.edge_cells[once]
    of_pieces = switches.width[slot], switches.gate[slot], switches.border[slot]
    rows = (np.concatenate(each)[order] for each in zip(of_bases, of_pieces, strict=True))
    start, target, width, gate, border = rows_of_edges(len(there), ends[order], *rows)
    links = replace(graph.links, radius=link_room(graph))
    return replace(
        graph, positions=graph.positions[there], radii=graph.radii[there], label=number[graph.label],
        node_cell=graph.node_cell[there], edge_start=start, edge_target=target, edge_width=width,
        edge_gate=gate, edge_cells=border, links=links, kept_build=None, zone_state=None, cache={},
        surface=replace(
            surface, storey=surface.storey.copy(), clearance=surface.clearance.copy(),
            kept_nearest=surface.kept_nearest.copy(), blocker=surface.blocker.copy(),
        ),
    )  # fmt: skip


@allocating_kernel
def _slots_in_use(head, following):
    """The slots (s,) int64 of edges that there are, those from the lesser node to the greater."""
    found = np.empty(following.size, np.int64)
    count = 0
    for node in range(head.size):
        slot = np.int64(head[node])
        while slot >= 0:
            if slot & 1 == 0:
                found[count] = slot
                count += 1
            slot = np.int64(following[slot])
    return found[:count].copy()
