"""The coarse graph of a whole world for one body radius.

The world is cut into squares. The discs of the fine graph with their centres in one square that are joined
there are a *region*. Where doors lead from one region to another, and where a typed link starts or lands in
another region, there are *terminals*; and *anchors* all over each region, for ways to begin and to end at.
Between the terminals of a region there are edges, as long as the route between them on the fine graph. So two
places are joined here just if they are joined there.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from navmesh.graph.open_to_body import parts_of, portals_of

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["ANCHOR", "AROUND", "GATE", "NEAREST", "CoarseGraph", "coarse_graph_of"]

GATE = 8.0
"""[m] between the terminals of a wide border."""
ANCHOR = 15.0
"""[m] of the squares in each of which a region has an anchor, in its widest disc there."""
NEAREST = 48
"""Terminals of its region that a terminal has edges to; those of larger regions are joined over the first."""
AROUND = 12
"""The same for anchors, and for the ends of a way."""
_BATCH = 50_000  # routes that are held at once


@dataclass(frozen=True, slots=True, eq=False)
class CoarseGraph:
    """n terminals in R regions, with e edges and l leaps between them."""

    part: np.ndarray
    """(R,) int32: alike for regions that are joined on foot, from 0 up."""
    place: np.ndarray
    """(n, 3) float64 [m]: where each terminal is, in world coordinates; the body fits there. Anchors are the
    last."""
    member_start: np.ndarray
    """(R + 1,) int32: the terminals of region r are member[member_start[r]:member_start[r + 1]]."""
    member: np.ndarray
    """(k,) int32."""
    edge_start: np.ndarray
    """(n + 1,) int32: the edges from terminal i are edge_start[i]:edge_start[i + 1]."""
    edge_target: np.ndarray
    """(e,) int32."""
    edge_length: np.ndarray
    """(e,) float32 [m]: of the fine route. Every edge has its reverse."""
    leap_start: np.ndarray
    """(n + 1,) int32: the leaps from terminal i are leap_start[i]:leap_start[i + 1]."""
    leap_target: np.ndarray
    """(l,) int32: the terminal where each lands."""
    leap_cost: np.ndarray
    """(l,) float64 [m]: see `Links.cost`."""
    leap_from: np.ndarray
    """(l,) int32: the region of each leap's run-up."""
    leap_to: np.ndarray
    """(l,) int32: the region that it lands in."""
    leap_kind: np.ndarray
    """(l,) str: its affordance."""
    leap_height: np.ndarray
    """(l,) float64 [m]: what a skill's range is compared with, see `Links.height`."""

    def terminals_of(self, region: int) -> np.ndarray:
        """The terminals of a region: (k,) int32."""
        return self.member[self.member_start[region] : self.member_start[region + 1]]


def _regions(graph: "NodeGraph", radius: float, side: float) -> tuple[np.ndarray, np.ndarray]:
    """The region of each node, (m,) int32, -1 for those that the body cannot get into; and each region's
    part."""
    source, target, _ = _doors(graph, radius)
    square = np.floor(graph.positions[:, :2] / side).astype(np.int64)
    inside = (square[source] == square[target]).all(axis=1)
    links = coo_array(
        (np.ones(inside.sum(), np.int8), (source[inside], target[inside])), shape=2 * [len(graph)]
    )
    label = connected_components(links, directed=False)[1]
    opens = np.bincount(source, minlength=len(graph)) > 0  # also small ones that large ones overlap
    fits = np.flatnonzero((graph.radii >= radius) | opens)
    region = np.full(len(graph), -1, np.int32)
    first, region[fits] = _numbered(label[fits])
    return region, _numbered(parts_of(graph, radius)[0][fits[first]])[1]


