"""Gates: passages where fewer than three bodies fit side by side, found in the clearance field.

Connected throats (`locomotion.crowd.throats`), with all cells covered by their discs, form one gate; whoever
uses the passage crosses its discs. Doors and long corridors are gates.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

import navmesh
from locomotion.crowd.throats import throats_of
from navmesh.disjoint_sets import root
from navmesh.graph.kernel_arrays import net_of
from navmesh.routes.heap import push, take_first
from navmesh.surface.clearance_field import centre_of
from navmesh.surface.columns import column_of
from navmesh.surface.recall import nearest_of
from navmesh.surface.storeys import linked, over
from navmesh.surface.surface import Surface
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["ABREAST", "Gates", "find_gates", "foresee_gates"]

ABREAST = 3.25
"""A passage is a gate for a body if half its width is less than this many of the body's radii."""


class Gates(NamedTuple):
    """The gates of a surface."""

    row: NDArray[np.int32]
    """(cells,) where in the arrays by ``covered`` a cell is, or -1 for cells of no gate."""
    gate: NDArray[np.int32]
    """(covered,) the gate that a cell belongs to."""
    along: NDArray[np.float64]
    """(covered,) [m] distance from one end of its gate."""
    axis: NDArray[np.float64]
    """(covered, 2) unit vector along the passage, with a consistent sense within a short gate."""
    width: NDArray[np.float64]
    """(gates,) [m] half the least width."""


@kernel(error_model="numpy", forceinline=True)
def _cover(c, t, part, row, by, seen, parent, covered):
    """Note that cell ``c`` is under the disc of throat ``t``: (whether that is new, cells covered by now)."""
    at = row[c]
    if at < 0:
        row[c], by[covered], seen[covered] = covered, t, t
        return True, covered + 1
    if seen[at] == t:
        return False, covered
    seen[at] = t
    if part[by[at]] != part[t]:
        one, other = root(parent, part[by[at]]), root(parent, part[t])
        parent[max(one, other)] = min(one, other)
    return True, covered


@allocating_kernel(error_model="numpy", nogil=True)
def _paint(net, throats, part, row, parent):
    """Give the cells under the discs of ``throats`` to these, first come first served: ``row`` (cells,) is
    filled in, and the throat of each covered cell is returned. Where discs of two parts overlap, the parts
    are joined: ``parent`` of each becomes the first of those that it is joined with."""
    by, seen = np.empty(row.size, np.int32), np.empty(row.size, np.int32)
    queue = np.empty((row.size, 3), np.int64)  # cell and its column in x and y; most of it is never touched
    covered = 0
    for t in range(throats.size):
        x, y = centre_of(net, throats[t])
        reach = net.clearance[throats[t]] + 0.5 * net.cell
        column = column_of(net, throats[t])
        queue[0, 0], queue[0, 1], queue[0, 2] = throats[t], column // net.ny, column % net.ny
        size, head = 1, 0
        covered = _cover(throats[t], t, part, row, by, seen, parent, covered)[1]
        while head < size:
            c, ix, iy = queue[head, 0], queue[head, 1], queue[head, 2]
            head += 1
            for way in range(4):
                jx, jy = ix + (way == 0) - (way == 2), iy + (way == 1) - (way == 3)
                px, py = (jx + 0.5) * net.cell, (jy + 0.5) * net.cell
                if (px - x) * (px - x) + (py - y) * (py - y) > reach * reach:
                    continue
                other = over(net, c, ix * net.ny + iy, way)
                if other < 0:
                    continue
                new, covered = _cover(other, t, part, row, by, seen, parent, covered)
                if new:
                    queue[size, 0], queue[size, 1], queue[size, 2] = other, jx, jy
                    size += 1
    for p in range(parent.size):
        parent[p] = root(parent, p)
    return by[:covered].copy()


@allocating_kernel(error_model="numpy", nogil=True)
def _passages(net, throats):
    """(t, 2) unit vectors along the passages at ``throats``: across the way to the nearest wall."""
    passage = np.empty((throats.size, 2))
    for t in range(throats.size):
        x, y = nearest_of(net, throats[t])
        far = max(net.clearance[throats[t]], 1e-9)
        passage[t, 0], passage[t, 1] = -(y / far), x / far
    return passage


