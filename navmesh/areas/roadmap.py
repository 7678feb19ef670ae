"""A roadmap for area costs: stops on both sides of the borders of areas and on the portals, and roads
between.

The discs know nothing of areas. So for queries with costs every node gets *stops*: a few on each of its
portals, some along the borders of areas in it, on either side, and the ends of links. Stops of a node that
are near each other are joined by straight *roads* where the body fits; where it has to be led off the line
for the node's stops to be joined at all, the road is bent. A roadmap is made once for each radius;
`navmesh.areas.pricing` says what its roads cost.
"""

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from navmesh.areas.areas import areas_of
from navmesh.areas.kernel_arrays import BENT, STRAIGHT
from navmesh.areas.roadmap_stops import members, other_stops, portal_stops
from navmesh.disjoint_sets import root
from navmesh.graph.kernel_arrays import net_of
from navmesh.routes.string_pulling import CELLS, FITS, mend
from navmesh.surface.clearance_field import walk
from surefoot.kernels import allocating_kernel, kernel

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["Roadmap", "lead", "leg_fits", "make_roadmap", "sector_of"]

_NEIGHBOURS = 5  # in its node to which a stop has roads, in each eighth of the circle
_DETOUR = 1.15  # length of a bent road to a tight place, at most, as a share of the straight line


class Roadmap(NamedTuple):
    """Stops and roads, before they are priced."""

    place: np.ndarray
    """(s, 3) float64 [m], relative to the surface's origin."""
    cell: np.ndarray
    """(s,) int32."""
    group_start: np.ndarray
    """(m + 1,) int32: the stops of node i are group[group_start[i]:group_start[i + 1]]."""
    group: np.ndarray
    """(g,) int32."""
    road: np.ndarray
    """(r, 4) int32: two stops, the node that holds both, STRAIGHT or BENT."""
    link_stop: np.ndarray
    """(l, 2) int32: the stops at the ends of each link; -1 for links too narrow for the body."""


@kernel(error_model="numpy")
def leg_fits(net, node, k, ax, ay, bx, by, target, radius):
    """Whether a body of ``radius`` gets straight from a, in cell ``k``, to b in ``target``; both are in
    ``node``."""
    room = net.node_radius[node] - radius
    cx, cy = net.position[node, 0], net.position[node, 1]
    if room > 0.0 and max((ax - cx) ** 2 + (ay - cy) ** 2, (bx - cx) ** 2 + (by - cy) ** 2) < room * room:
        return True
    return walk(net, k, ax, ay, bx, by, radius, False)[0]


@kernel(error_model="numpy", forceinline=True)
def sector_of(dx, dy):
    """Which eighth of the circle, 0 to 7, a direction lies in."""
    return 4 * (dx > 0.0) + 2 * (dy > 0.0) + (abs(dx) > abs(dy))


@allocating_kernel(error_model="numpy")
def _mark_nearest(place, group, first, last, wanted):
    """Mark in wanted (n, n) for each stop of group[first:last] the `_NEIGHBOURS` nearest in each
    direction."""
    count = last - first
    far, which = np.empty((8, _NEIGHBOURS)), np.empty((8, _NEIGHBOURS), np.int32)
    for i in range(count):
        u = group[first + i]
        far[:] = np.inf
        for j in range(count):
            v = group[first + j]
            dx, dy = place[v, 0] - place[u, 0], place[v, 1] - place[u, 1]
            sector, square = sector_of(dx, dy), dx * dx + dy * dy
            if j == i or square >= far[sector, _NEIGHBOURS - 1]:
                continue
            at = _NEIGHBOURS - 1
            while at > 0 and far[sector, at - 1] > square:
                far[sector, at], which[sector, at] = far[sector, at - 1], which[sector, at - 1]
                at -= 1
            far[sector, at], which[sector, at] = square, j
        for sector in range(8):
            for at in range(_NEIGHBOURS):
                if far[sector, at] < np.inf:
                    j = which[sector, at]
                    wanted[i, j] = wanted[j, i] = True


@kernel(error_model="numpy")
def _nearest_apart(place, group, first, last, parent):
    """The two stops of group[first:last] nearest to each other that have different roots; -1 for none."""
    bi, bj, least = -1, -1, 1e300
    for i in range(first, last):
        for j in range(i + 1, last):
            u, v = group[i], group[j]
            far = (place[u, 0] - place[v, 0]) ** 2 + (place[u, 1] - place[v, 1]) ** 2
            if far < least and root(parent, i - first) != root(parent, j - first):
                least, bi, bj = far, i, j
    return bi, bj


@kernel(error_model="numpy")
def lead(net, doors, scratch, node, ax, ay, k, bx, by, target):
    """Lead a body from a, in cell ``k``, to b in ``target``, both in ``node``, off what is in the way.

    Returns (whether it gets there, corners in scratch.points).
    """
    scratch.points[0, 0], scratch.points[0, 1], scratch.cells[0] = ax, ay, k
    scratch.nodes[0] = node
    count, state = mend(net, doors, scratch, 0, 1, bx, by, target, 0, 1, CELLS)
    return state == FITS, count


