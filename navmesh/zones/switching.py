"""Blocking and opening a zone: what cells say, the discs there and the edges between them are made anew, near
the zone only.

With all zones open the graph is the undivided one. A disc that a blocked zone is in the way of is *broken*:
its cells are covered again, by *pieces*, discs of their own that claim none but its cells. Which pieces there
are follows from which zones are blocked now, not from what was blocked before.
"""

import numpy as np
from numba import float64, int32, int64, uint8

from navmesh.graph.edges import widest_pair
from navmesh.graph.nodes import disc_at
from navmesh.surface.clearance_field import centre_of, floor_at
from navmesh.surface.storeys import APART, linked
from navmesh.zones.memo import MIX, place_of, sign_of
from surefoot.kernels import allocating_kernel, kernel
from surefoot.kernels.bundles import BundleType

__all__ = ["SLOTS", "SWITCHES", "TURNS", "turn"]

SWITCHES = BundleType(
    grain=float64,
    least=float64,
    first_piece=int64,
    blocked=int32[::1],
    cell_start=int32[::1],
    cell_known=int32[::1],
    known_cell=int32[::1],
    known_nearest=float64[:, ::1],
    known_clearance=float64[::1],
    near_start=int32[::1],
    near_zone=int32[::1],
    near=float64[:, ::1],
    cut_start=int32[::1],
    cut_link=int32[::1],
    cut=int32[:, ::1],
    cut_count=int32[::1],
    side_start=int32[::1],
    side_row=int32[::1],
    side=float64[:, ::1],
    user_start=int32[::1],
    user=int32[::1],
    user_cut=int32[::1],
    whole=int32[::1],
    whole_radius=float64[::1],
    broken=int32[::1],
    turned=int64[::1],
    row_start=int32[::1],
    row_cell=int32[::1],
    row_user=int32[::1],
    row_power=float64[::1],
    cell_row=int32[::1],
    piece_count=int32[::1],
    piece=int32[::1],
    kept_sign=int64[::1],
    kept_count=int32[::1],
    kept_label=int32[::1],
    kept_piece=int32[::1],
    kept_radius=float64[::1],
    rim_start=int32[::1],
    rim=int32[::1],
    seam_count=int32[::1],
    seam=int32[::1],
    numbers=int64[::1],
    head=int32[::1],
    following=int32[::1],
    target=int32[::1],
    width=float64[::1],
    gate=float64[:, ::1],
    border=int32[:, ::1],
    made=int64[::1],
    origin=float64[::1],
    around_start=int32[::1],
    around=int32[::1],
    zone_sign=int64[::1],
    node_sign=int64[::1],
    kept=int64[:, ::1],
    kept_place=float64[:, ::1],
    kept_border=int32[:, ::1],
    all_storey=uint8[:, ::1],
    all_clearance=float64[::1],
    all_nearest=float64[:, ::1],
    all_label=int32[::1],
    all_blocker=float64[:, ::1],
    all_radius=float64[::1],
    all_position=float64[:, ::1],
)
"""All that zones change, and how.

blocked (z,): 1 or 0. Cells *know* the zones that can be nearer to them than where walking ends: zone i is
known to cell_known[cell_start[i]:cell_start[i + 1]], indices of known_cell. Of each of these: known_nearest
(2) [m]: the vector to where walking ends if all zones are open, and known_clearance, its length; near_zone,
near (2), grouped by near_start: the zones that it knows and the vectors to them. cut_link, grouped by zone:
the links that it cuts, as rows of cut (cell, direction, storey that it leads to); cut_count: how many blocked
zones cut each. side_row, grouped by zone: the rows of the blockers that are its outline, and side (4): what
they are if it is blocked.

user, grouped by zone by user_start: the discs that a zone has to do with; user_cut: 1 for those that it is in
the way of. Of each such disc: whole: the node, whole_radius [m], broken: how many blocked zones are in its
way, turned: the number of the last turn that concerned it; its rows from row_start on: row_cell, the cells
that it owns, row_user, itself, and row_power, by how much (d² - r²) they lie in their piece; piece_count and
piece, from row_start on: the nodes that are its pieces now; kept_sign, kept_count, kept_label, kept_piece and
kept_radius: its pieces when it was broken last, and the sign that it had.
rim, grouped by disc by rim_start: its rows beside cells of others; seam, from row_start on: seam_count rows
beside other pieces of those that are kept. A piece that is made at the turn of the cell of
row r is node first_piece + r. cell_row (n,): the row of a cell, or -1.

Edges of pieces are pairs of slots, one for each way, at 2k and 2k + 1. head (m,) is the first slot of each
node, following the next, or -1, by rising target; of each slot: target, width, gate (2) and border (2) as of
`NodeGraph`, and made, the number of the turn that made it. around, grouped by zone: the nodes whose edges it
may narrow or close; zone_sign and node_sign: see `navmesh.zones.memo`; kept, kept_place (width and gate) and
kept_border: edges that came up before. numbers: slots in use or free, the first free pair, turns so far, see
`SLOTS`. all_...: the arrays of the surface and the graph that are kept up to date.
"""

