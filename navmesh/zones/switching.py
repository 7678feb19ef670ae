"""Blocking and opening a zone: what cells say, the discs there and the edges between them are made anew, near
the zone only.

With all zones open the graph is the undivided one. A disc that a blocked zone is in the way of is *broken*:
its cells are covered again, by *pieces*, discs of their own that claim none but its cells. Which pieces there
are follows from which zones are blocked now, not from what was blocked before.
"""

import numpy as np

from navmesh.graph.nodes import disc_at
from navmesh.surface.clearance_field import centre_of, floor_at
from navmesh.surface.storeys import APART, linked
from navmesh.zones.joining import join
from navmesh.zones.kept_pieces import keep_pieces, recall_pieces
from navmesh.zones.slots import let_go
from navmesh.zones.switches import TURNS
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["turn"]

_OPEN = np.nan  # what a blocker is that is not there: nearer than nothing, crossed by nothing


@allocating_kernel(error_model="numpy")
def turn(switches, net, zone, blocked):
    """Block (1) a zone or open (0) it. There must be room for twice as many slots more
    as the discs that it has to do with have links."""
    if switches.blocked[zone] == blocked:
        return
    switches.blocked[zone] = blocked
    switches.numbers[TURNS] += 1
    by = 1 if blocked == 1 else -1
    for i in range(switches.cut_start[zone], switches.cut_start[zone + 1]):
        at = switches.cut_link[i]
        switches.cut_count[at] += by
        cell, way = switches.cut[at, 0], switches.cut[at, 1]
        to = np.int32(APART) if switches.cut_count[at] > 0 else switches.cut[at, 2]
        switches.all_storey[cell, way] = to
    for i in range(switches.side_start[zone], switches.side_start[zone + 1]):
        row = switches.side_row[i]
        for j in range(4):
            switches.all_blocker[row, j] = switches.side[i, j] if blocked == 1 else _OPEN
    for i in range(switches.cell_start[zone], switches.cell_start[zone + 1]):
        _settle(switches, switches.cell_known[i])
    for i in range(switches.around_start[zone], switches.around_start[zone + 1]):
        switches.node_sign[switches.around[i]] ^= switches.zone_sign[zone]
    first, last = switches.user_start[zone], switches.user_start[zone + 1]
    for i in range(first, last):
        user = np.int64(switches.user[i])
        before = switches.broken[user]
        switches.broken[user] += by * switches.user_cut[i]
        if before > 0 or switches.broken[user] > 0:
            switches.turned[user] = switches.numbers[TURNS]
            _take_apart(switches, net, user)
    buckets = np.zeros(64, np.int32)
    order = np.empty(64, np.int32)
    for i in range(first, last):
        user = np.int64(switches.user[i])
        if switches.turned[user] == switches.numbers[TURNS]:
            low, high = switches.row_start[user], switches.row_start[user + 1]
            steps = np.int64(switches.whole_radius[user] / switches.grain) + 3
            if buckets.size < steps:
                buckets = np.zeros(2 * steps, np.int32)
            if order.size < high - low:
                order = np.empty(2 * (high - low), np.int32)
            _put_together(switches, net, user, buckets, order)
    join(switches, net, zone)


@kernel(error_model="numpy", forceinline=True)
def _settle(switches, known):
    """Put in place how wide it is at a cell now."""
    x, y = switches.known_nearest[known, 0], switches.known_nearest[known, 1]
    square = x * x + y * y
    changed = False
    for i in range(switches.near_start[known], switches.near_start[known + 1]):
        if switches.blocked[switches.near_zone[i]] == 1:
            dx, dy = switches.near[i, 0], switches.near[i, 1]
            if dx * dx + dy * dy < square:
                x, y, square = dx, dy, dx * dx + dy * dy
                changed = True
    cell = switches.known_cell[known]
    switches.all_nearest[cell, 0], switches.all_nearest[cell, 1] = x, y
    switches.all_clearance[cell] = np.sqrt(square) if changed else switches.known_clearance[known]


