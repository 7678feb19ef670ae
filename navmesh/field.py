"""The clearance field between cell centres: how far a point or a stretch of a line is from where walking
ends.

Every cell keeps the vector from its centre to the nearest place where walking ends. That place gives the
distance from anywhere in the cell; the cells to the sides are asked too where a cell is narrow, because
across the middle of a passage they know the other wall. All coordinates are relative to the surface's origin,
all distances are horizontal [m].
"""

from math import sqrt

from numba import njit

__all__ = ["cell_at", "centre_of", "floor_at", "gap_at", "same_place", "stretch_gap", "walk"]

_OPEN = 2.0
"""[cells] of clearance beyond the radius and the cell's corners from which a walk takes it in one step."""


@njit(cache=True, inline="always")
def _point_gap(vx, vy, ax, ay, bx, by):
    """Least distance from the stretch a-b to the point v, and where on the stretch (0 to 1) it is."""
    dx = bx - ax
    dy = by - ay
    length = dx * dx + dy * dy
    s = 0.0
    if length > 0.0:
        s = ((vx - ax) * dx + (vy - ay) * dy) / length
        s = 0.0 if s < 0.0 else (1.0 if s > 1.0 else s)
    ex = ax + s * dx - vx
    ey = ay + s * dy - vy
    return sqrt(ex * ex + ey * ey), s


@njit(cache=True, inline="always")
def stretch_gap(net, k, ax, ay, bx, by):
    """Least distance to where walking ends along a-b, a stretch inside cell ``k`` (relative to its centre).

    Returns (gap, where on the stretch, the place where walking ends, relative to the cell's centre: x, y).
    """
    h = net.cell
    qx = net.nearest[k, 0]
    qy = net.nearest[k, 1]
    gap, where = _point_gap(qx, qy, ax, ay, bx, by)
    mx = ax + bx
    my = ay + by
    side = net.link[k, 0 if mx > 0.0 else 2]
    if side >= 0:
        vx = net.nearest[side, 0] + (h if mx > 0.0 else -h)
        vy = net.nearest[side, 1]
        other, s = _point_gap(vx, vy, ax, ay, bx, by)
        if other < gap:
            gap, where, qx, qy = other, s, vx, vy
    side = net.link[k, 1 if my > 0.0 else 3]
    if side >= 0:
        vx = net.nearest[side, 0]
        vy = net.nearest[side, 1] + (h if my > 0.0 else -h)
        other, s = _point_gap(vx, vy, ax, ay, bx, by)
        if other < gap:
            gap, where, qx, qy = other, s, vx, vy
    return gap, where, qx, qy


@njit(cache=True, inline="always")
def centre_of(net, k):
    """x and y of the centre of cell ``k``."""
    column = net.cell_column[k]
    ix = column // net.ny
    return (ix + 0.5) * net.cell, (column - ix * net.ny + 0.5) * net.cell


@njit(cache=True)
def gap_at(net, k, x, y):
    """Distance [m] from (x, y), a point in cell ``k``, to the nearest place where walking ends, and that
    place."""
    cx, cy = centre_of(net, k)
    gap, _, qx, qy = stretch_gap(net, k, x - cx, y - cy, x - cx, y - cy)
    return gap, cx + qx, cy + qy


@njit(cache=True)
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


@njit(cache=True, inline="always")
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


@njit(cache=True)
def floor_at(net, k, x, y):
    """Height [m] of the floor at (x, y) in cell ``k``: the plane through its centre."""
    cx, cy = centre_of(net, k)
    return net.height[k] + net.gradient[k, 0] * (x - cx) + net.gradient[k, 1] * (y - cy)


@njit(cache=True, inline="always")
def _only_cell(net, x, y):
    """The cell under (x, y) and its place in the grid where there is one storey only, else -1."""
    ix = int(x / net.cell)
    iy = int(y / net.cell)
    column = ix * net.ny + iy
    first = net.column_start[column]
    return (first if net.column_start[column + 1] == first + 1 else -1), ix, iy


@njit(cache=True)
def walk(net, k, ax, ay, bx, by, radius, through):
    """Walk the straight line from a, a point in cell ``k``, to b over linked cells.

    A body of ``radius`` fits where the gap is at least the radius. With ``through`` the walk goes on where it
    does not fit, to find the tightest place, and ends only where no link leads on (gap -1).

    Returns (reached, cell where it ended, least gap [m], its place on the line (0 to 1), the place where
    walking ends there: x, y). Gaps are measured only where a cell's clearance is close to the radius; where
    none was measured the least gap is 1e300.
    """
    h = net.cell
    dx = bx - ax
    dy = by - ay
    column = net.cell_column[k]
    ix = column // net.ny
    iy = column - ix * net.ny
    step_x = 1e300
    step_y = 1e300
    next_x = 1e300
    next_y = 1e300
    way_x = 2
    way_y = 3
    if dx > 0.0:
        step_x = h / dx
        next_x = ((ix + 1) * h - ax) / dx
        way_x = 0
    elif dx < 0.0:
        step_x = -h / dx
        next_x = (ix * h - ax) / dx
    if dy > 0.0:
        step_y = h / dy
        next_y = ((iy + 1) * h - ay) / dy
        way_y = 1
    elif dy < 0.0:
        step_y = -h / dy
        next_y = (iy * h - ay) / dy
    length = sqrt(dx * dx + dy * dy)
    inverse = 1.0 / length if length > 0.0 else 0.0
    free = radius + 0.7072 * h
    open_ = free + _OPEN * h
    least = 1e300
    place = 0.0
    qx = 0.0
    qy = 0.0
    t = 0.0
    while True:
        leave = min(next_x, next_y, 1.0)
        clearance = net.clearance[k]
        if clearance < free:
            cx = (ix + 0.5) * h
            cy = (iy + 0.5) * h
            ux, uy = ax + t * dx - cx, ay + t * dy - cy
            vx, vy = ax + leave * dx - cx, ay + leave * dy - cy
            spare = clearance - radius
            if spare < 0.0 or max(ux * ux + uy * uy, vx * vx + vy * vy) > spare * spare:
                gap, s, px, py = stretch_gap(net, k, ux, uy, vx, vy)
                if gap < least:
                    least = gap
                    place = t + s * (leave - t)
                    qx = cx + px
                    qy = cy + py
                    if gap < radius and not through:
                        return False, k, least, place, qx, qy
        if leave >= 1.0:
            return True, k, least, place, qx, qy
        if clearance > open_:
            # nothing ends walking within the clearance: on to the end of what is free of it
            ahead = min(t + (clearance - free) * inverse, 1.0)
            cell, jx, jy = _only_cell(net, ax + ahead * dx, ay + ahead * dy)
            if cell >= 0:
                k, ix, iy = cell, jx, jy
                if ahead >= 1.0:
                    return True, k, least, place, qx, qy
                t = ahead
                if way_x == 0:
                    next_x = ((ix + 1) * h - ax) / dx
                elif dx < 0.0:
                    next_x = (ix * h - ax) / dx
                if way_y == 1:
                    next_y = ((iy + 1) * h - ay) / dy
                elif dy < 0.0:
                    next_y = (iy * h - ay) / dy
                continue
        if next_x < next_y:
            t = next_x
            next_x += step_x
            following = net.link[k, way_x]
            ix += 1 - way_x
        else:
            t = next_y
            next_y += step_y
            following = net.link[k, way_y]
            iy += 2 - way_y
        if following < 0:
            return False, k, -1.0, t, ax + t * dx, ay + t * dy
        k = following
