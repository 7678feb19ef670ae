"""The portals of the graph for one body radius: where the way from one disc to the next is crossed.

A portal lies on the chord of the lens in which two discs, shrunk by the body's radius, overlap. Where the lens is
much narrower than the passage in the clearance field, or the shrunk discs do not overlap at all, it is as wide as
the field allows: the line of the chord is walked from its middle to both sides until the body no longer fits.
"""

from math import sqrt

import numpy as np
from numba import njit

from navmesh.field import cell_at, gap_at, walk

__all__ = ["open_portals"]

_NARROW = 0.5
"""Share of the passage in the field below which a lens gives way to it."""


@njit(cache=True)
def _side(net, k, mx, my, ux, uy, reach, radius):
    """How far a body of ``radius`` gets from m, in cell ``k``, along the unit vector u, at most ``reach`` [m]."""
    reached, cell, gap, place, _, _ = walk(net, k, mx, my, mx + ux * reach, my + uy * reach, radius, False)
    if reached:
        return reach
    far = place * reach
    near = max(far - 1.5 * net.cell, 0.0)
    for _ in range(8):
        middle = 0.5 * (near + far)
        if gap_at(net, cell, mx + ux * middle, my + uy * middle)[0] >= radius:
            near = middle
        else:
            far = middle
    return near


@njit(cache=True)
def open_portals(net, edge_width, edge_cells, radius):
    """The portals for a body of ``radius`` [m].

    edge_width (e,) float64 and edge_cells (e, 2) int32: each edge's widest body and the pair of cells, one of
    either node, where its label boundary is widest. Returns (open (e,) uint8, left (e, 3), left_cell (e,), right
    (e, 3), right_cell (e,)); left and right are as seen walking along the edge.
    """
    count = net.edge_target.size
    is_open = np.zeros(count, np.uint8)
    left = np.zeros((count, 3))
    right = np.zeros((count, 3))
    left_cell = np.full(count, -1, np.int32)
    right_cell = np.full(count, -1, np.int32)
    h = net.cell
    for i in range(net.node_radius.size):
        for edge in range(net.edge_start[i], net.edge_start[i + 1]):
            if edge_width[edge] < radius:
                continue
            j = net.edge_target[edge]
            dx = net.position[j, 0] - net.position[i, 0]
            dy = net.position[j, 1] - net.position[i, 1]
            d = sqrt(dx * dx + dy * dy)
            if d < 1e-9:
                continue
            is_open[edge] = 1
            nx, ny = -dy / d, dx / d
            ri = net.node_radius[i] - radius
            rj = net.node_radius[j] - radius
            a = edge_cells[edge, 0]
            b = edge_cells[edge, 1]
            half = 0.0
            k = -1
            mx = my = 0.0
            if ri > 0.0 and rj > 0.0 and ri + rj > d:
                along = 0.5 * (d * d + ri * ri - rj * rj) / d
                half = sqrt(max(ri * ri - along * along, 0.0))
                mx = net.position[i, 0] + along * dx / d
                my = net.position[i, 1] + along * dy / d
                z = net.position[i, 2] + along / d * (net.position[j, 2] - net.position[i, 2])
                k = cell_at(net, mx, my, z)
            if k < 0 or half <= 0.0:
                # the discs do not meet: the passage is where the label boundary is widest
                half = 0.0
                k = a if net.clearance[a] > net.clearance[b] else b
                column = net.cell_column[k]
                ix = column // net.ny
                mx = (ix + 0.5) * h
                my = (column - ix * net.ny + 0.5) * h
            reach = max(net.node_radius[i], net.node_radius[j])
            to_left = _side(net, k, mx, my, nx, ny, reach, radius)
            to_right = _side(net, k, mx, my, -nx, -ny, reach, radius)
            if 2.0 * half >= _NARROW * (to_left + to_right):
                to_left = half
                to_right = half
            for side in range(2):
                way = to_left if side == 0 else -to_right
                x = mx + nx * way
                y = my + ny * way
                cell = walk(net, k, mx, my, x, y, 0.0, True)[1]
                z = net.height[cell]
                if side == 0:
                    left[edge, 0], left[edge, 1], left[edge, 2] = x, y, z
                    left_cell[edge] = cell
                else:
                    right[edge, 0], right[edge, 1], right[edge, 2] = x, y, z
                    right_cell[edge] = cell
    return is_open, left, left_cell, right, right_cell
