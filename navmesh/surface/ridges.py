"""The middle of narrow passages: places between cells' centres that are as far from one side as from the
other.

A door may be wider than a body and yet have no cell whose centre has the body's radius free. So where the
sides of a passage face each other, its middle is looked for on the line across, in the exact distances of
`navmesh.surface.clearance_field`.
"""

from math import sqrt

import numpy as np

from navmesh.surface.clearance_field import centre_of, gap_at, gap_in, middle_of_column, stretch_gap
from navmesh.surface.columns import column_of
from navmesh.surface.recall import nearest_in, nearly_nearest_in
from navmesh.surface.storeys import linked, over
from surefoot.kernels import kernel

__all__ = ["half_width", "middle", "middle_beside", "widest_through"]

_HALVINGS = 7


@kernel(error_model="numpy", forceinline=True)
def _half_width(field, c):
    """`half_width` where `nearest` is kept."""
    vx, vy = field.nearest[c, 0], field.nearest[c, 1]
    least = np.inf
    for d in range(4):
        n = linked(field, c, d)
        wx = ((1 if d == 0 else 0) - (1 if d == 2 else 0)) * field.cell
        wy = ((1 if d == 1 else 0) - (1 if d == 3 else 0)) * field.cell
        if n >= 0:
            wx += field.nearest[n, 0]
            wy += field.nearest[n, 1]
        if vx * wx + vy * wy < -1e-6:
            least = min(least, (vx - wx) * (vx - wx) + (vy - wy) * (vy - wy))
    return 0.5 * sqrt(least)


@kernel(error_model="numpy")
def half_width(field, c):
    """Half the distance [m] between the places on opposite sides of cell ``c`` where walking ends, as its
    neighbours know them: no wider body passes there. inf where it is not between two sides."""
    if field.nearest.shape[0] > 0:
        return _half_width(field, c)
    column = column_of(field, c)
    vx, vy = nearly_nearest_in(field, c, column)
    far, source = field.clearance[c] >= 2.0 * field.cell, field.source[c]
    exact = not far  # whether v is known to the last bit
    least = np.inf
    for d in range(4):
        n = over(field, c, column, d)
        across, along = (
            (1 if d == 0 else 0) - (1 if d == 2 else 0),
            (1 if d == 1 else 0) - (1 if d == 3 else 0),
        )
        hx, hy, beside = across * field.cell, along * field.cell, column + across * field.ny + along
        wx, wy = 0.0, 0.0
        if n >= 0:
            beyond = field.clearance[n] >= 2.0 * field.cell
            if far and beyond and field.source[n] == source:
                continue  # both look to the same place
            wx, wy = nearly_nearest_in(field, n, beside)
            if vx * (hx + wx) + vy * (hy + wy) > 0.0:
                continue
            if beyond:
                wx, wy = nearest_in(field, n, beside)
        if not exact:
            vx, vy = nearest_in(field, c, column)
            exact = True
        wx, wy = hx + wx, hy + wy
        if vx * wx + vy * wy < -1e-6:
            least = min(least, (vx - wx) * (vx - wx) + (vy - wy) * (vy - wy))
    return 0.5 * sqrt(least)


@kernel(error_model="numpy", forceinline=True)
def _under(field, k, column, x, y):
    """The cell linked to cell ``k`` of ``column`` that (x, y), at most a cell away, is in, ``k`` where there
    is none; and its column."""
    k = np.int64(k)
    cx, cy = middle_of_column(field, column)
    half = 0.5 * field.cell
    across = 0 if x - cx > half else (2 if cx - x > half else -1)
    along = 1 if y - cy > half else (3 if cy - y > half else -1)
    if across < 0 and along < 0:
        return k, column
    step = field.ny if across == 0 else (-field.ny if across == 2 else 0)
    turn = 1 if along == 1 else (-1 if along == 3 else 0)
    if across < 0 or along < 0:
        beside = over(field, k, column, max(across, along))
        return (beside, column + step + turn) if beside >= 0 else (k, column)
    beside, other = over(field, k, column, across), np.int64(-1)
    corner = over(field, beside, column + step, along) if beside >= 0 else np.int64(-1)
    if corner < 0:
        other = over(field, k, column, along)
        corner = over(field, other, column + turn, across) if other >= 0 else np.int64(-1)
    if corner >= 0:
        return corner, column + step + turn
    if beside >= 0:
        return beside, column + step
    return (other, column + turn) if other >= 0 else (k, column)


