"""Where the stops of a roadmap (`navmesh.areas.roadmap`) are: on the portals, along the borders of areas, and
where a body turns round a corner."""

import numpy as np

from navmesh.areas.areas import PARTS, Areas
from navmesh.areas.line_costs import area_at
from navmesh.graph.snapping import node_at
from navmesh.surface.clearance_field import centre_of, floor_at, gap_at, same_place, walk
from navmesh.surface.columns import column_of
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["members", "other_stops", "portal_stops"]

_NARROW = 0.4  # [m] portals no longer than this get one stop
_ALONG_PORTAL = 1.2  # [m] between stops of a portal, at most
_ALONG_BORDER = 0.6  # [m] between stops along a border, at least
_ALONG_CORNER = 0.25  # [m] between stops round a corner, at least
_OFF = 3  # parts of a cell between a stop and the border
_AROUND = 0.2  # [m] distance at which a stop looks round for whether it is at a corner
_LOOKS = 24
_AT_CORNER = 14  # of these that are free round a corner; along a wall 13 are
_FINE = 6  # places along a cell's side that may become stops at corners


@kernel(error_model="numpy")
def _along_portal(net, areas, doors, door, share):
    """Where on a portal, 0 (left) to 1 (right), its stops are; writes into ``share`` and returns how many.

    They are spread evenly, with one on either side of where it crosses a border of areas.
    """
    lx, ly = doors.portal[door, 0], doors.portal[door, 1]
    dx, dy = doors.portal[door, 3] - lx, doors.portal[door, 4] - ly
    wide = np.hypot(dx, dy)
    count = 1 if wide <= _NARROW else int(wide / _ALONG_PORTAL) + 2
    for i in range(count):
        share[i] = 0.5 if count == 1 else i / (count - 1)
    step = net.cell / PARTS
    steps = int(wide / step)
    k, x, y = np.int64(doors.portal_cell[door, 0]), lx, ly
    before = area_at(net, areas, k, x, y)
    for i in range(1, steps):
        px, py = lx + i / steps * dx, ly + i / steps * dy
        k = walk(net, k, x, y, px, py, 0.0, True)[1]
        x, y = px, py
        area = area_at(net, areas, k, x, y)
        if area != before and count + 2 <= share.size:
            share[count] = max(i - 0.5 - _OFF, 0.0) / steps
            share[count + 1] = min(i - 0.5 + _OFF, 1.0 * steps) / steps
            count += 2
        before = area
    return count


@allocating_kernel(error_model="numpy")
def portal_stops(net, areas, doors):
    """Stops on the portals: place (s, 3), cell (s,), nodes (s, 2), and whether the portal is narrow (s,)."""
    room = 1024
    place, cell, node = np.empty((room, 3)), np.empty(room, np.int32), np.empty((room, 2), np.int32)
    share, narrow = np.empty(256), np.empty(room, np.bool_)
    count = 0
    for i in range(doors.start.size - 1):
        for door in range(doors.start[i], doors.start[i + 1]):
            if doors.target[door] <= i:
                continue
            lx, ly = doors.portal[door, 0], doors.portal[door, 1]
            dx, dy = doors.portal[door, 3] - lx, doors.portal[door, 4] - ly
            for s in range(_along_portal(net, areas, doors, door, share)):
                if count == room:
                    place = np.concatenate((place, np.empty_like(place)))
                    cell = np.concatenate((cell, np.empty_like(cell)))
                    node = np.concatenate((node, np.empty_like(node)))
                    narrow = np.concatenate((narrow, np.empty_like(narrow)))
                    room *= 2
                x, y = lx + share[s] * dx, ly + share[s] * dy
                k = walk(net, np.int64(doors.portal_cell[door, 0]), lx, ly, x, y, 0.0, True)[1]
                place[count, 0], place[count, 1], place[count, 2] = x, y, floor_at(net, k, x, y)
                cell[count], node[count, 0], node[count, 1] = k, i, doors.target[door]
                narrow[count] = dx * dx + dy * dy <= _NARROW * _NARROW
                count += 1
    return place[:count].copy(), cell[:count].copy(), node[:count].copy(), narrow[:count].copy()