def _among(throats: NDArray[np.int64], cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Which of ``throats`` each of ``cells`` is, or -1."""
    at = np.minimum(np.searchsorted(throats, cells), len(throats) - 1)
    return np.where(throats[at] == cells, at, -1)


@allocating_kernel(error_model="numpy", nogil=True)
def _pairs(net, throats):
    """(k, 2) int64: which of ``throats`` are linked, straight or across a corner, each pair both ways."""
    pairs = np.empty((8 * throats.size, 2), np.int64)
    count = 0
    for t in range(throats.size):
        column = column_of(net, throats[t])
        for way in range(4):
            one = over(net, throats[t], column, way)
            if one < 0:
                continue
            for other in (one, linked(net, one, (way + 1) % 4)):
                at = np.searchsorted(throats, other)
                if at < throats.size and throats[at] == other:
                    pairs[count, 0], pairs[count, 1] = t, at
                    count += 1
    return pairs[:count].copy()


@allocating_kernel(nogil=True)
def _ways(start, target, length, sources):
    """(n,) float64 [m]: the shortest way over links in CSR form from the nearest of the ``sources``. As
    `scipy.sparse.csgraph.dijkstra` has it, which keeps the interpreter's lock for all of its time."""
    way = np.full(start.size - 1, np.inf)
    keys, items = np.empty(target.size + sources.size), np.empty(target.size + sources.size, np.int32)
    size = sources.size
    for k in range(size):
        way[sources[k]] = keys[k] = 0.0
        items[k] = sources[k]
    while size > 0:
        far, here = keys[0], items[0]
        take_first(keys, items, size)
        size -= 1
        if far > way[here]:
            continue
        for link in range(start[here], start[here + 1]):
            there = target[link]
            if far + length[link] < way[there]:
                way[there] = far + length[link]
                push(keys, items, size, way[there], there)
                size += 1
    return way


def _joined(surface: Surface, net: Any, throats: NDArray[np.int64]) -> csr_array:
    """The throats as a graph of links, straight or across a corner."""
    source, target = _pairs(net, throats).T
    centres = surface.centers(throats)
    lengths = np.linalg.norm(centres[source] - centres[target], axis=1)
    return csr_array((lengths, (source, target)), shape=(len(throats), len(throats)))


def _half_widths(surface: Surface, throats: NDArray[np.int64]) -> NDArray[np.float64]:
    """(t,) [m]: clearance of each throat or of the one across from it, whichever is nearer the middle."""
    clearance = np.append(surface.clearance[throats], 0.0)
    return np.maximum(clearance[:-1], clearance[_among(throats, surface.links(throats))].max(axis=1))


def _first_by(key: NDArray[Any], group: NDArray[Any]) -> NDArray[np.int64]:
    """For each of the groups 0, 1, …: the first of its members with the least ``key``."""
    order = np.lexsort((key, group))
    return order[np.searchsorted(group[order], np.arange(group.max() + 1))]


def find_gates(graph: navmesh.NodeGraph, limit: float) -> Gates:
    """The gates of a graph narrower than ``limit`` [m] from the middle to the wall."""
    foreseen = graph.cache.get("gates", {}).get(_kept_as(graph, limit))
    return _gates(graph, limit) if foreseen is None else foreseen


def foresee_gates(graph: navmesh.NodeGraph, limit: float) -> None:
    """Find them now; `find_gates` then takes no time, unless zones are turned before."""
    graph.cache.setdefault("gates", {})[_kept_as(graph, limit)] = find_gates(graph, limit)


def _kept_as(graph: navmesh.NodeGraph, limit: float) -> tuple[float, int]:
    return limit, 0 if graph.zone_state is None else graph.zone_state.changes


def _gates(graph: navmesh.NodeGraph, limit: float) -> Gates:
    surface, net, throats = graph.surface, net_of(graph), throats_of(graph, limit)
    row = np.full(len(surface), -1, np.int32)
    if len(throats) == 0:
        return Gates(row, np.empty(0, np.int32), np.empty(0), np.empty((0, 2)), np.empty(0))
    joined = _joined(surface, net, throats)
    count, part = connected_components(joined, directed=False)
    parent = np.arange(count, dtype=np.int32)
    by = _paint(net, throats, part, row, parent)
    gate = np.unique(parent, return_inverse=True)[1].astype(np.int32)[part]
    half = _half_widths(surface, throats)
    passage = _passages(net, throats)
    narrowest = _first_by(half, gate)
    passage[np.sum(passage * passage[narrowest[gate]], axis=1) < 0.0] *= -1.0
    # distance from the farthest end
    first = _first_by(np.zeros(len(throats)), part)
    links = joined.indptr, joined.indices, joined.data
    end = _first_by(-_ways(*links, first), part)
    way = _ways(*links, end)
    return Gates(row, gate[by], way[by], passage[by], half[narrowest])