@kernel(error_model="numpy")
def middle(field, k, x, y, room):
    """The place on the way from what is nearest to (x, y), over (x, y) and at most ``room`` [m] on, that is
    farthest from where walking ends: (cell, x, y, distance). ``k`` is the cell of (x, y) or one beside it."""
    start, column = _under(field, k, column_of(field, k), x, y)
    gap, qx, qy = gap_in(field, start, column, x, y)
    if not 1e-9 < gap < np.inf:
        return start, x, y, gap
    ux, uy = (x - qx) / gap, (y - qy) / gap
    near, far = 0.0, room
    for _ in range(_HALVINGS):
        s = 0.5 * (near + far)
        px, py = x + s * ux, y + s * uy
        at, beside = _under(field, start, column, px, py)
        beyond, qx, qy = gap_in(field, at, beside, px, py)
        if (qx - x) * ux + (qy - y) * uy > 0.0:  # something ahead is nearer, or has been passed
            far = s
        else:
            near, gap = s, beyond
    x, y = x + near * ux, y + near * uy
    return _under(field, start, column, x, y)[0], x, y, gap


@kernel(error_model="numpy")
def middle_beside(field, c):
    """The middle of the passage on the line across it through the centre of cell ``c``, and the linked cell
    that it is in: (cell, x, y, distance to its sides)."""
    x, y = centre_of(field, c)
    return middle(field, c, x, y, field.cell)


@kernel(error_model="numpy")
def _least_gap(field, k, ax, ay, bx, by):
    """Least distance to where walking ends on the line from a, in cell ``k``, to b, at most a cell away."""
    length = sqrt((bx - ax) ** 2 + (by - ay) ** 2)
    if length < 1e-9:
        return gap_at(field, k, ax, ay)[0]
    ux, uy = (bx - ax) / length, (by - ay) / length
    least, column = np.inf, column_of(field, k)
    for part in range(2):
        low, high = 0.5 * part * length, 0.5 * (part + 1) * length
        k, column = _under(field, k, column, ax + 0.5 * (low + high) * ux, ay + 0.5 * (low + high) * uy)
        cx, cy = middle_of_column(field, column)
        least = stretch_gap(field, k, column, cx, cy, ax, ay, ux, uy, low, high, least)[0]
    return least


@kernel(error_model="numpy")
def widest_through(field, c, n, least):
    """Where the widest body passes from cell ``c`` to the linked cell ``n`` between opposite sides, and its
    radius: (x, y, radius).

    The place is in the middle of the passage between the cells. The body comes from the middle beside the one
    cell, follows half a cell of the passage to either side of the place, and goes to that beside the other.
    Where the radius is at most ``least``, it may be anything up to that.
    """
    h = field.cell
    ax, ay = centre_of(field, c)
    bx, by = centre_of(field, n)
    k, x, y, gap = middle(field, c, 0.5 * (ax + bx), 0.5 * (ay + by), 0.75 * h)
    if not least < gap < np.inf:
        return x, y, least
    _, qx, qy = gap_at(field, k, x, y)
    across_x, across_y = (x - qx) / gap, (y - qy) / gap
    along = 0.5 * h if across_y * (ax - bx) - across_x * (ay - by) > 0.0 else -0.5 * h  # towards c
    radius = np.inf
    for end in range(2):
        off = along if end == 0 else -along
        k_end, ex, ey = (c, ax, ay) if end == 0 else (n, bx, by)
        _, px, py, _ = middle(field, k, x + off * across_y, y - off * across_x, 0.5 * h)
        radius = min(radius, _least_gap(field, k, x, y, px, py))
        if radius <= least:
            return x, y, least
        k_end, ex, ey, _ = middle(field, k_end, ex, ey, h)
        radius = min(radius, _least_gap(field, k_end, ex, ey, px, py))
        if radius <= least:
            return x, y, least
    return x, y, radius
