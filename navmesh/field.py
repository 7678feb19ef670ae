"""The clearance field between cell centres: how far a point or a stretch of a line is from where walking
ends.

Every cell knows which list of blockers (`navmesh.blockers`) has the place where walking ends nearest to its
centre. The distance from a point is that to all of the list's segments; the lists of the cells to the sides
are asked too, because across the middle of a passage they know the other wall. All coordinates are relative
to the surface's origin, all distances are horizontal [m].
"""

from math import sqrt

import numpy as np
from numba import njit

__all__ = ["cell_at", "centre_of", "floor_at", "gap_at", "same_place", "stretch_gap", "walk"]


@njit(error_model="numpy", cache=True, inline="always")
def _to_segment(px, py, ax, ay, bx, by):
    """Squared distance from p to the segment a-b, and where on it that is (0 to 1)."""
    ex = bx - ax
    ey = by - ay
    length = ex * ex + ey * ey
    t = ((px - ax) * ex + (py - ay) * ey) / length if length > 0.0 else 0.0
    t = 0.0 if t < 0.0 else (1.0 if t > 1.0 else t)
    dx = ax + t * ex - px
    dy = ay + t * ey - py
    return dx * dx + dy * dy, t


@njit(error_model="numpy", cache=True)
def _list_gap(net, source, px, py, qx, qy, least, s, x, y):
    """The least squared distance of the segment p-q to the blockers in the list of cell ``source``, where
    that is less than ``least``: (squared, where on p-q (0 to 1), the place on the blocker: x, y)."""
    blocker = net.blocker
    ux = qx - px
    uy = qy - py
    stretch = ux * ux + uy * uy
    for k in range(net.blocker_start[source], net.blocker_start[source + 1]):
        ax, ay, bx, by = blocker[k, 0], blocker[k, 1], blocker[k, 2], blocker[k, 3]
        off, t = _to_segment(px, py, ax, ay, bx, by)
        if off < least:
            least, s, x, y = off, 0.0, ax + t * (bx - ax), ay + t * (by - ay)
        if stretch == 0.0:
            continue
        off, t = _to_segment(qx, qy, ax, ay, bx, by)
        if off < least:
            least, s, x, y = off, 1.0, ax + t * (bx - ax), ay + t * (by - ay)
        off, t = _to_segment(ax, ay, px, py, qx, qy)
        if off < least:
            least, s, x, y = off, t, ax, ay
        ex = bx - ax
        ey = by - ay
        if ex == 0.0 and ey == 0.0:
            continue
        off, t = _to_segment(bx, by, px, py, qx, qy)
        if off < least:
            least, s, x, y = off, t, bx, by
        turn = ux * ey - uy * ex
        if turn != 0.0:
            t = ((ax - px) * ey - (ay - py) * ex) / turn
            w = ((ax - px) * uy - (ay - py) * ux) / turn
            if 0.0 <= t <= 1.0 and 0.0 <= w <= 1.0:
                return 0.0, t, px + t * ux, py + t * uy
    return least, s, x, y


@njit(error_model="numpy", cache=True)
def stretch_gap(net, k, cx, cy, ax, ay, ux, uy, low, high):
    """Least distance to where walking ends from the stretch of a line, from ``low`` to ``high`` [m] along the
    unit vector u from a, inside cell ``k`` with its centre at c.

    The lists of the cell and of its neighbours on the stretch's side are asked. Returns (squared gap, where
    on the line, the place where walking ends: x, y).
    """
    px, py = ax + low * ux, ay + low * uy
    qx, qy = ax + high * ux, ay + high * uy
    right = 0 if px + qx > 2.0 * cx else 2
    up = 1 if py + qy > 2.0 * cy else 3
    gap, s, x, y = np.inf, 0.0, np.inf, np.inf
    first = net.source[k]
    if first >= 0:
        gap, s, x, y = _list_gap(net, first, px, py, qx, qy, gap, s, x, y)
    side, other = net.link[k, right], net.link[k, up]
    second = third = first
    if side >= 0:
        second = net.source[side]
        if second != first and second >= 0:
            gap, s, x, y = _list_gap(net, second, px, py, qx, qy, gap, s, x, y)
    if other >= 0:
        third = net.source[other]
        if third != first and third != second and third >= 0:
            gap, s, x, y = _list_gap(net, third, px, py, qx, qy, gap, s, x, y)
    corner = net.link[side, up] if side >= 0 else (net.link[other, right] if other >= 0 else -1)
    if corner >= 0:
        last = net.source[corner]
        if last != first and last != second and last != third and last >= 0:
            gap, s, x, y = _list_gap(net, last, px, py, qx, qy, gap, s, x, y)
    return gap, low + s * (high - low), x, y


