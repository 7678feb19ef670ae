"""The portals of the graph for one body radius: where the way from one disc to the next is crossed.

A portal lies on the line of the chord in which two discs, shrunk by the body's radius, overlap, and reaches
to both sides as far as the body fits in the clearance field: its ends lie where the shortest line turns. The
part of it that lies in both shrunk discs, its *lens*, is kept beside: lines between lenses are free by
construction.
"""

from math import sqrt

import numpy as np

from navmesh.surface.clearance_field import centre_of, floor_at, gap_at, walk
from navmesh.surface.ridges import middle, middle_beside
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["BENDS", "BESIDE", "MARGIN", "fill_portal", "is_open_to", "open_portals"]

MARGIN = 0.04
"""Corners keep this share of the radius more than it where there is room, so that straight lines between them
clear what is round."""
BENDS = 6
"""Times that a line through a narrow gate is led off what is too near."""
_PUSHED = 1.01
"""Share of the radius that it is led off."""
BESIDE = 1.1
"""Share of the radius up to which the gap at an end says that what ends walking there bounds the portal."""


@kernel
def _side(net, k, mx, my, ux, uy, reach, radius):
    """How far a body of ``radius`` gets from m, in cell ``k``, along the unit vector u, at most ``reach``
    [m]."""
    reached, cell, _, place, _, _, _ = walk(net, k, mx, my, mx + ux * reach, my + uy * reach, radius, False)
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


@kernel
def _portal(net, i, j, pair, gate, radius):
    """The portal from node i to node j, seen from a middle point on it.

    Returns (x, y, left x, left y, cell, half the lens, to the left, to the right).
    """
    dx = net.position[j, 0] - net.position[i, 0]
    dy = net.position[j, 1] - net.position[i, 1]
    d = max(sqrt(dx * dx + dy * dy), 1e-9)
    ux, uy = dx / d, dy / d
    ri = net.node_radius[i] - radius
    rj = net.node_radius[j] - radius
    half = 0.0
    k = -1
    x = y = 0.0
    if ri > 0.0 and rj > 0.0 and ri + rj > d:
        along = 0.5 * (d * d + ri * ri - rj * rj) / d
        half = sqrt(max(ri * ri - along * along, 0.0))
        x = net.position[i, 0] + along * ux
        y = net.position[i, 1] + along * uy
        reached, k = walk(net, net.node_cell[i], net.position[i, 0], net.position[i, 1], x, y, 0.0, True)[:2]
        if not reached:
            k = -1
    if k < 0 or half <= 0.0:
        # the discs do not meet: the passage is where the border of the labels is widest
        half = 0.0
        x, y = gate[0], gate[1]
        cx, cy = centre_of(net, pair[0])
        k = walk(net, np.int64(pair[0]), cx, cy, x, y, 0.0, True)[1]
    reach = max(net.node_radius[i], net.node_radius[j])
    to_left = _side(net, k, x, y, -uy, ux, reach, radius * (1.0 + MARGIN))
    to_right = _side(net, k, x, y, uy, -ux, reach, radius * (1.0 + MARGIN))
    if to_left + to_right <= 0.0:  # the body only just fits
        to_left = max(_side(net, k, x, y, -uy, ux, reach, radius), half)
        to_right = max(_side(net, k, x, y, uy, -ux, reach, radius), half)
    return x, y, -uy, ux, k, half, to_left, to_right


@allocating_kernel(error_model="numpy")
def _gets_through(net, k, ax, ay, bx, by, radius):
    """Whether a body of ``radius`` gets from a, in cell ``k``, to b on a line that is led off what is too
    near, a few times."""
    path = np.empty((BENDS + 2, 2))
    cell = np.empty(BENDS + 2, np.int64)
    path[0, 0], path[0, 1], path[1, 0], path[1, 1] = bx, by, ax, ay
    cell[1] = k
    size = 2  # what is left to walk, the next corner last
    bends = 0
    while size > 1:
        k, x, y = cell[size - 1], path[size - 1, 0], path[size - 1, 1]
        px, py = path[size - 2, 0], path[size - 2, 1]
        _, end, gap, place, qx, qy, tight = walk(net, k, x, y, px, py, radius, True)
        if gap >= radius:
            size -= 1
            cell[size - 1] = end
            continue
        tx, ty = x + place * (px - x), y + place * (py - y)
        off = sqrt((tx - qx) ** 2 + (ty - qy) ** 2)
        if gap <= 0.0 or off < 1e-9 or bends == BENDS or not 1e-3 < place < 1.0 - 1e-3:
            return False
        bends += 1
        push = radius * _PUSHED / off
        nx, ny = qx + (tx - qx) * push, qy + (ty - qy) * push
        if gap_at(net, tight, nx, ny)[0] < radius:
            _, nx, ny, _ = middle(net, tight, tx, ty, net.cell)
        reached, at = walk(net, tight, tx, ty, nx, ny, 0.0, True)[:2]
        if not reached or gap_at(net, at, nx, ny)[0] < radius:
            return False
        path[size], cell[size] = path[size - 1], cell[size - 1]
        path[size - 1, 0], path[size - 1, 1], cell[size - 1] = nx, ny, at
        size += 1
    return True