SLOTS = 0
"""Place in `SWITCHES`.numbers: how many slots have ever been in use."""
_FREE, TURNS = 1, 2
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
    _join(switches, net, zone)


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
    _let_go(switches, np.int64(switches.whole[user]))
    for i in range(first, first + switches.piece_count[user]):
        node = np.int64(switches.piece[i])
        _let_go(switches, node)
        switches.all_radius[node] = -1.0
        net.node_radius[node] = -1.0
    switches.piece_count[user] = 0


@kernel
def _let_go(switches, node):
    """Free the slots of a node, and those back to it."""
    following, head = switches.following, switches.head
    slot = np.int64(head[node])
    while slot >= 0:
        after = np.int64(following[slot])
        back = slot ^ 1
        other = np.int64(switches.target[slot])
        at = np.int64(head[other])
        if at == back:
            head[other] = following[back]
        else:
            while following[at] != back:
                at = np.int64(following[at])
            following[at] = following[back]
        pair = min(slot, back)
        following[pair] = switches.numbers[_FREE]
        switches.numbers[_FREE] = pair
        slot = after
    head[node] = -1


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
    if switches.kept_count[user] >= 0 and switches.kept_sign[user] == switches.node_sign[whole]:
        for row in range(first, last):
            label[row_cell[row]] = switches.kept_label[row]
        switches.piece_count[user] = switches.kept_count[user]
        for i in range(first, first + switches.kept_count[user]):
            node = np.int64(switches.kept_piece[i])
            switches.piece[i] = node
            switches.all_radius[node] = net.node_radius[node] = switches.kept_radius[i]
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
        switches.piece[at], switches.kept_piece[at], switches.kept_radius[at] = node, node, radius
        switches.piece_count[user] += 1
        switches.all_radius[node] = net.node_radius[node] = radius
        z = floor_at(net, k, x, y)
        for axis in range(3):  # rounded as if it was made of the world's coordinates
            place = (x if axis == 0 else (y if axis == 1 else z)) + switches.origin[axis]
            switches.all_position[node, axis] = place
            net.position[node, axis] = place - switches.origin[axis]
        net.node_cell[node] = k
    switches.kept_sign[user] = switches.node_sign[whole]
    switches.kept_count[user] = switches.piece_count[user]
    seams = 0
    for row in range(first, last):
        own = label[row_cell[row]]
        switches.kept_label[row] = own
        for d in range(4):
            n = linked(net, row_cell[row], d)
            if n >= 0 and label[n] != own and first <= switches.cell_row[n] < last:
                switches.seam[first + seams] = row
                seams += 1
                break
    switches.seam_count[user] = seams


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


@allocating_kernel(error_model="numpy")
def _join(switches, net, zone):
    """Make the edges between pieces, and between pieces and discs, at the discs turned last."""
    met = np.full(256, -1, np.int64)  # keys of edges that have come up, and two places for each
    edges = 0
    missed = np.zeros(256, np.int64)
    count = 0
    label, pieces = switches.all_label, switches.first_piece
    for at_user in range(switches.user_start[zone], switches.user_start[zone + 1]):
        user = switches.user[at_user]
        if switches.turned[user] != switches.numbers[TURNS]:
            continue
        last = np.int64(-1)
        for i in range(_borders(switches, user)):
            c = switches.row_cell[_border(switches, user, i)]
            own = np.int64(label[c])
            if own < 0:
                continue
            for d in range(4):
                n = linked(net, c, d)
                other = np.int64(label[n]) if n >= 0 else own
                if other == own or other < 0 or (own < pieces and other < pieces):
                    continue
                key = (min(own, other) << 32) | max(own, other)
                if key == last:
                    continue
                last = key
                at = (key * MIX >> 20) & (met.size - 1)
                while met[at] >= 0 and met[at] != key:
                    at = (at + 1) & (met.size - 1)
                if met[at] == key:
                    continue
                met[at] = key
                edges += 1
                if 2 * edges > met.size:
                    met = _roomier(met)
                a, b = key >> 32, key & 0xFFFFFFFF
                place, is_kept = place_of(switches.kept, key, _sign_between(switches, a, b))
                if is_kept:
                    _add(switches, a, b, place)
                    continue
                if count == missed.size:
                    missed = np.concatenate((missed, np.zeros_like(missed)))
                missed[count] = key
                count += 1
    if count > 0:
        _measure(switches, net, zone, np.sort(missed[:count]))


@kernel(forceinline=True)
def _borders(switches, user):
    """How many rows `_border` has: a row may come twice."""
    seams = switches.seam_count[user] if switches.broken[user] > 0 else 0
    return switches.rim_start[user + 1] - switches.rim_start[user] + seams


