"""Blocking and opening a zone: what the surface and the discs are like is put in place, cell by cell.

What a cell says - the nearest place where walking ends, how wide it is there, its disc - follows from which
zones are blocked now, not from what was blocked before. Only cells near the zone are looked at.
"""

import numpy as np
from numba import float64, int32

from surefoot.kernels import allocating_kernel, kernel
from surefoot.kernels.bundles import BundleType

__all__ = ["SWITCHES", "turn", "turn_all"]

SWITCHES = BundleType(
    blocked=int32[::1],
    cell_start=int32[::1],
    cell_row=int32[::1],
    row_cell=int32[::1],
    row_nearest=float64[:, ::1],
    row_label=int32[::1],
    near_start=int32[::1],
    near_zone=int32[::1],
    near=float64[:, ::1],
    own_start=int32[::1],
    own_view=int32[::1],
    own_label=int32[::1],
    cut_start=int32[::1],
    cut_link=int32[::1],
    cut=int32[:, ::1],
    cut_count=int32[::1],
    side_start=int32[::1],
    side_row=int32[::1],
    side=float64[:, ::1],
    view_start=int32[::1],
    zone_view=int32[::1],
    view_missing=int32[::1],
    view_node=int32[::1],
    node_size=float64[::1],
    all_link=int32[:, ::1],
    all_clearance=float64[::1],
    all_nearest=float64[:, ::1],
    all_label=int32[::1],
    all_blocker=float64[:, ::1],
    all_radius=float64[::1],
)
"""All that zones change, and how.

blocked (z,): 1 or 0. A *row* is a cell near a zone; those of zone i are cell_row[cell_start[i]:cell_start[i +
1]]. Of each: row_cell, row_nearest (2) [m]: the vector to where walking ends if all zones near it are open;
row_label: its node if all are blocked; near_zone, near (2), grouped by near_start: the zones near it and the
vectors to them; own_view, own_label, grouped by own_start: other nodes that it can have, and the view that
has them. A *view* is what one or two zones add when they are open: those of zone i are
zone_view[view_start[i]:view_start[i + 1]]; view_missing: how many of its zones are blocked; its nodes are
view_node[v]:view_node[v + 1]. cut_link, grouped by zone: the links that it cuts, as rows of cut (cell,
direction, cell that it leads to); cut_count: how many blocked zones cut each. side_row, grouped by zone: the
rows of the blockers that are its outline, and side (4): what they are if it is blocked. node_size (m,) [m]:
radii of all nodes. all_...: the arrays of the surface and the graph that are kept up to date.
"""

_OPEN = np.nan  # what a blocker is that is not there: nearer than nothing, crossed by nothing


@kernel(error_model="numpy")
def turn(switches, net, zone, blocked):
    """Block (1) a zone or open (0) it."""
    if switches.blocked[zone] == blocked:
        return
    switches.blocked[zone] = blocked
    by = 1 if blocked == 1 else -1
    for i in range(switches.view_start[zone], switches.view_start[zone + 1]):
        view = switches.zone_view[i]
        switches.view_missing[view] += by
        for node in range(switches.view_node[view], switches.view_node[view + 1]):
            radius = switches.node_size[node] if switches.view_missing[view] == 0 else -1.0
            switches.all_radius[node] = radius
            net.node_radius[node] = radius
    for i in range(switches.cut_start[zone], switches.cut_start[zone + 1]):
        at = switches.cut_link[i]
        switches.cut_count[at] += by
        cell, way = switches.cut[at, 0], switches.cut[at, 1]
        to = np.int32(-1) if switches.cut_count[at] > 0 else switches.cut[at, 2]
        switches.all_link[cell, way] = to
        net.link[cell, way] = to
    for i in range(switches.side_start[zone], switches.side_start[zone + 1]):
        row = switches.side_row[i]
        for j in range(4):
            switches.all_blocker[row, j] = switches.side[i, j] if blocked == 1 else _OPEN
    for i in range(switches.cell_start[zone], switches.cell_start[zone + 1]):
        _settle(switches, net, switches.cell_row[i])


@kernel(error_model="numpy", inline="always")
def _settle(switches, net, row):
    """Put in place what a cell says now. Its node is the widest of those that are there."""
    x, y = switches.row_nearest[row, 0], switches.row_nearest[row, 1]
    square = x * x + y * y
    for i in range(switches.near_start[row], switches.near_start[row + 1]):
        if switches.blocked[switches.near_zone[i]] == 1:
            dx, dy = switches.near[i, 0], switches.near[i, 1]
            if dx * dx + dy * dy < square:
                x, y, square = dx, dy, dx * dx + dy * dy
    clearance = np.sqrt(square)
    label = switches.row_label[row]
    size = switches.node_size[label] if label >= 0 else -1.0
    for i in range(switches.own_start[row], switches.own_start[row + 1]):
        other = switches.own_label[i]
        if switches.view_missing[switches.own_view[i]] == 0 and switches.node_size[other] > size:
            label, size = other, switches.node_size[other]
    if label >= 0:
        clearance = min(clearance, size)  # a node lets pass whatever its cells let pass
    cell = switches.row_cell[row]
    switches.all_nearest[cell, 0], switches.all_nearest[cell, 1] = x, y
    switches.all_clearance[cell] = clearance
    switches.all_label[cell] = label
    net.clearance[cell] = clearance
    net.label[cell] = label


@allocating_kernel(error_model="numpy")
def turn_all(switches, net, zones, blocked):
    """`turn` each of ``zones`` (k,) to ``blocked`` (k,)."""
    for i in range(zones.size):
        turn(switches, net, zones[i], blocked[i])