@kernel
def is_open_to(net, i, j, width, first, second, gate, radius):
    """Whether a body of ``radius`` gets from node i through the gate to node j, where the ``width`` of the
    edge between them leaves that open; ``first``, ``second``: the cells of its border on either side."""
    if width < radius:
        return False
    x, y = net.position[i, 0], net.position[i, 1]
    px, py = net.position[j, 0], net.position[j, 1]
    lens = 0.5 * (net.node_radius[i] + net.node_radius[j] - sqrt((px - x) ** 2 + (py - y) ** 2))
    if lens >= radius or width >= radius + 0.7072 * net.cell:
        return True
    if (gate[0] == x and gate[1] == y) or (gate[0] == px and gate[1] == py):
        return True
    cx, cy = centre_of(net, first)
    k = walk(net, np.int64(first), cx, cy, gate[0], gate[1], 0.0, True)[1]
    for side in range(2):
        if side == 1:
            x, y = px, py
        if _gets_through(net, k, gate[0], gate[1], x, y, radius):
            continue
        beside, bx, by, gap = middle_beside(net, second if side == 1 else first)
        if gap < radius or not (
            _gets_through(net, k, gate[0], gate[1], bx, by, radius)
            and _gets_through(net, beside, bx, by, x, y, radius)
        ):
            return False
    return True


@kernel
def fill_portal(net, i, j, pair, gate, radius, at, portal, cells, lens, block):
    """Write the portal from node i to node j for a body of ``radius`` [m] into row ``at`` of the arrays of
    `DOORS`: ``portal`` (p, 6), portal_cell ``cells`` (p, 2), ``lens`` (p, 2) and ``block`` (p, 4)."""
    mx, my, lx, ly, k, half, to_left, to_right = _portal(net, i, j, pair, gate, radius)
    width = to_left + to_right
    free = half > 0.0 and width > 0.0
    lens[at, 0] = max((to_left - half) / width, 0.0) if free else 0.0
    lens[at, 1] = min((to_left + half) / width, 1.0) if free else 1.0
    for side in range(2):
        way = to_left if side == 0 else -to_right
        x, y = mx + lx * way, my + ly * way
        cell = walk(net, k, mx, my, x, y, 0.0, True)[1]
        portal[at, 3 * side] = x
        portal[at, 3 * side + 1] = y
        portal[at, 3 * side + 2] = floor_at(net, cell, x, y)
        cells[at, side] = cell
        gap, qx, qy = gap_at(net, cell, x, y)
        near = gap <= radius * BESIDE
        block[at, 2 * side] = qx if near else np.inf
        block[at, 2 * side + 1] = qy if near else np.inf


@allocating_kernel(nogil=True)
def open_portals(net, edge_width, edge_cells, edge_gate, radius):
    """The portals for a body of ``radius`` [m].

    edge_width (e,) float64, edge_cells (e, 2) int32 and edge_gate (e, 2) float64: each edge's widest body,
    the pair of cells, one of either node, where the border of its labels is widest, and where that body
    passes. Returns the arrays of `DOORS`: start (m + 1,), target (p,) int32, portal (p, 6) float64,
    portal_cell (p, 2) int32, lens (p, 2), block (p, 4) float64.
    """
    nodes = net.node_radius.size
    is_open = np.zeros(edge_width.size, np.bool_)
    for i in range(nodes):
        for edge in range(net.edge_start[i], net.edge_start[i + 1]):
            j = net.edge_target[edge]
            if i < j:
                is_open[edge] = is_open_to(
                    net, i, j, edge_width[edge], edge_cells[edge, 0], edge_cells[edge, 1], edge_gate[edge],
                    radius,
                )  # fmt: skip
                for back in range(net.edge_start[j], net.edge_start[j + 1]):
                    if net.edge_target[back] == i:
                        is_open[back] = is_open[edge]
    count = is_open.sum()
    start = np.zeros(nodes + 1, np.int32)
    target = np.empty(count, np.int32)
    portal = np.empty((count, 6))
    cells = np.empty((count, 2), np.int32)
    lens = np.empty((count, 2))
    block = np.empty((count, 4))
    # as parts of wider arrays, which they are where there are zones: else Numba compiles another kernel
    rows = portal[:, :], cells[:, :], lens[:, :], block[:, :]
    count = 0
    for i in range(nodes):
        for edge in range(net.edge_start[i], net.edge_start[i + 1]):
            if not is_open[edge]:
                continue
            j = net.edge_target[edge]
            target[count] = j
            fill_portal(net, i, j, edge_cells[edge], edge_gate[edge], radius, count, *rows)
            count += 1
        start[i + 1] = count
    return start, target, portal, cells, lens, block
