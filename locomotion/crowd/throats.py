"""Throats: cells where a passage is narrow, since their nearest walls lie on opposite sides of it.

On a graph that `navmesh.NodeGraph.update` has made, only cells in and beside what has changed are looked at
again; those of the graph before are carried over.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

import navmesh
from navmesh.graph.carrying import Earlier, earlier_of
from navmesh.graph.kernel_arrays import net_of
from navmesh.recent import recent
from navmesh.surface.columns import find_column
from navmesh.surface.recall import nearest_of, nearly_nearest_of
from navmesh.surface.storeys import linked
from surefoot.kernels import kernel

__all__ = ["all_throats", "throats_of"]

_OPPOSITE = -0.5
"""Cosine of the angle from which two walls are on opposite sides."""
_ROUNDING = 1e-6
"""By which cosines of nearly the nearest places may be wrong."""
_BESIDE = 2
"""Columns around a change that are looked at again: throats may be others than before in the first column
beside it, and the links that make them so begin in the second at most."""


def throats_of(graph: navmesh.NodeGraph, limit: float) -> NDArray[np.int64]:
    """(t,) int64, rising: the throats narrower than ``limit`` [m] from the middle to the wall. With zones,
    which change the surface, they are found anew each time."""
    if graph.zone_state is not None:
        return all_throats(net_of(graph), limit)

    def make() -> tuple[NDArray[np.int64]]:
        earlier = earlier_of(graph, "throats", limit)
        net = net_of(graph)
        return (all_throats(net, limit) if earlier is None else _renewed(net, limit, earlier),)

    return recent(graph.cache, "throats", limit, make)[0]


def all_throats(net: Any, limit: float) -> NDArray[np.int64]:
    """As `throats_of`, found in all cells of the `NET` of a graph."""
    found = np.zeros(len(net.clearance), np.bool_)
    _mark(net, limit, 0, len(found), found)
    return np.flatnonzero(found)


def _renewed(net: Any, limit: float, earlier: Earlier) -> NDArray[np.int64]:
    found = np.zeros(len(net.clearance), np.bool_)
    windows = np.array(earlier.changes.windows, np.int64).reshape(-1, 4)
    _carry(net, windows, earlier.known[0], earlier.column_start, earlier.milestone, found)
    _mark_windows(net, limit, windows, found)
    return np.flatnonzero(found)


@kernel(error_model="numpy", forceinline=True)
def _cosine(net, ax, ay, a, bx, by, b):
    """Between the directions of the places (ax, ay) and (bx, by) as seen from the cells a and b."""
    near, other = max(net.clearance[a], 1e-9), max(net.clearance[b], 1e-9)
    return ax / near * (bx / other) + ay / near * (by / other)


@kernel(error_model="numpy", nogil=True)
def _mark(net, limit, first, last, found):
    """Mark in ``found`` (cells,) bool the throats narrower than ``limit`` [m] from the middle to the wall
    among the cells ``first`` to ``last`` and those beside them in +x and +y."""
    for c in range(first, last):
        if not net.clearance[c] < limit:
            continue
        x, y = nearly_nearest_of(net, c)
        for way in range(2):
            n = linked(net, c, way)
            if n < 0 or not net.clearance[n] < limit or (found[c] and found[n]):
                continue
            if net.source[c] == net.source[n] and min(net.clearance[c], net.clearance[n]) >= 2.0 * net.cell:
                continue  # both look to the same place
            px, py = nearly_nearest_of(net, n)
            if _cosine(net, x, y, c, px, py, n) >= _OPPOSITE + _ROUNDING:
                continue
            ax, ay = nearest_of(net, c)
            bx, by = nearest_of(net, n)
            if _cosine(net, ax, ay, c, bx, by, n) < _OPPOSITE:
                found[c] = found[n] = True


@kernel(error_model="numpy", nogil=True)
def _mark_windows(net, limit, windows, found):
    """Mark all throats in ``windows`` (w, 4) of columns and in those beside them."""
    for w in range(windows.shape[0]):
        near, far = max(windows[w, 1] - _BESIDE, 0), min(windows[w, 3] + _BESIDE, net.ny)
        for ix in range(max(windows[w, 0] - _BESIDE, 0), min(windows[w, 2] + _BESIDE, net.nx)):
            first, last = net.column_start[ix * net.ny + near], net.column_start[ix * net.ny + far]
            _mark(net, limit, first, last, found)


@kernel(error_model="numpy", nogil=True)
def _carry(net, windows, before, old_column_start, old_milestone, found):
    """Mark the throats of ``before`` (t,) that do not lie in ``windows`` or just beside them."""
    for t in range(before.shape[0]):
        column = find_column(old_column_start, old_milestone, before[t])
        ix, iy = column // net.ny, column % net.ny
        apart = True
        for w in range(windows.shape[0]):
            across = windows[w, 0] - 1 <= ix <= windows[w, 2]
            apart &= not (across and windows[w, 1] - 1 <= iy <= windows[w, 3])
        if apart:
            found[before[t] - old_column_start[column] + net.column_start[column]] = True