@kernel(error_model="numpy")
def _is_beside_border(net, areas, k, x, y, own):
    """Whether all parts nearer than `_OFF` to (x, y) are of the area ``own``, and one so far off is not."""
    side = net.cell / PARTS
    for i in range(1 - _OFF, _OFF):
        for j in range(1 - _OFF, _OFF):
            if area_at(net, areas, k, x + i * side, y + j * side) not in (own, -1):
                return False
    for i in range(-_OFF, _OFF + 1):
        for j in range(-_OFF, _OFF + 1):
            if area_at(net, areas, k, x + i * side, y + j * side) not in (own, -1):
                return True
    return False


@kernel(error_model="numpy")
def _share_around(net, areas, k, x, y, own):
    """How many of the places around (x, y) are of the area ``own``."""
    found = 0
    far = min(_AROUND, 0.9 * net.cell)
    for i in range(_LOOKS):
        angle = 2.0 * np.pi * i / _LOOKS
        if area_at(net, areas, k, x + far * np.cos(angle), y + far * np.sin(angle)) == own:
            found += 1
    return found


_NOBODY: tuple = (0.0, 0.0, 0, 0, 0)
# the first candidate of a list, which tells Numba the types and does not count: x, y [m], cell, node, share


@allocating_kernel(error_model="numpy")
def _in_columns(found):
    """Candidates but the first: place (c, 2), cell (c,), node (c,), share (c,)."""
    count = len(found) - 1
    place, cell = np.empty((count, 2)), np.empty(count, np.int32)
    node, share = np.empty(count, np.int32), np.empty(count, np.int32)
    for c in range(count):
        place[c, 0], place[c, 1], cell[c], node[c], share[c] = found[c + 1]
    return place, cell, node, share