@kernel(forceinline=True)
def _border(switches, user, i):
    """The i-th row of a disc that may be beside another piece or disc."""
    rim = switches.rim_start[user + 1] - switches.rim_start[user]
    if i < rim:
        return switches.rim[switches.rim_start[user] + i]
    return switches.seam[switches.row_start[user] + i - rim]


@kernel(forceinline=True)
def _sign_between(switches, a, b):
    return sign_of(switches, a) * 31 + sign_of(switches, b)


@allocating_kernel
def _roomier(met):
    """A table of keys with twice as many places."""
    more = np.full(2 * met.size, -1, np.int64)
    for key in met:
        if key >= 0:
            at = (key * MIX >> 20) & (more.size - 1)
            while more[at] >= 0:
                at = (at + 1) & (more.size - 1)
            more[at] = key
    return more


@allocating_kernel(error_model="numpy")
def _measure(switches, net, zone, wanted):
    """Make, and keep, the edges of these keys (k,), which rise."""
    now = switches.numbers[TURNS]
    label = switches.all_label
    key, pair, width = np.empty(256, np.int64), np.empty((256, 2), np.int32), np.empty(256)
    count = 0
    for at_user in range(switches.user_start[zone], switches.user_start[zone + 1]):
        user = switches.user[at_user]
        if switches.turned[user] != now:
            continue
        for i in range(_borders(switches, user)):
            c = np.int64(switches.row_cell[_border(switches, user, i)])
            if label[c] < 0:
                continue
            for d in range(4):
                n = linked(net, c, d)
                if n < 0 or label[n] < 0 or label[n] == label[c]:
                    continue
                first, second = (c, n) if label[c] < label[n] else (n, c)
                its = (np.int64(label[first]) << 32) | label[second]
                at = np.searchsorted(wanted, its)
                if at == wanted.size or wanted[at] != its:
                    continue
                other = switches.cell_row[n]
                if other >= 0 and switches.turned[switches.row_user[other]] == now and n < c:
                    continue  # found from there
                if count == key.size:
                    key = np.concatenate((key, np.empty_like(key)))
                    pair = np.concatenate((pair, np.empty_like(pair)))
                    width = np.concatenate((width, np.empty_like(width)))
                key[count], pair[count, 0], pair[count, 1] = its, first, second
                width[count] = min(net.clearance[c], net.clearance[n])
                count += 1
    order = np.argsort(key[:count]).astype(np.int32)
    at = 0
    while at < count:
        end = at + 1
        while end < count and key[order[end]] == key[order[at]]:
            end += 1
        for i in range(at + 1, end):  # by rising cells, wherever they were found from
            j = i
            while j > at and _comes_before(pair, order[j], order[j - 1]):
                order[j], order[j - 1] = order[j - 1], order[j]
                j -= 1
        its = key[order[at]]
        a, b = its >> 32, its & 0xFFFFFFFF
        one, other = net.node_radius[a], net.node_radius[b]
        away = np.hypot(net.position[b, 0] - net.position[a, 0], net.position[b, 1] - net.position[a, 1])
        lens = 0.5 * (one + other - away)
        best, x, y, passes = widest_pair(order, at, end, pair, width, lens, min(one, other), net)
        sign = _sign_between(switches, a, b)
        place = place_of(switches.kept, its, sign)[0]
        switches.kept[place, 0], switches.kept[place, 1] = its, sign
        switches.kept_place[place, 0] = passes
        switches.kept_place[place, 1], switches.kept_place[place, 2] = x, y
        switches.kept_border[place, 0], switches.kept_border[place, 1] = pair[best, 0], pair[best, 1]
        _add(switches, a, b, place)
        at = end


@kernel(forceinline=True)
def _comes_before(pair, i, j):
    return pair[i, 0] < pair[j, 0] or (pair[i, 0] == pair[j, 0] and pair[i, 1] < pair[j, 1])


@kernel
def _add(switches, a, b, place):
    """Take two slots for the edge between nodes ``a`` and ``b`` that is kept at a ``place``."""
    numbers, following, head, target = switches.numbers, switches.following, switches.head, switches.target
    pair = numbers[_FREE]
    if pair >= 0:
        numbers[_FREE] = following[pair]
    else:
        pair = numbers[SLOTS]
        numbers[SLOTS] += 2
    for way in range(2):
        slot = pair + way
        source, to = (a, b) if way == 0 else (b, a)
        target[slot], switches.made[slot] = to, numbers[TURNS]
        switches.width[slot] = switches.kept_place[place, 0]
        for i in range(2):
            switches.gate[slot, i] = switches.kept_place[place, 1 + i]
            switches.border[slot, i] = switches.kept_border[place, i if way == 0 else 1 - i]
        at = np.int64(head[source])
        if at < 0 or target[at] > to:
            following[slot] = at
            head[source] = slot
            continue
        while following[at] >= 0 and target[following[at]] < to:
            at = np.int64(following[at])
        following[slot] = following[at]
        following[at] = slot
