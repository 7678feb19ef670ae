"""The place for a body nearest to a point: where a route begins and where it ends.

A place is a point of the surface with the body's radius clear around it. It is looked for cell by cell, from
the point outwards: in each cell's square the nearest point that is clear, on the same side of everything that
ends walking as the cell's centre.
"""

from math import sqrt

import numpy as np

from navmesh.surface.clearance_field import centre_of, floor_at, gap_at, same_place, walk
from navmesh.surface.columns import column_of
from navmesh.surface.storeys import linked
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["CANDIDATES", "candidate", "node_at", "place_in", "roomy_cell", "snap", "squared_distance"]

_MARGIN = 0.015  # share of the radius: a little more than what string pulling keeps
_THIN = 1e-3  # [m] radius of a line that only must not cross anything
_PUSHES = 6  # in one cell, off what is too near
_LATTICE = 5  # points a side that are tried in a cell where pushing does not lead to a clear one
_FINE = 2e-3  # [m] to which the best of these is improved


@allocating_kernel(error_model="numpy")
def roomy_cell(net, k, x, y, radius, reach):
    """The cell nearest to (x, y), reached over links from ``k`` within ``reach``, whose centre has ``radius``
    free, or -1."""
    h = net.cell
    rings = int(min(reach / h, max(net.nx, net.ny))) + 1
    side = 2 * rings + 1
    seen = np.zeros((side, side), np.uint8)
    queue = np.empty(side * side, np.int32)
    column = column_of(net, k)
    ix0, iy0 = column // net.ny - rings, column % net.ny - rings
    queue[0] = k
    seen[rings, rings] = 1
    size = 1
    head = 0
    best = -1
    least = reach * reach
    while head < size:
        at = queue[head]
        head += 1
        column = column_of(net, at)
        ix = column // net.ny
        iy = column - ix * net.ny
        dx = (ix + 0.5) * h - x
        dy = (iy + 0.5) * h - y
        off = dx * dx + dy * dy
        if off < least and net.clearance[at] >= radius and net.label[at] >= 0:
            least = off
            best = at
        for way in range(4):
            other = linked(net, at, way)
            if other < 0:
                continue
            column = column_of(net, other)
            jx, jy = column // net.ny - ix0, column % net.ny - iy0
            if 0 <= jx < side and 0 <= jy < side and not seen[jx, jy]:
                seen[jx, jy] = 1
                queue[size] = other
                size += 1
    return best


@kernel(error_model="numpy")
def node_at(net, k, x, y, radius):
    """The node that a body at (x, y) in cell ``k`` starts from: that of the cell, or of a cell beside it that
    the body can go straight to the centre of, or of the node itself; -1 where there is none."""
    if net.clearance[k] >= radius and net.label[k] >= 0:
        return net.label[k]
    best = -1
    least = 1e300
    for way in range(4):
        beside = linked(net, k, way)
        if beside < 0:
            continue
        for turn in range(3):  # the cell beside, and those beside that one to the left and to the right
            other = beside if turn == 0 else linked(net, beside, (way + 2 * turn - 1) % 4)
            if other < 0 or net.clearance[other] < radius or net.label[other] < 0:
                continue
            cx, cy = centre_of(net, other)
            off = (cx - x) * (cx - x) + (cy - y) * (cy - y)
            if off < least:
                reached, end = walk(net, k, x, y, cx, cy, 0.999 * radius, False)[:2]
                if reached and same_place(net, end, other):
                    least = off
                    best = net.label[other]
    node = net.label[k]
    if best < 0 and node >= 0 and net.node_radius[node] >= radius:  # in a passage too narrow for the centres
        px, py = net.position[node, 0], net.position[node, 1]
        if walk(net, k, x, y, px, py, 0.999 * radius, False)[0]:
            best = node
    return best


CANDIDATES = 13
"""How many nodes `candidate` has to be asked for."""


@kernel(error_model="numpy", forceinline=True)
def candidate(net, k, radius, i):
    """The ``i``-th of the nodes that `node_at` can give for a place in cell ``k``, or -1: that of the cell,
    then those of the cells beside it."""
    node = net.label[k]
    if i == 0:
        return node if node >= 0 and max(net.clearance[k], net.node_radius[node]) >= radius else -1
    if node >= 0 and net.clearance[k] >= radius:
        return -1
    way, turn = (i - 1) // 3, (i - 1) % 3
    other = linked(net, k, way)
    if other >= 0 and turn > 0:
        other = linked(net, other, (way + 2 * turn - 1) % 4)
    return net.label[other] if other >= 0 and net.clearance[other] >= radius else -1


@kernel(error_model="numpy", forceinline=True)
def squared_distance(net, k, px, py, x, y, z, step):
    """Squared distance of the floor at p in cell ``k`` from (x, y, z); ``step`` of the height is free."""
    rise = max(abs(floor_at(net, k, px, py) - z) - step, 0.0)
    return (px - x) * (px - x) + (py - y) * (py - y) + rise * rise