@njit(error_model="numpy", cache=True, inline="always")
def centre_of(net, k):
    """x and y of the centre of cell ``k``."""
    column = net.cell_column[k]
    ix = column // net.ny
    return (ix + 0.5) * net.cell, (column - ix * net.ny + 0.5) * net.cell


@njit(error_model="numpy", cache=True)
def gap_at(net, k, x, y):
    """Distance [m] from (x, y), a point in cell ``k``, to the nearest place where walking ends, and that
    place."""
    cx, cy = centre_of(net, k)
    square, _, qx, qy = stretch_gap(net, k, cx, cy, x, y, 0.0, 0.0, 0.0, 0.0)
    return sqrt(square), qx, qy


@njit(error_model="numpy", cache=True)
def cell_at(net, x, y, z):
    """The cell of the column under (x, y) whose floor is nearest to height ``z``, or -1."""
    ix = int(x // net.cell)
    iy = int(y // net.cell)
    if ix < 0 or iy < 0 or ix >= net.nx or iy >= net.ny:
        return -1
    column = ix * net.ny + iy
    best = -1
    least = 1e300
    for k in range(net.column_start[column], net.column_start[column + 1]):
        off = abs(net.height[k] - z)
        if off < least:
            least = off
            best = k
    return best


@njit(error_model="numpy", cache=True, inline="always")
def same_place(net, k, other):
    """Whether a point that lies in cell ``k`` by one reckoning and in ``other`` by another is one place: on
    the border between squares, or on a corner of four, rounding decides, but they are linked."""
    if k == other:
        return True
    for way in range(4):
        beside = net.link[k, way]
        if beside == other:
            return True
        if beside >= 0 and (
            net.link[beside, (way + 1) % 4] == other or net.link[beside, (way + 3) % 4] == other
        ):
            return True
    return False


@njit(error_model="numpy", cache=True)
def floor_at(net, k, x, y):
    """Height [m] of the floor at (x, y) in cell ``k``: the plane through its centre."""
    cx, cy = centre_of(net, k)
    return net.height[k] + net.gradient[k, 0] * (x - cx) + net.gradient[k, 1] * (y - cy)


@njit(error_model="numpy", cache=True, inline="always")
def _leaves(cx, cy, room, ax, ay, ux, uy, s):
    """How far [m] from a the line along the unit vector u leaves the disc of radius ``room`` about c; -1
    where it is not in it at ``s``."""
    dx = ax + s * ux - cx
    dy = ay + s * uy - cy
    along = dx * ux + dy * uy
    spare = room * room - dx * dx - dy * dy
    return s - along + sqrt(along * along + spare) if spare >= 0.0 and room > 0.0 else -1.0


@njit(error_model="numpy", cache=True, inline="always")
def _landing(column_start, label, column, node):
    """The cell of the column that a line inside a disc about a cell of ``node`` comes to, or -1 where that is
    not clear: the only one, or the one that the node owns, which is the only one on the disc's floor."""
    first, last = column_start[column], column_start[column + 1]
    landing = first if last == first + 1 else -1
    if landing < 0 and node >= 0:
        for other in range(first, last):
            if label[other] == node:
                landing = other
    return landing


@njit(error_model="numpy", cache=True)
def walk(net, k, ax, ay, bx, by, radius, through):
    """Walk the straight line from a, a point in cell ``k``, to b over linked cells.

    A body of ``radius`` fits where the gap is at least the radius. With ``through`` the walk goes on where it
    does not fit, to find the tightest place, and ends only where no link leads on (gap -1).

    Returns (reached, cell where it ended, least gap [m], its place on the line (0 to 1), the place where
    walking ends there: x, y, the cell in which it is tightest). Gaps are measured only where
    no disc proves that the body fits; where none was measured the least gap is 1e300.
    """
    h, ny = net.cell, net.ny
    link, clearance, label = net.link, net.clearance, net.label
    position, node_radius, column_start = net.position, net.node_radius, net.column_start
    per_h = 1.0 / h
    dx = bx - ax
    dy = by - ay
    length = sqrt(dx * dx + dy * dy)
    per_length = 1.0 / length if length > 0.0 else 0.0
    ux = dx * per_length
    uy = dy * per_length
    column = net.cell_column[k]
    ix = column // ny
    iy = column - ix * ny
    # the line crosses into the next square on a side at (ix + side) * h
    way_x, side_x, turn_x = (0, 1, 1) if dx > 0.0 else (2, 0, -1)
    way_y, side_y, turn_y = (1, 1, 1) if dy > 0.0 else (3, 0, -1)
    per_x = 1.0 / ux if ux != 0.0 else 0.0
    per_y = 1.0 / uy if uy != 0.0 else 0.0
    next_x = ((ix + side_x) * h - ax) * per_x if ux != 0.0 else 1e300
    next_y = ((iy + side_y) * h - ay) * per_y if uy != 0.0 else 1e300
    step_x = h * abs(per_x)
    step_y = h * abs(per_y)
    margin = max(radius, 0.7072 * h)  # so much inside a disc, the middle of the square is inside it too
    least = 1e300
    place = qx = qy = 0.0
    tight = k
    s = 0.0  # [m] walked
    free = -1.0  # [m]: as far as a disc on the way proves that the body fits
    while True:
        leave = min(next_x, next_y, length)
        if free < leave:
            node = label[k]
            if node >= 0:
                room = node_radius[node] - margin
                free = _leaves(position[node, 0], position[node, 1], room, ax, ay, ux, uy, s)
            if free < leave:
                cx = (ix + 0.5) * h
                cy = (iy + 0.5) * h
                free = max(free, _leaves(cx, cy, clearance[k] - margin, ax, ay, ux, uy, s))
            if free < leave:
                if radius > 0.0:
                    square, where, px, py = stretch_gap(net, k, cx, cy, ax, ay, ux, uy, s, leave)
                    if square < least * least:
                        least, place, qx, qy, tight = sqrt(square), where, px, py, k
                        if least < radius and not through:
                            return False, k, least, place * per_length, qx, qy, tight
            elif free > leave + h and leave < length:
                ahead = min(free, length)
                jx, jy = int((ax + ahead * ux) * per_h), int((ay + ahead * uy) * per_h)
                landing = _landing(column_start, label, jx * ny + jy, node)
                if landing < 0 and 0.5 * (s + ahead) > leave + h:
                    ahead = 0.5 * (s + ahead)
                    jx, jy = int((ax + ahead * ux) * per_h), int((ay + ahead * uy) * per_h)
                    landing = _landing(column_start, label, jx * ny + jy, node)
                if landing >= 0:
                    k, ix, iy, s = landing, jx, jy, ahead
                    if ahead == length:
                        return True, k, least, place * per_length, qx, qy, tight
                    if ux != 0.0:
                        next_x = ((ix + side_x) * h - ax) * per_x
                    if uy != 0.0:
                        next_y = ((iy + side_y) * h - ay) * per_y
                    free = -1.0
                    continue
        if leave >= length:
            return True, k, least, place * per_length, qx, qy, tight
        if next_x < next_y:
            s = next_x
            next_x += step_x
            following = link[k, way_x]
            ix += turn_x
        else:
            s = next_y
            next_y += step_y
            following = link[k, way_y]
            iy += turn_y
        if following < 0:
            return False, k, -1.0, s * per_length, ax + s * ux, ay + s * uy, tight
        k = following
