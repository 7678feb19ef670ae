"""The clearance field between cell centres: how far a point or a stretch of a line is from where walking
ends.

Every cell knows which list of blockers (`navmesh.surface.blockers`) has the place where walking ends nearest
to its centre. The distance from a point is that to all of the list's segments; the lists of the cells to the
sides are asked too, because across the middle of a passage they know the other wall. All coordinates are
relative to the surface's origin, all distances are horizontal [m].
"""

from math import sqrt

import numpy as np

from navmesh.surface.columns import column_of
from navmesh.surface.floor_store import gradient_in, gradient_of, height_in
from navmesh.surface.storeys import linked, over
from surefoot.kernels import kernel
from surefoot.kernels.fetching import fetch

__all__ = [
    "cell_at",
    "centre_of",
    "fetch_cell",
    "floor_at",
    "gap_at",
    "gap_in",
    "middle_of_column",
    "same_place",
    "slope_at",
    "stretch_gap",
    "walk",
]


@kernel(error_model="numpy", forceinline=True)
def _list_of(net, cell):
    """The blockers that cell ``cell`` knows: from the first up to, not including, the last."""
    source = np.int64(net.source[cell])
    if source < 0:
        return 0, 0
    return np.int64(net.list_start[source]), np.int64(net.list_start[source + 1])


@kernel(error_model="numpy", forceinline=True)
def _from_list(net, cell, px, py, least, x, y):
    """The least squared distance of p to the blockers that cell ``cell`` knows, where that is less than
    ``least``: (squared, the place on the blocker: x, y)."""
    blocker = net.blocker
    first, last = _list_of(net, cell)
    for k in range(first, last):
        ax, ay = blocker[k, 0], blocker[k, 1]
        ex, ey = blocker[k, 2] - ax, blocker[k, 3] - ay
        length = ex * ex + ey * ey
        t = ((px - ax) * ex + (py - ay) * ey) / length if length > 0.0 else 0.0
        t = 0.0 if t < 0.0 else (1.0 if t > 1.0 else t)
        dx = ax + t * ex - px
        dy = ay + t * ey - py
        off = dx * dx + dy * dy
        if off < least:
            least, x, y = off, ax + t * ex, ay + t * ey
    return least, x, y


@kernel(error_model="numpy", forceinline=True)
def _along_list(net, cell, px, py, ux, uy, stretch, gap, s, x, y):
    """The least distance of a line, ``stretch`` [m] long from p along the unit vector u, to the blockers in
    the list of cell ``cell``, where that is less than ``gap``: (distance, where on the line [m], the place
    on the blocker: x, y)."""
    blocker = net.blocker
    first, last = _list_of(net, cell)
    for k in range(first, last):
        # the blocker's ends as seen from p: how far ahead, and how far to the side
        dx, dy = blocker[k, 0] - px, blocker[k, 1] - py
        ax, ay = dx * ux + dy * uy, dy * ux - dx * uy
        dx, dy = blocker[k, 2] - px, blocker[k, 3] - py
        bx, by = dx * ux + dy * uy, dy * ux - dx * uy
        if min(ay, by) >= gap or max(ay, by) <= -gap or min(ax, bx) >= stretch + gap or max(ax, bx) <= -gap:
            continue
        ex, ey = bx - ax, by - ay
        if ay * by <= 0.0 and ey != 0.0:
            on = ax - ay / ey * ex
            if 0.0 <= on <= stretch:
                return 0.0, on, px + on * ux, py + on * uy
        on = 0.0 if ax < 0.0 else (stretch if ax > stretch else ax)
        least, place, t = (ax - on) * (ax - on) + ay * ay, on, 0.0
        length = ex * ex + ey * ey
        if length > 0.0:
            on = 0.0 if bx < 0.0 else (stretch if bx > stretch else bx)
            off = (bx - on) * (bx - on) + by * by
            if off < least:
                least, place, t = off, on, 1.0
            for end in range(2):
                on = stretch if end == 1 else 0.0
                w = ((on - ax) * ex - ay * ey) / length
                if 0.0 < w < 1.0:
                    off = (ax + w * ex - on) * (ax + w * ex - on) + (ay + w * ey) * (ay + w * ey)
                    if off < least:
                        least, place, t = off, on, w
        # roots are rounded: of blockers that are equally far the first counts, however often they are asked
        if least < gap * gap and sqrt(least) < gap:
            gap, s = sqrt(least), place
            x = blocker[k, 0] + t * (blocker[k, 2] - blocker[k, 0])
            y = blocker[k, 1] + t * (blocker[k, 3] - blocker[k, 1])
    return gap, s, x, y