@kernel(error_model="numpy")
def _take_apart(switches, net, user):
    """Take away the pieces of a disc, and all edges of pieces that lead to it or them."""
    first = switches.row_start[user]
    let_go(switches, np.int64(switches.whole[user]))
    for i in range(first, first + switches.piece_count[user]):
        node = np.int64(switches.piece[i])
        let_go(switches, node)
        switches.all_radius[node] = -1.0
        net.node_radius[node] = -1.0
    switches.piece_count[user] = 0


@kernel(error_model="numpy")
def _put_together(switches, net, user, buckets, order):
    """Give the cells of a disc that has been taken apart to the disc or, if it is broken, to pieces: as
    `navmesh.graph.nodes.select_nodes`."""
    first, last = switches.row_start[user], switches.row_start[user + 1]
    whole = np.int64(switches.whole[user])
    row_cell, label, power = switches.row_cell, switches.all_label, switches.row_power
    clearance, grain = net.clearance, switches.grain
    if switches.broken[user] == 0:
        switches.all_radius[whole] = net.node_radius[whole] = switches.whole_radius[user]
        for row in range(first, last):
            label[row_cell[row]] = whole
        return
    switches.all_radius[whole] = net.node_radius[whole] = -1.0
    if recall_pieces(switches, net, user):
        return
    steps = np.int64(switches.whole_radius[user] / grain) + 2
    for k in range(steps + 1):
        buckets[k] = 0
    for row in range(first, last):
        cell = row_cell[row]
        label[cell], power[row] = -1, np.inf
        buckets[steps - min(np.int64(clearance[cell] / grain), steps - 1)] += 1
    for k in range(steps):
        buckets[k + 1] += buckets[k]
    for row in range(first, last):
        k = steps - 1 - min(np.int64(clearance[row_cell[row]] / grain), steps - 1)
        order[buckets[k]] = row
        buckets[k] += 1
    for i in range(last - first):
        row = np.int64(order[i])
        cell = np.int64(row_cell[row])
        if clearance[cell] <= 0.0 or label[cell] >= 0:
            continue
        k, x, y, radius = disc_at(net, cell)
        if radius < switches.least:
            continue
        node = switches.first_piece + row
        _claim(switches, net, user, node, k, x, y, radius)
        label[cell] = node
        at = first + switches.piece_count[user]
        switches.piece[at] = node
        switches.piece_count[user] += 1
        switches.all_radius[node] = net.node_radius[node] = radius
        z = floor_at(net, k, x, y)
        for axis in range(3):  # rounded as if it was made of the world's coordinates
            place = (x if axis == 0 else (y if axis == 1 else z)) + switches.origin[axis]
            switches.all_position[node, axis] = place
            net.position[node, axis] = place - switches.origin[axis]
        net.node_cell[node] = k
    keep_pieces(switches, net, user, order)


@kernel(error_model="numpy")
def _claim(switches, net, user, node, k, x, y, radius):
    """Claim, for a piece about (x, y) in cell ``k``, what lies in it of the cells of the disc."""
    cx, cy = centre_of(net, k)
    for d in range(0, 3, 2):
        step = net.cell if d == 0 else -net.cell
        spine = k if d == 0 else linked(net, k, 2)
        dx = cx - x if d == 0 else cx - x - net.cell
        while spine >= 0 and dx * dx <= radius * radius:
            _claim_line(switches, net, user, node, radius, spine, 1, dx, cy - y)
            below = linked(net, spine, 3)
            _claim_line(switches, net, user, node, radius, below, 3, dx, cy - y - net.cell)
            spine = linked(net, spine, d)
            dx += step


@kernel(error_model="numpy")
def _claim_line(switches, net, user, node, radius, c, d, dx, dy):
    first, last = switches.row_start[user], switches.row_start[user + 1]
    step = net.cell if d == 1 else -net.cell
    while c >= 0:
        score = dx * dx + dy * dy - radius * radius
        if score > 1e-12:
            return
        row = np.int64(switches.cell_row[c])
        if first <= row < last and score < switches.row_power[row] and net.clearance[c] <= radius:
            switches.row_power[row] = score
            switches.all_label[c] = node
        c = linked(net, c, d)
        dy += step