@kernel(error_model="numpy")
def _leads_straight(net, doors, scratch, node, place, u, v, k, target):
    """Whether a body can be led from stop u, in cell ``k``, to stop v with hardly a detour."""
    fits, count = lead(
        net, doors, scratch, node, place[u, 0], place[u, 1], k, place[v, 0], place[v, 1], target
    )
    length = 0.0
    for i in range(1, count):
        dx = scratch.points[i, 0] - scratch.points[i - 1, 0]
        dy = scratch.points[i, 1] - scratch.points[i - 1, 1]
        length += np.sqrt(dx * dx + dy * dy)
    far = np.sqrt((place[u, 0] - place[v, 0]) ** 2 + (place[u, 1] - place[v, 1]) ** 2)
    return fits and length <= _DETOUR * far + 0.1


@allocating_kernel(error_model="numpy")
def _lay_roads(net, doors, scratch, place, cell, tight, group_start, group):
    """The roads: `Roadmap.road`, with those between stops of several nodes several times.

    ``tight`` (s,) bool: whether a body only just fits at a stop, so that few straight lines lead there.
    """
    room = 4096
    road = np.empty((room, 4), np.int32)
    roads = 0
    for node in range(group_start.size - 1):
        first, last = group_start[node], group_start[node + 1]
        count = last - first
        wanted = np.zeros((count, count), np.bool_)
        parent = np.arange(count)
        _mark_nearest(place, group, first, last, wanted)
        left = count - 1  # roads that are missing until all stops of the node are joined
        pair = 0
        while True:
            # first those that are near each other, then what is still apart
            kind = STRAIGHT
            if pair < count * count:
                i, j = first + pair // count, first + pair % count
                pair += 1
                if i >= j or not wanted[i - first, j - first]:
                    continue
                u, v = group[i], group[j]
                k, target = np.int64(cell[u]), np.int64(cell[v])
                if not leg_fits(
                    net, node, k, place[u, 0], place[u, 1], place[v, 0], place[v, 1], target, doors.radius
                ):
                    kind = BENT
                    if not (tight[u] or tight[v]) or not _leads_straight(
                        net, doors, scratch, node, place, u, v, k, target
                    ):
                        continue
            else:
                if left <= 0:
                    break
                i, j = _nearest_apart(place, group, first, last, parent)
                u, v = group[i], group[j]
                k, target = np.int64(cell[u]), np.int64(cell[v])
                fits, corners = lead(
                    net, doors, scratch, node, place[u, 0], place[u, 1], k, place[v, 0], place[v, 1], target
                )
                kind = STRAIGHT if corners == 2 else BENT
                if not fits:
                    kind = 0
            if root(parent, i - first) != root(parent, j - first):
                parent[root(parent, i - first)] = root(parent, j - first)
                left -= 1
            if kind == 0:
                continue
            if roads == room:
                road = np.concatenate((road, np.empty_like(road)))
                room *= 2
            road[roads, 0], road[roads, 1], road[roads, 2], road[roads, 3] = u, v, node, kind
            roads += 1
    return road[:roads].copy()


def make_roadmap(graph: "NodeGraph", doors: Any, scratch: Any) -> Roadmap:
    """The roadmap of a graph for a body, of which only the radius counts."""
    net, areas, links = net_of(graph), areas_of(graph), graph.links
    label, origin = graph.label, graph.surface.origin
    place, cell, nodes, narrow = portal_stops(net, areas, doors)
    flat, beside, own = other_stops(net, areas, doors.radius)
    place = np.concatenate([place, graph.surface.lifted(flat, beside) - origin])
    cell = np.concatenate([cell, beside])
    nodes = np.concatenate([nodes, np.column_stack([own, np.full(len(own), -1)])])
    wide = np.flatnonzero(
        (links.radius >= doors.radius) & (label[links.start_cell] >= 0) & (label[links.end_cell] >= 0)
    )
    link_stop = np.full((len(links), 2), -1, np.int32)
    link_stop[wide] = len(cell) + np.arange(2 * len(wide)).reshape(-1, 2)
    ends = np.stack([links.start[wide], links.end[wide]], axis=1).reshape(-1, 3) - origin
    end_cell = np.column_stack([links.start_cell, links.end_cell])[wide].reshape(-1)
    place = np.concatenate([place, ends])
    cell = np.concatenate([cell, end_cell]).astype(np.int32)
    nodes = np.concatenate([nodes, np.column_stack([label[end_cell], np.full(len(end_cell), -1)])])
    stop, node = members(net, doors, place, cell, nodes.astype(np.int32)).T
    order = np.lexsort((stop, node))
    group_start = np.searchsorted(node[order], np.arange(len(graph) + 1)).astype(np.int32)
    group = stop[order].astype(np.int32)
    tight = np.zeros(len(cell), bool)
    tight[: len(narrow)] = narrow
    road = _lay_roads(net, doors, scratch, place, cell, tight, group_start, group)
    _, first = np.unique(np.sort(road[:, :2], axis=1), axis=0, return_index=True)
    return Roadmap(place, cell, group_start, group, road[np.sort(first)], link_stop)