@allocating_kernel(error_model="numpy")
def _border_candidates(net, areas, radius):
    """Middles of parts beside borders: place (c, 2), cell (c,), node (c,), and how many places around are of
    the same area, (c,): most round the corners of other areas."""
    found = [_NOBODY]
    h = net.cell
    for k in range(areas.row.size):
        if areas.row[k] < 0 or net.clearance[k] < radius - 0.7072 * h:
            continue
        ix, iy = divmod(column_of(net, k), net.ny)
        for i in range(PARTS * PARTS):
            x = (ix + (i // PARTS + 0.5) / PARTS) * h
            y = (iy + (i % PARTS + 0.5) / PARTS) * h
            own = np.int64(areas.part[areas.row[k], i])
            if not _is_beside_border(net, areas, k, x, y, own):
                continue
            if net.clearance[k] < radius + 0.7072 * h and gap_at(net, k, x, y)[0] < radius * 1.01:
                continue
            own_node = np.int64(node_at(net, k, x, y, radius))
            if own_node < 0:
                continue
            found.append((x, y, k, own_node, _share_around(net, areas, k, x, y, own)))
    return _in_columns(found)


@kernel(error_model="numpy")
def _free_around(net, k, x, y, gap, far):
    """At how many of the places ``far`` [m] around (x, y), in cell ``k``, there is at least the ``gap``
    [m]."""
    found = 0
    for i in range(_LOOKS):
        angle = 2.0 * np.pi * i / _LOOKS
        px, py = x + far * np.cos(angle), y + far * np.sin(angle)
        reached, other = walk(net, k, x, y, px, py, 0.0, True)[:2]
        if reached and gap_at(net, other, px, py)[0] >= gap:
            found += 1
    return found


@allocating_kernel(error_model="numpy")
def _corner_candidates(net, radius):
    """Places where a body only just fits round a corner: as `_border_candidates`."""
    found = [_NOBODY]
    h = net.cell
    for k in range(net.clearance.size):
        if abs(net.clearance[k] - radius) > 0.8 * h:
            continue
        cx, cy = centre_of(net, k)
        for i in range(_FINE * _FINE):
            x = cx + ((i // _FINE + 0.5) / _FINE - 0.5) * h
            y = cy + ((i % _FINE + 0.5) / _FINE - 0.5) * h
            gap = gap_at(net, k, x, y)[0]
            if gap < 1.05 * radius or gap > 1.05 * radius + 1.5 * h / _FINE:
                continue
            reached, end = walk(net, k, cx, cy, x, y, 0.0, True)[:2]
            if not reached or not same_place(net, end, k):
                continue
            free = _free_around(net, k, x, y, gap - 1e-3, 0.8 * gap)
            if free < _AT_CORNER:
                continue
            own_node = np.int64(node_at(net, k, x, y, radius))
            if own_node < 0:
                continue
            found.append((x, y, k, own_node, free))
    return _in_columns(found)


@allocating_kernel(error_model="numpy")
def _thinned(order, place, cell, own, node, spacing):
    """Those of the candidates that are ``spacing`` apart within a node and an area, first ones first: (n,)
    int32. ``order`` (c,) sorts them by node."""
    chosen = np.empty(order.size, np.int32)
    count = first = 0
    for at in range(order.size):
        i = order[at]
        if at > 0 and node[order[at - 1]] != node[i]:
            first = count
        free = True
        for j in range(first, count):
            other = chosen[j]
            if own[other] == own[i] and (
                (place[other, 0] - place[i, 0]) ** 2 + (place[other, 1] - place[i, 1]) ** 2
                < spacing * spacing
            ):
                free = False
                break
        if free:
            chosen[count] = i
            count += 1
    return chosen[:count].copy()


@allocating_kernel(error_model="numpy")
def members(net, doors, place, cell, node):
    """Which stops are in which nodes: pairs (p, 2) of a stop and a node. ``node`` (s, 2) are the nodes that
    each stop was put in; it also is in those beside them whose disc has room for the body there."""
    room = 4096
    found = np.empty((room, 2), np.int32)
    count = 0
    for i in range(cell.size):
        first = count
        x, y = place[i, 0], place[i, 1]
        for side in range(2):
            own = np.int64(node[i, side])
            if own < 0:
                continue
            for at in range(doors.start[own] - 1, doors.start[own + 1]):
                other = own if at < doors.start[own] else np.int64(doors.target[at])
                known = False
                for j in range(first, count):
                    known = known or found[j, 1] == other
                if known:
                    continue
                if other != own:
                    px, py = net.position[other, 0], net.position[other, 1]
                    spare = net.node_radius[other] - doors.radius
                    if spare <= 0.0 or (px - x) ** 2 + (py - y) ** 2 >= spare * spare:
                        continue
                    reached, end = walk(net, np.int64(cell[i]), x, y, px, py, doors.radius, False)[:2]
                    if not reached or not same_place(net, end, np.int64(net.node_cell[other])):
                        continue
                if count == room:
                    found = np.concatenate((found, np.empty_like(found)))
                    room *= 2
                found[count, 0], found[count, 1] = i, other
                count += 1
    return found[:count].copy()


@allocating_kernel(error_model="numpy")
def _areas_at(net, areas, cell, place):
    found = np.empty(cell.size, np.int32)
    for i in range(cell.size):
        found[i] = max(area_at(net, areas, np.int64(cell[i]), place[i, 0], place[i, 1]), 0)
    return found


def other_stops(net, areas: Areas, radius: float) -> tuple[np.ndarray, ...]:
    """Places (s, 2), cells (s,) and nodes (s,) of stops at corners and along the borders of areas."""
    stops = []
    for candidates, spacing in (
        (_corner_candidates(net, radius), _ALONG_CORNER),
        (_border_candidates(net, areas, radius), _ALONG_BORDER),
    ):
        place, cell, node, share = candidates
        # those at sharp corners first: there a line turns
        order = np.lexsort((np.arange(len(cell)), -share, node))
        own = _areas_at(net, areas, cell, place)
        chosen = _thinned(order, place, cell, own, node, spacing)
        stops.append((place[chosen], cell[chosen], node[chosen]))
    place, cell, node = (np.concatenate(column) for column in zip(*stops, strict=True))
    return place, cell, node
