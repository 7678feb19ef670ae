"""Gates: passages where fewer than three bodies fit side by side, found in the clearance field.

A throat is a pair of linked cells whose nearest walls lie on opposite sides. Connected throats, with all
cells covered by their discs, form one gate; whoever uses the passage crosses its discs. Doors and long
corridors are gates.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra

from navmesh.surface.clearance_field import centre_of
from navmesh.surface.storeys import linked
from navmesh.surface.surface import Surface
from surefoot.kernels import allocating_kernel

__all__ = ["ABREAST", "Gates", "find_gates"]

ABREAST = 3.25
"""A passage is a gate for a body if half its width is less than this many of the body's radii."""
_OPPOSITE = -0.5
"""Cosine of the angle from which two walls are on opposite sides."""


class Gates(NamedTuple):
    """The gates of a surface."""

    of_cell: NDArray[np.int32]
    """(cells,) the gate that a cell belongs to, or -1."""
    along: NDArray[np.float64]
    """(cells,) [m] distance from one end of its gate."""
    width: NDArray[np.float64]
    """(gates,) [m] half the least width."""
    axis: NDArray[np.float64]
    """(cells, 2) unit vector along the passage, with a consistent sense within a short gate."""


@allocating_kernel
def _paint(net, throats, part, of_cell, by, pairs):
    """Give the cells under the discs of ``throats`` to their parts, first come first served; returns how
    many ``pairs`` of parts were found to overlap."""
    queue = np.empty(of_cell.size, np.int64)
    seen = np.full(of_cell.size, -1, np.int64)
    count = 0
    for t in range(throats.size):
        k = throats[t]
        x, y = centre_of(net, k)
        reach = net.clearance[k] + 0.5 * net.cell
        queue[0], seen[k] = k, t
        size, head = 1, 0
        while head < size:
            c = queue[head]
            head += 1
            if of_cell[c] < 0:
                of_cell[c], by[c] = part[t], t
            elif of_cell[c] != part[t] and count < pairs.shape[0]:
                pairs[count, 0], pairs[count, 1] = of_cell[c], part[t]
                count += 1
            for way in range(4):
                other = linked(net, c, way)
                if other < 0 or seen[other] == t:
                    continue
                px, py = centre_of(net, other)
                if (px - x) * (px - x) + (py - y) * (py - y) <= reach * reach:
                    seen[other] = t
                    queue[size] = other
                    size += 1
    return count


def _throats(surface: Surface, nearest: NDArray[np.float64], limit: float) -> NDArray[np.int64]:
    toward = nearest / np.maximum(surface.clearance, 1e-9)[:, None]
    narrow = surface.clearance < limit
    found = np.zeros(len(surface), dtype=bool)
    link = surface.link
    for way in range(2):
        other = link[:, way]
        between = (other >= 0) & narrow & narrow[other]
        between &= np.sum(toward * toward[other], axis=1) < _OPPOSITE
        found |= between
        found[other[between]] = True
    return np.flatnonzero(found)


def _joined(surface: Surface, throats: NDArray[np.int64]) -> coo_array:
    """The throats as a graph of links, straight or across a corner."""
    at = np.full(len(surface), -1, dtype=np.int64)
    at[throats] = np.arange(len(throats))
    source, target = [], []
    for way in range(4):
        one = surface.links(throats)[:, way]
        corner = np.where(one >= 0, surface.links(one)[:, (way + 1) % 4], -1)
        for other in (one, corner):
            hit = (other >= 0) & (at[other] >= 0)
            source.append(np.flatnonzero(hit))
            target.append(at[other[hit]])
    ends = np.concatenate(source), np.concatenate(target)
    lengths = np.linalg.norm(surface.centers(throats)[ends[0]] - surface.centers(throats)[ends[1]], axis=1)
    return coo_array((lengths, ends), shape=(len(throats), len(throats)))


def _half_widths(surface: Surface, throats: NDArray[np.int64]) -> NDArray[np.float64]:
    """(t,) [m]: clearance of each throat or of the one across from it, whichever is nearer the middle."""
    clearance = np.zeros(len(surface) + 1)
    clearance[throats] = surface.clearance[throats]
    return np.maximum(clearance[throats], clearance[surface.links(throats)].max(axis=1))


def find_gates(surface: Surface, net: object, limit: float) -> Gates:
    """The gates narrower than ``limit`` [m] from the middle to the wall."""
    nearest = surface.nearest
    throats = _throats(surface, nearest, limit)
    of_cell = np.full(len(surface), -1, dtype=np.int32)
    by = np.full(len(surface), -1, dtype=np.int64)
    along = np.zeros(len(surface))
    if len(throats) == 0:
        return Gates(of_cell, along, np.empty(0), np.zeros((len(surface), 2)))
    joined = _joined(surface, throats)
    count, part = connected_components(joined, directed=False)
    pairs = np.empty((16 * len(throats) + 1024, 2), dtype=np.int64)
    found = _paint(net, throats, part.astype(np.int32), of_cell, by, pairs)
    meeting = coo_array((np.ones(found), pairs[:found].T), shape=(count, count))
    count, whole = connected_components(meeting, directed=False)
    gate = whole[part]
    covered = of_cell >= 0
    of_cell[covered] = whole[of_cell[covered]]
    way = np.zeros(len(throats))
    width, half = np.empty(count), _half_widths(surface, throats)
    across = nearest[throats] / np.maximum(surface.clearance[throats], 1e-9)[:, None]
    axis, passage = np.zeros((len(surface), 2)), np.column_stack([-across[:, 1], across[:, 0]])
    for number in range(count):
        members = np.flatnonzero(gate == number)
        width[number] = half[members].min()
        against = passage[members] @ passage[members[np.argmin(half[members])]] < 0.0
        passage[members[against]] *= -1.0
    for number in range(part.max() + 1):  # distance from the farthest end
        members = np.flatnonzero(part == number)
        own = joined.tocsr()[members][:, members]
        end = int(np.argmax(dijkstra(own, indices=0)))
        way[members] = dijkstra(own, indices=end)
    along[covered], axis[covered] = way[by[covered]], passage[by[covered]]
    return Gates(of_cell, along, width, axis)
