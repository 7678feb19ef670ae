"""What blocked and opened zones change for a body of one radius: its doors, and what they join."""

import numpy as np

from navmesh.graph.portals import BESIDE, fill_portal, is_open_to
from navmesh.zones.distances import segment_to_outline
from navmesh.zones.memo import place_of, sign_of
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["count_reached", "join_regions", "settle_doors"]

_SLACK = 0.01  # [m]: ends of portals are where a body still fits, to some millimetres


@kernel(error_model="numpy", forceinline=True)
def _reaches(portal, door, outline, box, room):
    """Whether the ends of a portal, or what bounds it there, may be what a zone makes them. ``box``: the
    least x and y and the greatest of what is within ``room`` [m] of its outline."""
    ax, ay, bx, by = portal[door, 0], portal[door, 1], portal[door, 3], portal[door, 4]
    if max(ax, bx) < box[0] or max(ay, by) < box[1] or min(ax, bx) > box[2] or min(ay, by) > box[3]:
        return False
    return segment_to_outline(outline, ax, ay, bx, by) <= room


@allocating_kernel(error_model="numpy")
def count_reached(switches, doors, base, zone, outline, by, reached):
    """Add ``by`` to ``reached`` (p,) for the doors of the undivided graph that a ``zone`` reaches."""
    room = BESIDE * doors.radius + _SLACK
    low_x, low_y = outline[:, 0].min() - room, outline[:, 1].min() - room
    box = low_x, low_y, outline[:, 0].max() + room, outline[:, 1].max() + room
    for at in range(switches.around_start[zone], switches.around_start[zone + 1]):
        i = np.int64(switches.around[at])
        for door in range(doors.start[i], doors.start[i + 1]):
            if _reaches(base, door, outline, box, room):
                reached[door] += by


@allocating_kernel(error_model="numpy")
def settle_doors(net, switches, doors, base, zone, near, reached, kept):
    """Bring doors near a ``zone`` to what they are now, for one body.

    ``base`` are the targets and edges (p,) of the doors of the undivided graph, its portals, their cells,
    lenses and blocks, and the border cells and gates of its edges. ``near``: the starts and the values of the
    discs, by zone, whose doors or those of whose pieces may change. ``reached`` (p,): how many blocked zones
    reach each door. ``kept``: the keys and rows of doors that came up before.
    """
    base_target, base_edge, portal, cells, lens, block, border, gate = base
    user_start, users = near
    for at in range(switches.around_start[zone], switches.around_start[zone + 1]):
        i = np.int64(switches.around[at])
        for door in range(doors.start[i], doors.start[i + 1]):
            j = np.int64(base_target[door])
            if net.node_radius[i] <= 0.0 or net.node_radius[j] <= 0.0:
                doors.target[door] = -1
            elif reached[door] > 0:
                e = base_edge[door]
                _renew(net, switches, doors, kept, i, j, door, 1e300, border[e], gate[e])
            else:
                doors.target[door] = j
                for c in range(6):
                    doors.portal[door, c] = portal[door, c]
                for c in range(2):
                    doors.lens[door, c], doors.portal_cell[door, c] = lens[door, c], cells[door, c]
                for c in range(4):
                    doors.block[door, c] = block[door, c]
    first_door = base_target.size
    for at in range(user_start[zone], user_start[zone + 1]):
        user = users[at]
        first = switches.row_start[user]
        for k in range(-1, switches.piece_count[user]):
            i = np.int64(switches.whole[user]) if k < 0 else np.int64(switches.piece[first + k])
            slot = np.int64(switches.head[i])
            while slot >= 0:
                j = np.int64(switches.target[slot])
                for way in range(2):
                    at_slot, a, b = (slot, i, j) if way == 0 else (slot ^ 1, j, i)
                    _renew(
                        net, switches, doors, kept, a, b, first_door + at_slot, switches.width[at_slot],
                        switches.border[at_slot], switches.gate[at_slot],
                    )  # fmt: skip
                slot = np.int64(switches.following[slot])


@kernel(error_model="numpy")
def _renew(net, switches, doors, kept, i, j, door, width, border, gate):
    """The door from node i to node j; anew, unless it came up before. Whether it is open is asked only for a
    ``width`` that is not 1e300."""
    keys, places, cells = kept
    key = (i << 32) | j
    sign = sign_of(switches, i) * 31 + sign_of(switches, j)
    at, is_kept = place_of(keys, key, sign)
    if not is_kept:
        keys[at, 0], keys[at, 1] = key, sign
        # from the lesser node, as it is asked for edges between discs
        is_open = width == 1e300 or _opens(net, i, j, width, border, gate, doors.radius)
        cells[at, 2] = 1 if is_open else 0
        if is_open:
            fill_portal(
                net, i, j, border, gate, doors.radius, at,
                places[:, :6], cells[:, :2], places[:, 6:8], places[:, 8:],
            )  # fmt: skip
    doors.target[door] = j if cells[at, 2] == 1 else -1
    if cells[at, 2] == 1:
        for c in range(6):
            doors.portal[door, c] = places[at, c]
        for c in range(2):
            doors.lens[door, c], doors.portal_cell[door, c] = places[at, 6 + c], cells[at, c]
        for c in range(4):
            doors.block[door, c] = places[at, 8 + c]


@kernel(error_model="numpy")
def _opens(net, i, j, width, border, gate, radius):
    if i < j:
        return is_open_to(net, i, j, width, border[0], border[1], gate, radius)
    return is_open_to(net, j, i, width, border[1], border[0], gate, radius)


@kernel(forceinline=True)
def _root(region, part):
    while region[part] != part:
        region[part] = region[region[part]]
        part = region[part]
    return part


@kernel
def _unite(region, one, other):
    a, b = _root(region, one), _root(region, other)
    if a < b:
        region[b] = a
    elif b < a:
        region[a] = b


@kernel
def join_regions(switches, doors, fringe, way_start, way):
    """Number the parts near zones alike that doors join, and ring them: ``doors.region`` and ``doors.ring``.

    ``fringe`` are the nodes beside discs that can be broken; ``way``, grouped by these discs, nodes of the
    parts that they are joined with where neither is broken.
    """
    region, ring, part = doors.region, doors.ring, doors.part
    first_slot = doors.target.size - doors.following.size
    for node in fringe:
        region[part[node]] = part[node]
        ring[part[node]] = part[node]
    for step in range(3):
        for user in range(switches.whole.size):
            first = switches.row_start[user]
            is_whole = switches.broken[user] == 0
            for k in range(0, 1 if is_whole else switches.piece_count[user]):
                node = switches.whole[user] if is_whole else switches.piece[first + k]
                own = part[node]
                if step == 0:
                    region[own] = own
                    ring[own] = own
                    continue
                if step == 2:
                    _put_in_ring(region, ring, own)
                    continue
                for i in range(way_start[user], way_start[user + 1] if is_whole else way_start[user]):
                    if switches.all_radius[way[i]] > 0.0:
                        _unite(region, own, part[way[i]])
                slot = switches.head[node]
                while slot >= 0:
                    target = doors.target[first_slot + slot]
                    if target >= 0:
                        _unite(region, own, part[target])
                    slot = switches.following[slot]
    for node in fringe:
        _put_in_ring(region, ring, part[node])


@kernel
def _put_in_ring(region, ring, part):
    """Put a part into the ring of its region, unless it is in it."""
    root = _root(region, part)
    region[part] = root
    if part != root and ring[part] == part:
        ring[part] = ring[root]
        ring[root] = part
