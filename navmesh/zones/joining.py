"""Edges between pieces, and between pieces and discs, made anew where a zone has been turned."""

import numpy as np

from navmesh.graph.edges import widest_pair
from navmesh.surface.columns import column_of
from navmesh.surface.storeys import APART, over
from navmesh.zones.kept_pieces import disc_around, keep_seam, recall_seams
from navmesh.zones.memo import MIX, place_of, sign_of
from navmesh.zones.slots import add_edge
from navmesh.zones.switches import TURNS
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["join"]


@allocating_kernel(error_model="numpy")
def join(switches, net, zone):
    """Make the edges between pieces, and between pieces and discs, at the discs turned last."""
    meeting = np.empty((1024, 2), np.int32)  # cells of different nodes beside each other
    count = 0
    for at in range(switches.user_start[zone], switches.user_start[zone + 1]):
        user = np.int64(switches.user[at])
        if switches.turned[user] != switches.numbers[TURNS]:
            continue
        if switches.broken[user] > 0 and not recall_seams(switches, user):
            meeting, count = _look_for_seams(switches, net, user, meeting, count)
        for i in range(switches.rim_start[user], switches.rim_start[user + 1]):
            if _meets(switches, i):
                meeting, count = _with(meeting, count, switches.rim[i, 0], switches.rim[i, 2])
    met = np.full(512, -1, np.int64)
    edges = 0
    wanted, wanting = np.empty(count, np.int64), 0
    last = np.int64(-1)
    for i in range(count):
        key = _key(switches, meeting[i, 0], meeting[i, 1])
        if key == last:
            continue
        last = key
        if not _is_new(met, key):
            continue
        edges += 1
        if 2 * edges > met.size:
            met = _roomier(met)
        a, b = key >> 32, key & 0xFFFFFFFF
        if disc_around(switches, a, b) < 0:
            at, is_kept = place_of(switches.kept, key, _sign_between(switches, a, b))
            if is_kept:
                x, y = switches.kept_place[at, 1], switches.kept_place[at, 2]
                border = switches.kept_border[at, 0], switches.kept_border[at, 1]
                add_edge(switches, a, b, (switches.kept_place[at, 0], x, y), border)
                continue
        wanted[wanting] = key
        wanting += 1
    if wanting > 0:
        _measure(switches, net, meeting[:count], np.sort(wanted[:wanting]))


@allocating_kernel(error_model="numpy")
def _look_for_seams(switches, net, user, meeting, count):
    """Add the pairs of cells at which pieces of a broken disc meet, each once."""
    first, last = switches.row_start[user], switches.row_start[user + 1]
    label = switches.all_label
    for row in range(first, last):
        c = np.int64(switches.row_cell[row])
        column = column_of(net, c)
        for way in range(2):
            n = over(net, c, column, way)
            if n < 0 or label[n] == label[c] or not first <= switches.cell_row[n] < last:
                continue
            if label[c] >= 0 and label[n] >= 0:
                meeting, count = _with(meeting, count, c, n)
    return meeting, count


@allocating_kernel
def _with(meeting, count, c, n):
    """One more row, and how many there are then."""
    if count == meeting.shape[0]:
        meeting = np.concatenate((meeting, np.empty_like(meeting)))
    meeting[count, 0], meeting[count, 1] = c, n
    return meeting, count + 1


@kernel(forceinline=True)
def _meets(switches, i):
    """Whether two nodes, of which one is a piece, meet at a row of `SWITCHES`.rim."""
    c, way, n = switches.rim[i, 0], switches.rim[i, 1], switches.rim[i, 2]
    own, other = switches.all_label[c], switches.all_label[n]
    is_one_a_piece = max(own, other) >= switches.first_piece
    return is_one_a_piece and own != other and min(own, other) >= 0 and switches.all_storey[c, way] != APART


@kernel(forceinline=True)
def _key(switches, c, n):
    """The key of the edge between the nodes of two cells."""
    own, other = np.int64(switches.all_label[c]), np.int64(switches.all_label[n])
    return (min(own, other) << 32) | max(own, other)


@kernel
def _is_new(met, key):
    """Whether a key was not in a table with places left; now it is."""
    at = (key * MIX >> 20) & (met.size - 1)
    while met[at] >= 0 and met[at] != key:
        at = (at + 1) & (met.size - 1)
    if met[at] == key:
        return False
    met[at] = key
    return True


@kernel(forceinline=True)
def _sign_between(switches, a, b):
    return sign_of(switches, a) * 31 + sign_of(switches, b)


@allocating_kernel
def _roomier(met):
    """A table of keys with twice as many places."""
    more = np.full(2 * met.size, -1, np.int64)
    for key in met:
        if key >= 0:
            _is_new(more, key)
    return more


@allocating_kernel(error_model="numpy")
def _measure(switches, net, meeting, wanted):
    """Make, and keep, the edges of these keys (k,), which rise. ``meeting`` (m, 2): the cells at which they
    and others meet; some come twice."""
    most = meeting.shape[0]
    key, pair, width = np.empty(most, np.int64), np.empty((most, 2), np.int32), np.empty(most)
    count = 0
    for i in range(most):
        c, n = meeting[i, 0], meeting[i, 1]
        if switches.all_label[c] > switches.all_label[n]:
            c, n = n, c
        its = _key(switches, c, n)
        at = np.searchsorted(wanted, its)
        if at < wanted.size and wanted[at] == its:
            key[count], pair[count, 0], pair[count, 1] = its, c, n
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
        found, border = (passes, x, y), (pair[best, 0], pair[best, 1])
        add_edge(switches, a, b, found, border)
        user = disc_around(switches, a, b)
        if user >= 0:
            keep_seam(switches, user, found, border)
        else:
            sign = _sign_between(switches, a, b)
            place = place_of(switches.kept, its, sign)[0]
            switches.kept[place, 0], switches.kept[place, 1] = its, sign
            for i in range(3):
                switches.kept_place[place, i] = found[i]
            switches.kept_border[place, 0], switches.kept_border[place, 1] = border
        at = end


@kernel(forceinline=True)
def _comes_before(pair, i, j):
    return pair[i, 0] < pair[j, 0] or (pair[i, 0] == pair[j, 0] and pair[i, 1] < pair[j, 1])
