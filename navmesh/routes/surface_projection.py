"""Points on the surface along a walked path: its corners alone say nothing about the ground between them."""

from math import ceil, sqrt
from typing import TYPE_CHECKING

import numpy as np

from navmesh.graph.kernel_arrays import net_of
from navmesh.surface.clearance_field import cell_at, floor_at, walk
from surefoot.kernels import allocating_kernel

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["project_curve_to_surface", "project_to_surface"]


@allocating_kernel
def _drape(net, path, spacing):
    count = 1
    for i in range(1, path.shape[0]):
        length = sqrt((path[i, 0] - path[i - 1, 0]) ** 2 + (path[i, 1] - path[i - 1, 1]) ** 2)
        count += max(1, ceil(length / spacing))
    points = np.empty((count, 3))
    k = cell_at(net, path[0, 0], path[0, 1], path[0, 2])
    points[0] = path[0]
    x, y = path[0, 0], path[0, 1]
    at = 1
    for i in range(1, path.shape[0]):
        ax, ay = path[i - 1, 0], path[i - 1, 1]
        bx, by = path[i, 0], path[i, 1]
        parts = max(1, ceil(sqrt((bx - ax) ** 2 + (by - ay) ** 2) / spacing))
        for j in range(1, parts + 1):
            px, py = ax + (bx - ax) * j / parts, ay + (by - ay) * j / parts
            points[at, 0], points[at, 1] = px, py
            if k >= 0:
                k = walk(net, k, x, y, px, py, 0.0, True)[1]
                points[at, 2] = floor_at(net, k, px, py)
            else:  # it begins where there is no floor
                points[at, 2] = path[i - 1, 2] + (path[i, 2] - path[i - 1, 2]) * j / parts
            x, y = px, py
            at += 1
        points[at - 1, 2] = path[i, 2]
        k = cell_at(net, bx, by, path[i, 2])
    return points


def project_to_surface(graph: "NodeGraph", waypoints: np.ndarray, spacing: float) -> np.ndarray:
    """Points (n, 3) [m] on the surface along the walked path ``waypoints`` (k, 3), at most ``spacing`` [m]
    apart.

    The corners are among them. ``spacing`` is horizontal. Behind a corner without a floor they lie straight
    between it and the next one.
    """
    origin = graph.surface.origin
    return _drape(net_of(graph), np.ascontiguousarray(waypoints - origin), spacing) + origin


@allocating_kernel
def _drape_curve(net, curve, points):
    x, y = curve[0, 0], curve[0, 1]
    k = cell_at(net, x, y, curve[0, 2])
    for i in range(1, curve.shape[0]):
        px, py = curve[i, 0], curve[i, 1]
        if k >= 0:
            k = walk(net, k, x, y, px, py, 0.0, True)[1]
            points[i, 2] = floor_at(net, k, px, py)
        else:  # there is no floor where it begins
            k = cell_at(net, px, py, curve[i, 2])
        x, y = px, py


def project_curve_to_surface(graph: "NodeGraph", curve: np.ndarray) -> np.ndarray:
    """The points (n, 3) [m] of a ``curve`` (n, 3) that is walked from its first point, on the surface; only
    the first one's height counts. Where it begins off the surface, its points keep their heights up to the
    first that is on it."""
    origin = graph.surface.origin
    points = np.ascontiguousarray(curve - origin)
    _drape_curve(net_of(graph), points.copy(), points)
    return points + origin
