"""What the roads of a roadmap cost, for one set of costs of areas.

Roads that others do as well are left out: those for which two cheaper ones, over a third stop of the node,
cost no more than `_AS_GOOD` times as much. And for some stops, the landmarks, it is worked out what it costs
from and to all others, by which searches know what is left (`navmesh.areas.roadmap_search`).
"""

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from navmesh.areas.areas import areas_of, dearest
from navmesh.areas.kernel_arrays import LANDMARKS, STRAIGHT, make_priced
from navmesh.areas.line_costs import price
from navmesh.areas.roadmap import Roadmap, lead, make_roadmap
from navmesh.graph.kernel_arrays import make_scratch, net_of
from navmesh.recent import recent
from surefoot.kernels import allocating_kernel, kernel

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["Priced", "price_of_lead", "priced_of"]

_AS_GOOD = 1.02


class Priced(NamedTuple):
    """A roadmap with its prices, and memory for searches over it."""

    road: Any
    """`PRICED`."""
    trips: list
    """`TRIP` each; those that no search has at the moment."""


def priced_of(graph: "NodeGraph", doors: Any, factor: np.ndarray) -> Priced:
    """The roadmap for a body and the leaps that ``doors`` offer it, priced; made once."""
    key = doors.radius, doors.leap_id.tobytes(), doors.leap_cost.tobytes(), factor.tobytes()

    def roadmap() -> Roadmap:
        return make_roadmap(graph, doors, make_scratch(graph))

    def priced() -> Any:
        road = recent(graph.cache, "roadmaps", doors.radius, roadmap)
        return Priced(_priced(graph, road, doors, factor), [])

    return recent(graph.cache, "priced", key, priced)


@kernel(error_model="numpy")
def price_of_lead(net, areas, factor, scratch, first, count):
    """What the line through the corners scratch.points[first:count] costs [m]."""
    total = 0.0
    for i in range(first + 1, count):
        total += price(
            net, areas, factor, np.int64(scratch.cells[i - 1]), scratch.points[i - 1, 0],
            scratch.points[i - 1, 1], scratch.points[i, 0], scratch.points[i, 1], np.int64(scratch.cells[i]),
            1e300,
        )  # fmt: skip
    return total


@allocating_kernel(error_model="numpy")
def _tolls(net, doors, scratch, areas, factor, place, cell, road):
    """What each of the roads costs (r,) [m], inf where it is forbidden."""
    toll = np.empty(road.shape[0])
    for i in range(road.shape[0]):
        u, v = road[i, 0], road[i, 1]
        k, target = np.int64(cell[u]), np.int64(cell[v])
        if road[i, 3] == STRAIGHT:
            toll[i] = price(
                net,
                areas,
                factor,
                k,
                place[u, 0],
                place[u, 1],
                place[v, 0],
                place[v, 1],
                target,
                1e300,
            )
            continue
        corners = lead(
            net, doors, scratch, np.int64(road[i, 2]), place[u, 0], place[u, 1], k, place[v, 0], place[v, 1],
            target,
        )[1]  # fmt: skip
        toll[i] = price_of_lead(net, areas, factor, scratch, 0, corners)
    return toll


@allocating_kernel(error_model="numpy")
def _needed(road, toll, group_start, group, stops):
    """Which roads (r,) two others cannot do as well; roads of one node are together."""
    needed = toll < np.inf
    at = np.empty(stops, np.int32)
    low = 0
    while low < road.shape[0]:
        node = road[low, 2]
        high = low
        while high < road.shape[0] and road[high, 2] == node:
            high += 1
        first, last = group_start[node], group_start[node + 1]
        count = last - first
        for i in range(count):
            at[group[first + i]] = i
        cost = np.full((count, count), np.inf)
        for i in range(low, high):
            u, v = at[road[i, 0]], at[road[i, 1]]
            cost[u, v] = cost[v, u] = toll[i]
        for i in range(low, high):
            if not needed[i]:
                continue
            u, v, most = at[road[i, 0]], at[road[i, 1]], _AS_GOOD * toll[i]
            for w in range(count):
                if cost[u, w] < toll[i] and cost[w, v] < toll[i] and cost[u, w] + cost[w, v] <= most:
                    needed[i] = False
                    break
        low = high
    return needed


def _priced(graph: "NodeGraph", roadmap: Roadmap, doors: Any, factor: np.ndarray) -> Any:
    count = len(roadmap.cell)
    areas = areas_of(graph)
    toll = _tolls(
        net_of(graph), doors, make_scratch(graph), areas, factor, roadmap.place, roadmap.cell, roadmap.road
    )
    toll = np.maximum(toll, 1e-9)
    needed = _needed(roadmap.road, toll, roadmap.group_start, roadmap.group, count)
    toll = toll[needed]
    u, v, node, kind = roadmap.road[needed].T
    leap = roadmap.link_stop[doors.leap_id]
    source = np.concatenate([u, v, leap[:, 0]])
    to = np.concatenate([v, u, leap[:, 1]])
    toll = np.concatenate([toll, toll, doors.leap_cost])
    kind = np.concatenate([kind, kind, np.arange(len(leap))])
    node = np.concatenate([node, node, graph.label[doors.leap_to_cell]])
    order = np.lexsort((to, source))
    return make_priced(
        area=areas.area,
        row=areas.row,
        part=areas.part,
        dear=dearest(areas, factor, graph.surface.link),
        factor=factor,
        least=min(float(factor.min()), 1.0 if len(leap) else np.inf),
        forbids=int(np.isinf(factor).any()),
        x=roadmap.place[:, 0],
        y=roadmap.place[:, 1],
        z=roadmap.place[:, 2],
        stop_cell=roadmap.cell,
        group_start=roadmap.group_start,
        group=roadmap.group,
        road_start=np.searchsorted(source[order], np.arange(count + 1)).astype(np.int32),
        toll=toll[order],
        to=to[order],
        kind=kind[order],
        road_node=node[order].astype(np.int32),
        landmark=_landmarks(count, source, to, toll),
    )


def _landmarks(count: int, source: np.ndarray, to: np.ndarray, toll: np.ndarray) -> np.ndarray:
    """(s, 2 * LANDMARKS) float64: what it costs from places far from each other to each stop, and back."""
    table = np.full((count, 2 * LANDMARKS), np.nan)
    if count == 0:
        return table
    there = csr_matrix((toll, (source, to)), (count, count))
    back = there.T.tocsr()
    nearest = dijkstra(there, indices=0)
    for i in range(LANDMARKS):
        far = int(np.argmax(np.where(np.isfinite(nearest), nearest, -1.0)))
        table[:, i] = dijkstra(there, indices=far)
        table[:, LANDMARKS + i] = dijkstra(back, indices=far)
        nearest = table[:, i] if i == 0 else np.minimum(nearest, table[:, i])
    table[np.isinf(table)] = np.nan
    return table
