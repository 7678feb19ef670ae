"""The corridor of a route: discs, shrunk by the body's radius, that the pulled path runs through one after
another.

Where the path runs inside a node's disc, that disc is taken. Where no node's disc fits it, as along a wall or
round a corner, the path gets a disc of its own: from the path away from the wall, as large as the clearance
there allows, with the path just inside its rim. Any two discs that follow each other overlap on the path.
"""

from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from navmesh.graph.kernel_arrays import net_of
from navmesh.surface.clearance_field import cell_at, floor_at, gap_at, walk
from surefoot.kernels import allocating_kernel, kernel

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["Corridor", "corridor_of"]

_STRIDE = 0.1
"""[m]: a disc must take the path on by at least this, if any can."""
_LEAST = 1e-3
"""[m]: the least disc; where the body only just fits, such discs follow each other along the path."""
_LONG = 0.6
"""[m]: a node's disc that takes the path on by this is taken without trying an own disc."""


@dataclass(frozen=True, slots=True, eq=False)
class Corridor:
    """Discs in path order; a body's centre may be anywhere in them."""

    centers: np.ndarray
    """(m, 3) float64 [m], world coordinates."""
    radii: np.ndarray
    """(m,) float64 [m]: already shrunk by the body's radius."""


@kernel
def _at(path, along, s, segment):
    """The point at arc length ``s`` of the path, searched from ``segment`` on; returns (x, y, segment)."""
    last = path.shape[0] - 2
    while segment < last and along[segment + 1] <= s:
        segment += 1
    length = along[segment + 1] - along[segment]
    t = (s - along[segment]) / length if length > 0.0 else 0.0
    t = min(max(t, 0.0), 1.0)
    return (
        path[segment, 0] + t * (path[segment + 1, 0] - path[segment, 0]),
        path[segment, 1] + t * (path[segment + 1, 1] - path[segment, 1]),
        segment,
    )


@kernel
def _leaves(path, along, s, segment, x, y, cx, cy, radius):
    """Arc length at which the path, at (x, y) for ``s``, leaves the disc; -1 when it is not in it there."""
    if (x - cx) ** 2 + (y - cy) ** 2 > radius * radius * (1.0 + 1e-12) + 1e-18:
        return -1.0
    ax, ay, start = x, y, s
    while True:
        bx, by = path[segment + 1, 0], path[segment + 1, 1]
        if (bx - cx) ** 2 + (by - cy) ** 2 > radius * radius:
            dx, dy = bx - ax, by - ay
            length = dx * dx + dy * dy
            if length == 0.0:
                return start
            half = (ax - cx) * dx + (ay - cy) * dy
            inside = (ax - cx) ** 2 + (ay - cy) ** 2 - radius * radius
            root = half * half - length * inside
            t = (-half + sqrt(root)) / length if root > 0.0 else 0.0
            return start + min(max(t, 0.0), 1.0) * sqrt(length)
        segment += 1
        start = along[segment]
        ax, ay = bx, by
        if segment >= path.shape[0] - 1:
            return start


@kernel
def _own_disc(net, k, x, y, radius, path, along, s, segment, px, py):
    """The disc away from the wall at (x, y), in cell ``k``, that takes the path furthest from p at ``s``."""
    gap, qx, qy = gap_at(net, k, x, y)
    best_x, best_y, best_r, best_cell = x, y, max(gap - radius, 0.0), k
    best = _leaves(path, along, s, segment, px, py, x, y, best_r)
    if gap <= 1e-6 or gap == np.inf:
        return best, best_x, best_y, best_r, best_cell
    ux, uy = (x - qx) / gap, (y - qy) / gap
    away = 0.05
    while away < 4.0:
        cx, cy = x + away * ux, y + away * uy
        reached, cell = walk(net, k, x, y, cx, cy, radius, False)[:2]
        if not reached:
            break
        size = gap_at(net, cell, cx, cy)[0] - radius
        exit_ = _leaves(path, along, s, segment, px, py, cx, cy, size)
        if exit_ > best:
            best, best_x, best_y, best_r, best_cell = exit_, cx, cy, size, cell
        if size < 0.7 * away:
            break
        away *= 1.5
    return best, best_x, best_y, best_r, best_cell