@kernel(error_model="numpy", forceinline=True)
def _around(net, k, column, right, up):
    """Cell ``k`` of ``column``, those beside it in the directions ``right`` and ``up``, and the one between
    these; -1 for one that is not there, or has no list of blockers, or the same as one before."""
    source = net.source
    side, other = over(net, k, column, right), over(net, k, column, up)
    corner = np.int64(-1)
    if side >= 0:
        corner = over(net, side, column + net.ny if right == 0 else column - net.ny, up)
    elif other >= 0:
        corner = over(net, other, column + 1 if up == 1 else column - 1, right)
    first = source[k]
    second = source[side] if side >= 0 else first
    third = source[other] if other >= 0 else first
    fourth = source[corner] if corner >= 0 else first
    if fourth == first or fourth == second or fourth == third:
        corner = -1
    if third == first or third == second:
        other = -1
    if second == first:
        side = -1
    return np.int64(k), side, other, corner


@kernel(error_model="numpy")
def stretch_gap(net, k, column, cx, cy, ax, ay, ux, uy, low, high, most):
    """Least distance to where walking ends from the stretch of a line, from ``low`` to ``high`` [m] along the
    unit vector u from a, inside cell ``k`` of ``column`` with its centre at c.

    The lists of the cell and of its neighbours on the stretch's side are asked. u may be 0 where the stretch
    is a point. Returns (gap [m], where on the line [m], the place where walking ends: x, y), with the gap
    ``most`` where it is not less than that.
    """
    px, py = ax + low * ux, ay + low * uy
    middle = 0.5 * (high - low)
    right = 0 if px + middle * ux > cx else 2
    up = 1 if py + middle * uy > cy else 3
    here, side, other, corner = _around(net, k, column, right, up)
    stretch = high - low
    if ux == 0.0 and uy == 0.0:
        ux = 1.0
    gap, s, x, y = most, 0.0, np.inf, np.inf
    for cell in (here, side, other, corner):
        if cell >= 0:
            gap, s, x, y = _along_list(net, cell, px, py, ux, uy, stretch, gap, s, x, y)
    return gap, low + s, x, y


@kernel(error_model="numpy", forceinline=True)
def middle_of_column(net, column):
    """x and y of the centre of the square of ``column``."""
    ix = column // net.ny
    return (ix + 0.5) * net.cell, (column - ix * net.ny + 0.5) * net.cell


@kernel(error_model="numpy", forceinline=True)
def centre_of(net, k):
    """x and y of the centre of cell ``k``."""
    return middle_of_column(net, column_of(net, k))


@kernel(error_model="numpy")
def gap_at(net, k, x, y):
    """`gap_in` of a cell whose column is yet to be looked up."""
    return gap_in(net, k, column_of(net, k), x, y)


@kernel(error_model="numpy", forceinline=True)
def gap_in(net, k, column, x, y):
    """Distance [m] from (x, y), a point in cell ``k`` of ``column``, to the nearest place where walking ends,
    and that place."""
    cx, cy = middle_of_column(net, column)
    here, side, other, corner = _around(net, k, column, 0 if x > cx else 2, 1 if y > cy else 3)
    square, qx, qy = np.inf, np.inf, np.inf
    for cell in (here, side, other, corner):
        if cell >= 0:
            square, qx, qy = _from_list(net, cell, x, y, square, qx, qy)
    return sqrt(square), qx, qy


@kernel(error_model="numpy")
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
        off = abs(height_in(net, column, k) - z)
        if off < least:
            least = off
            best = k
    return best