def _doors(graph: "NodeGraph", radius: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The p doors open to a body of ``radius`` [m]: the node on this side, the node beyond, and the rows of
    `navmesh.graph.open_to_body.portals_of`."""
    start, doors = portals_of(graph, radius)[:2]
    source = np.repeat(np.arange(len(graph)), np.diff(start))
    return source, np.ascontiguousarray(doors["target"]), doors


def _numbered(labels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """``labels`` (k,) by the order in which they appear: (where each is first, number of each)."""
    _, first, number = np.unique(labels, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(len(order), np.int32)
    rank[order] = np.arange(len(order))
    return first[order], rank[number.reshape(-1)]


def _first_of_alike(rows: np.ndarray, cost: np.ndarray) -> np.ndarray:
    """Of equal ``rows`` (k, c) the one of least ``cost`` (k,), and of these the first: their indices, by
    rising rows."""
    order = np.lexsort((cost, *rows.T[::-1]))
    fresh = np.append(True, (np.diff(rows[order], axis=0) != 0).any(axis=1))[: len(order)]
    return order[fresh]


def _gates(graph: "NodeGraph", radius: float, region: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places (g, 3) [m] on the doors between regions, at most about `GATE` apart, and their regions (g,
    2)."""
    source, target, doors = _doors(graph, radius)
    across = np.flatnonzero((region[source] < region[target]) & (region[source] >= 0))
    portal = np.ascontiguousarray(doors["portal"][across])
    left, right = portal[:, :3], portal[:, 3:]
    pieces = np.maximum(np.ceil(np.linalg.norm(right - left, axis=1) / GATE), 1).astype(np.int64)
    door = np.repeat(np.arange(len(across)), pieces)
    at = np.arange(len(door)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    share = ((at + 0.5) / pieces[door])[:, None]
    place = left[door] + share * (right - left)[door] + graph.surface.origin
    pair = np.stack([region[source], region[target]], axis=1)[across][door]
    # of the places between two regions in a square of GATE, that on the widest door
    spot = np.column_stack([pair, np.floor(place[:, :2] / GATE).astype(np.int64)])
    width = np.linalg.norm(right - left, axis=1)[door]
    kept = _first_of_alike(spot, -width)
    return place[kept], pair[kept]


def _leaps(graph: "NodeGraph", radius: float, region: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The links (l,) from one region to another that a body of ``radius`` passes, and their regions (l, 2):
    of those alike in a square of `GATE` the cheapest."""
    links = graph.links
    nodes = graph.label[links.start_cell], graph.label[links.end_cell]
    ends = np.stack([np.where(node >= 0, region[node], -1) for node in nodes], axis=1).reshape(-1, 2)
    index = np.flatnonzero((links.radius >= radius) & (ends >= 0).all(axis=1) & (ends[:, 0] != ends[:, 1]))
    kind = np.unique(links.affordance[index], return_inverse=True)[1].reshape(-1)
    spot = np.floor(links.edge[index, :2] / GATE).astype(np.int64)
    tall = np.unique(links.height[index], return_inverse=True)[1].reshape(-1)
    alike = np.column_stack([ends[index], kind, tall, spot])
    index = np.sort(index[_first_of_alike(alike, links.cost[index])])
    return index, ends[index]


def _anchors(graph: "NodeGraph", region: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places (a, 3) [m] in the regions, and which each is in (a,)."""
    nodes = np.flatnonzero(region >= 0)
    spot = np.column_stack([region[nodes], np.floor(graph.positions[nodes, :2] / ANCHOR).astype(np.int64)])
    kept = nodes[_first_of_alike(spot, -graph.radii[nodes])]
    return graph.positions[kept], region[kept].astype(np.int64)


def _pairs(terminals: np.ndarray, place: np.ndarray, anchors_from: int) -> np.ndarray:
    """Pairs (p, 2) of the ``terminals`` of one region (k,), rising, that are to have an edge, the lesser
    first; those ``anchors_from`` a number on are anchors."""
    count, ports = len(terminals), int(np.searchsorted(terminals, anchors_from))
    off = np.linalg.norm(place[terminals, None] - place[None, terminals], axis=2)
    order = np.argsort(off, axis=1, kind="stable")
    toward_port = order[:ports][order[:ports] < ports].reshape(ports, ports)[:, 1 : NEAREST + 1]
    toward_any = order[ports:, 1 : AROUND + 1]
    one = [np.repeat(np.arange(ports), toward_port.shape[1])]
    one += [np.repeat(np.arange(ports, count), toward_any.shape[1]), np.zeros(count - 1, np.int64)]
    other = np.concatenate([toward_port.reshape(-1), toward_any.reshape(-1), np.arange(1, count)])
    pairs = np.sort(np.stack([terminals[np.concatenate(one)], terminals[other]], axis=1), axis=1)
    return pairs[pairs[:, 0] != pairs[:, 1]]


def coarse_graph_of(
    graph: "NodeGraph", radius: float, side: float, threads: int = 1
) -> tuple[CoarseGraph, np.ndarray]:
    """The coarse graph of ``graph`` for a body of ``radius`` [m] over squares of ``side`` [m], and the region
    of each node, (m,) int32, -1 for none. ``threads`` share the routes."""
    region, part = _regions(graph, radius, side)
    gates, between = _gates(graph, radius, region)
    index, leap_ends = _leaps(graph, radius, region)
    links = graph.links
    anchors, around = _anchors(graph, np.where(graph.radii >= radius, region, -1))
    place = np.concatenate([gates, links.start[index], links.end[index], anchors])
    place = _settled(graph, place, radius, threads)
    count, first = len(place), len(gates) + np.arange(len(index))
    anchors_from = count - len(anchors)
    of_region = np.concatenate([between.reshape(-1), leap_ends[:, 0], leap_ends[:, 1], around])
    of_terminal = np.concatenate(
        [np.repeat(np.arange(len(gates)), 2), first, first + len(index), np.arange(anchors_from, count)]
    )
    order = np.lexsort((of_terminal, of_region))
    member = of_terminal[order].astype(np.int32)
    member_start = np.searchsorted(of_region[order], np.arange(len(part) + 1)).astype(np.int32)
    pairs = [np.empty((0, 2), np.int64)]
    for low, high in pairwise(member_start.tolist()):
        if high > low + 1:
            pairs.append(_pairs(member[low:high], place, anchors_from))
    pair = np.unique(np.concatenate(pairs), axis=0)
    length = _lengths(graph, place[pair[:, 0]], place[pair[:, 1]], radius, threads)
    ends = np.concatenate([pair, pair[:, ::-1]])
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    run_up, landing = place[first], place[first + len(index)]
    every = np.arange(count + 1)
    return CoarseGraph(
        part=part,
        place=place,
        member_start=member_start,
        member=member,
        edge_start=np.searchsorted(ends[order, 0], every).astype(np.int32),
        edge_target=ends[order, 1].astype(np.int32),
        edge_length=_rounded_up(np.concatenate([length, length])[order]),
        leap_start=np.searchsorted(first, every).astype(np.int32),
        leap_target=(first + len(index)).astype(np.int32),
        leap_cost=np.maximum(links.cost[index], np.linalg.norm(landing - run_up, axis=1)),
        leap_from=leap_ends[:, 0].astype(np.int32),
        leap_to=leap_ends[:, 1].astype(np.int32),
        leap_kind=links.affordance[index],
        leap_height=links.height[index],
    ), region


def _rounded_up(lengths: np.ndarray) -> np.ndarray:
    """As float32, never less."""
    short = lengths.astype(np.float32)
    return np.where(short < lengths, np.nextafter(short, np.float32(np.inf)), short)


def _settled(graph: "NodeGraph", place: np.ndarray, radius: float, threads: int) -> np.ndarray:
    """Each of ``place`` (n, 3) moved to where the body fits."""
    routes = graph.find_paths(place, place, radius, workers=threads)
    there = np.diff(routes.waypoint_start) > 0
    settled = place.copy()
    settled[there] = routes.waypoints[routes.waypoint_start[:-1][there]]
    return settled


def _lengths(graph: "NodeGraph", one: Any, other: Any, radius: float, threads: int) -> np.ndarray:
    """Lengths (p,) [m] of the routes from ``one`` (p, 3) to the ``other`` (p, 3), which are in one region;
    never less than the straight line."""
    straight = np.linalg.norm(one - other, axis=1)
    found = np.empty(len(one))
    for at in range(0, len(one), _BATCH):
        some = slice(at, at + _BATCH)
        routes = graph.find_paths(one[some], other[some], radius, workers=threads)
        found[some] = np.where(routes.status == "complete", routes.length, 0.0)
    return np.maximum(found, straight)