@allocating_kernel
def cover(net, path, start_cell, radius):
    """Discs (m, 4) float64: x, y, z, shrunk radius, that cover ``path`` (k, 3) in order; all relative to the
    origin."""
    count = path.shape[0]
    along = np.zeros(count)
    for i in range(1, count):
        along[i] = along[i - 1] + sqrt(
            (path[i, 0] - path[i - 1, 0]) ** 2 + (path[i, 1] - path[i - 1, 1]) ** 2
        )
    total = along[count - 1]
    discs = np.empty((16, 4))
    size = 0
    s = 0.0
    x, y = path[0, 0], path[0, 1]
    segment = 0
    k = start_cell
    while True:
        best = -1.0
        bx = by = bz = br = 0.0
        node = net.label[k]
        if node >= 0:
            first, last = net.edge_start[node], net.edge_start[node + 1]
            for i in range(first - 1, last):
                other = node if i < first else net.edge_target[i]
                shrunk = net.node_radius[other] - radius
                if shrunk <= 0.0:
                    continue
                nx, ny = net.position[other, 0], net.position[other, 1]
                exit_ = _leaves(path, along, s, segment, x, y, nx, ny, shrunk)
                if exit_ > best:
                    best, bx, by, bz, br = exit_, nx, ny, net.position[other, 2], shrunk
        if best < min(s + _LONG, total):
            ahead = s
            for _ in range(4):
                ax, ay, _ = _at(path, along, min(ahead, total), segment)
                cell = _follow(net, path, along, k, x, y, s, segment, min(ahead, total))
                exit_, cx, cy, cr, owner = _own_disc(net, cell, ax, ay, radius, path, along, s, segment, x, y)
                if exit_ > best + _STRIDE or best < 0.0:
                    best, bx, by, br = exit_, cx, cy, cr
                    bz = floor_at(net, owner, cx, cy)
                ahead += _STRIDE
        if best < min(s + _LEAST, total):
            best, bx, by, br = min(s + _LEAST, total), x, y, _LEAST
            bz = floor_at(net, k, x, y)
        if size == discs.shape[0]:
            more = np.empty((2 * size, 4))
            more[:size] = discs
            discs = more
        discs[size, 0], discs[size, 1], discs[size, 2], discs[size, 3] = bx, by, bz, br
        size += 1
        if best >= total - 1e-9:
            return discs[:size].copy()
        k = _follow(net, path, along, k, x, y, s, segment, best)
        s = best
        x, y, segment = _at(path, along, s, segment)


@kernel
def _follow(net, path, along, k, x, y, s, segment, target):
    """The cell under the path at arc length ``target``, from cell ``k`` under (x, y) at ``s``."""
    last = path.shape[0] - 2
    while segment < last and along[segment + 1] <= target:
        bx, by = path[segment + 1, 0], path[segment + 1, 1]
        k = walk(net, k, x, y, bx, by, 0.0, True)[1]
        x, y = bx, by
        segment += 1
    bx, by, _ = _at(path, along, target, segment)
    return walk(net, k, x, y, bx, by, 0.0, True)[1]


@allocating_kernel
def _cover_from(net, path, radius):
    return cover(net, path, cell_at(net, path[0, 0], path[0, 1], path[0, 2]), radius)


def corridor_of(graph: "NodeGraph", waypoints: np.ndarray, radius: float) -> Corridor:
    """The corridor of a walked path ``waypoints`` (k, 3) [m] for a body of ``radius`` [m]."""
    origin = graph.surface.origin
    local = np.ascontiguousarray(waypoints - origin)
    if len(local) == 1:
        local = np.concatenate([local, local])
    discs = _cover_from(net_of(graph), local, radius)
    return Corridor(discs[:, :3] + origin, discs[:, 3].copy())