@kernel(error_model="numpy", forceinline=True)
def same_place(net, k, other):
    """Whether a point that lies in cell ``k`` by one reckoning and in ``other`` by another is one place: on
    the border between squares, or on a corner of four, rounding decides, but they are linked."""
    if k == other:
        return True
    for way in range(4):
        beside = linked(net, k, way)
        if beside == other:
            return True
        if beside >= 0 and (
            linked(net, beside, (way + 1) % 4) == other or linked(net, beside, (way + 3) % 4) == other
        ):
            return True
    return False


@kernel(error_model="numpy", forceinline=True)
def slope_at(net, k):
    """Slope of the floor in cell ``k``, dz/dx and dz/dy, in single precision."""
    slope_x, slope_y = gradient_of(net, k)
    return np.float32(slope_x), np.float32(slope_y)


@kernel(error_model="numpy")
def floor_at(net, k, x, y):
    """Height [m] of the floor at (x, y) in cell ``k``: the plane through its centre."""
    column = column_of(net, k)
    cx, cy = middle_of_column(net, column)
    slope_x, slope_y = gradient_in(net, column, k)
    level = height_in(net, column, k)
    return level + np.float32(slope_x) * (x - cx) + np.float32(slope_y) * (y - cy)


@kernel(error_model="numpy", forceinline=True)
def _leaves(cx, cy, room, ax, ay, ux, uy, s):
    """How far [m] from a the line along the unit vector u leaves the disc of radius ``room`` about c; -1
    where it is not in it at ``s``."""
    dx = ax + s * ux - cx
    dy = ay + s * uy - cy
    along = dx * ux + dy * uy
    spare = room * room - dx * dx - dy * dy
    return s - along + sqrt(along * along + spare) if spare >= 0.0 and room > 0.0 else -1.0


@kernel(error_model="numpy", forceinline=True)
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


@kernel(error_model="numpy", forceinline=True)
def fetch_cell(net, k):
    """Ask for the memory that walking over cell ``k`` takes."""
    fetch(net.label, k)
    fetch(net.clearance, k)
    fetch(net.source, k)
    fetch(net.storey, k)


@kernel(error_model="numpy")
def walk(net, k, ax, ay, bx, by, radius, through):
    """Walk the straight line from a, a point in cell ``k``, to b over linked cells.

    A body of ``radius`` fits where the gap is at least the radius. With ``through`` the walk goes on where it
    does not fit, to find the tightest place, and ends only where no link leads on (gap -1).

    Returns (reached, cell where it ended, least gap [m], its place on the line (0 to 1), the place where
    walking ends there: x, y, the cell in which it is tightest). Gaps of the radius and more are not told
    apart: the least gap is 1e300 then.
    """
    h, ny = net.cell, net.ny
    clearance, label = net.clearance, net.label
    position, node_radius, column_start = net.position, net.node_radius, net.column_start
    per_h = 1.0 / h
    dx = bx - ax
    dy = by - ay
    length = sqrt(dx * dx + dy * dy)
    per_length = 1.0 / length if length > 0.0 else 0.0
    ux = dx * per_length
    uy = dy * per_length
    column = column_of(net, k)
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
    least, most = 1e300, radius
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
                    gap, where, px, py = stretch_gap(
                        net, k, ix * ny + iy, cx, cy, ax, ay, ux, uy, s, leave, most
                    )
                    if gap < most:
                        least = most = gap
                        place, qx, qy, tight = where, px, py, k
                        if not through:
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
                    fetch_cell(net, k)
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
            following = over(net, k, ix * ny + iy, way_x)
            ix += turn_x
            ahead_x = ix + 2 * turn_x
            if 0 <= ahead_x < net.nx:  # most columns have one cell
                fetch_cell(net, np.int64(column_start[ahead_x * ny + iy]))
        else:
            s = next_y
            next_y += step_y
            following = over(net, k, ix * ny + iy, way_y)
            iy += turn_y
        if following < 0:
            return False, k, -1.0, s * per_length, ax + s * ux, ay + s * uy, tight
        k = following