@kernel(error_model="numpy")
def _clear_at(net, k, cx, cy, px, py, room):
    """Whether p, in cell ``k`` with its centre at c, has ``room`` and nothing between it and the centre."""
    if gap_at(net, k, px, py)[0] < room:
        return False
    reached, end = walk(net, k, cx, cy, px, py, _THIN, False)[:2]
    return reached and same_place(net, end, k)


@kernel(error_model="numpy")
def place_in(net, k, x, y, z, radius, step, best):
    """The clear point of cell ``k`` nearest to (x, y, z), where it is nearer than ``best`` (squared).

    Returns (squared distance, x, y), with the distance ``best`` where there is none.
    """
    cx, cy = centre_of(net, k)
    half = 0.5 * net.cell
    px = min(max(x, cx - half), cx + half)
    py = min(max(y, cy - half), cy + half)
    off = squared_distance(net, k, px, py, x, y, z, step)
    if off >= best:
        return best, px, py
    if net.clearance[k] >= radius + 0.7072 * net.cell:
        return off, px, py
    if _clear_at(net, k, cx, cy, px, py, radius):
        return off, px, py
    room = radius * (1.0 + _MARGIN)
    for _ in range(_PUSHES):
        gap, qx, qy = gap_at(net, k, px, py)
        if gap >= room * (1.0 - 1e-9):
            off = squared_distance(net, k, px, py, x, y, z, step)
            if off >= best:
                return best, px, py
            if _clear_at(net, k, cx, cy, px, py, radius):
                return off, px, py
            break
        dx, dy = px - qx, py - qy
        reached, end = walk(net, k, cx, cy, px, py, _THIN, False)[:2]
        if gap < 1e-6 or not reached or not same_place(net, end, k):
            dx, dy = cx - qx, cy - qy  # beyond what ends walking: back to where the centre is
        far = sqrt(dx * dx + dy * dy)
        if far < 1e-6:
            break
        px = min(max(qx + dx / far * room, cx - half), cx + half)
        py = min(max(qy + dy / far * room, cy - half), cy + half)
    bx, by = px, py
    found = False
    for i in range(_LATTICE):
        for j in range(_LATTICE):
            px = cx + (2.0 * i / (_LATTICE - 1) - 1.0) * half
            py = cy + (2.0 * j / (_LATTICE - 1) - 1.0) * half
            off = squared_distance(net, k, px, py, x, y, z, step)
            if off < best and _clear_at(net, k, cx, cy, px, py, radius):
                best, bx, by = off, px, py
                found = True
    side = half / (_LATTICE - 1)
    while found and side > _FINE:
        moved = False
        for i in range(-1, 2):
            for j in range(-1, 2):
                px = min(max(bx + i * side, cx - half), cx + half)
                py = min(max(by + j * side, cy - half), cy + half)
                off = squared_distance(net, k, px, py, x, y, z, step)
                if off < best and _clear_at(net, k, cx, cy, px, py, radius):
                    best, bx, by = off, px, py
                    moved = True
        if not moved:
            side *= 0.5
    return best, bx, by


@kernel(error_model="numpy")
def snap(net, x, y, z, radius, reach, rise, step):
    """The place for a body of ``radius`` nearest to (x, y, z): at most ``reach`` away horizontally and
    ``rise`` up or down; up to ``step`` of the height does not count.

    Returns (node, cell, x, y); node is -1 where there is no such place.
    """
    h = net.cell
    ix, iy = int(x // h), int(y // h)
    node, cell, bx, by = -1, -1, x, y
    if 0 <= ix < net.nx and 0 <= iy < net.ny:
        least = step
        column = ix * net.ny + iy
        for k in range(net.column_start[column], net.column_start[column + 1]):
            off = abs(floor_at(net, k, x, y) - z)
            if off <= least and net.label[k] >= 0 and net.clearance[k] >= radius + 0.7072 * h:
                least = off
                cell = k
        if cell >= 0:
            return net.label[cell], cell, x, y
    best = reach * reach + rise * rise
    rings = int(min(reach / h, 2.0 * max(net.nx, net.ny))) + 1
    for ring in range(rings + 1):
        if ring > 1 and (ring - 1) * h * ((ring - 1) * h) >= best:
            break
        for jx in range(max(ix - ring, 0), min(ix + ring + 1, net.nx)):
            edge = jx == ix - ring or jx == ix + ring
            for jy in range(max(iy - ring, 0), min(iy + ring + 1, net.ny)):
                if not edge and jy != iy - ring and jy != iy + ring:
                    continue
                column = jx * net.ny + jy
                for k in range(net.column_start[column], net.column_start[column + 1]):
                    if net.clearance[k] < radius - 0.7072 * h:
                        continue
                    off, px, py = place_in(net, k, x, y, z, radius, step, best)
                    if off >= best or (px - x) * (px - x) + (py - y) * (py - y) > reach * reach:
                        continue
                    if abs(floor_at(net, k, px, py) - z) > rise:
                        continue
                    other = node_at(net, k, px, py, radius)
                    if other >= 0:
                        best, node, cell, bx, by = off, other, k, px, py
    return node, cell, bx, by
