"""The plane geometry of string pulling: the funnel over the portals, and corners that lead a line round."""

from math import sqrt

from surefoot.kernels import kernel

__all__ = ["funnel", "round_corner", "tangents"]

_SHARP = 0.5
"""Cosine of the turn up to which one corner rounds it; sharper turns get two."""


@kernel(error_model="numpy", forceinline=True)
def _turn(ax, ay, bx, by, cx, cy):
    """Twice the area of a-b-c, positive where c lies to the left of a-b."""
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


@kernel(error_model="numpy")
def funnel(doors, edges, first, last, narrow, work, at, base, sx, sy, gx, gy):
    """Corners of the shortest line through the portals edges[first:last]; returns how many, ends included.

    With ``narrow`` through their lenses only. From row ``base`` on it writes x, y into work (n, 2) and into
    at (n,) twice the index of the portal that each corner is an end of, plus 1 for a right end (the start
    counts as portal first - 1, the goal as last); last - first + 2 rows are enough.
    """
    portal, lens = doors.portal, doors.lens
    work[base, 0], work[base, 1] = sx, sy
    at[base] = 2 * (first - 1)
    count = base + 1
    ax, ay = sx, sy
    lx, ly, lat = sx, sy, first - 1
    rx, ry, rat = sx, sy, first - 1
    i = first
    while i <= last:
        nlx, nly, nrx, nry = gx, gy, gx, gy
        if i < last:
            door = edges[i]
            nlx, nly = portal[door, 0], portal[door, 1]
            nrx, nry = portal[door, 3], portal[door, 4]
            if narrow:
                t, u = lens[door, 0], lens[door, 1]
                dx, dy = nrx - nlx, nry - nly
                nrx, nry = nlx + u * dx, nly + u * dy
                nlx, nly = nlx + t * dx, nly + t * dy
        if _turn(ax, ay, rx, ry, nrx, nry) >= 0.0:
            if (ax == rx and ay == ry) or _turn(ax, ay, lx, ly, nrx, nry) < 0.0:
                rx, ry, rat = nrx, nry, i
            else:
                ax, ay = lx, ly
                if first <= lat < last:
                    work[count, 0], work[count, 1] = lx, ly
                    at[count] = 2 * lat
                    count += 1
                rx, ry, rat = lx, ly, lat
                i = lat + 1
                continue
        if _turn(ax, ay, lx, ly, nlx, nly) <= 0.0:
            if (ax == lx and ay == ly) or _turn(ax, ay, rx, ry, nlx, nly) > 0.0:
                lx, ly, lat = nlx, nly, i
            else:
                ax, ay = rx, ry
                if first <= rat < last:
                    work[count, 0], work[count, 1] = rx, ry
                    at[count] = 2 * rat + 1
                    count += 1
                lx, ly, lat = rx, ry, rat
                i = rat + 1
                continue
        i += 1
    work[count, 0], work[count, 1] = gx, gy
    at[count] = 2 * last
    return count + 1 - base


@kernel(error_model="numpy", forceinline=True)
def _between(ax, ay, bx, by, qx, qy, radius, arc):
    """Corners of a line that touches the circle of ``radius`` about q from outside, first where the unit
    normal a points to, last where b does: they lie where the tangents meet.

    Writes them into arc (2, 2) and returns how many: the sharper the turn, the more; 0 for turns right back.
    """
    dot = ax * bx + ay * by
    if dot >= _SHARP:
        share = radius / (1.0 + dot)
        arc[0, 0], arc[0, 1] = qx + share * (ax + bx), qy + share * (ay + by)
        return 1
    if dot < -0.99:
        return 0
    half = 1.0 / sqrt(2.0 + 2.0 * dot)
    mx, my = half * (ax + bx), half * (ay + by)
    share = radius / (1.0 + ax * mx + ay * my)
    arc[0, 0], arc[0, 1] = qx + share * (ax + mx), qy + share * (ay + my)
    arc[1, 0], arc[1, 1] = qx + share * (bx + mx), qy + share * (by + my)
    return 2


@kernel(error_model="numpy")
def round_corner(work, i, side, qx, qy, radius, arc):
    """Corners that lead the funnel's line, at its corner ``i``, round q at the distance ``radius``: those of
    the line that is parallel to it before and after. See `_between`; 0 where q is not on the inner side of
    the turn."""
    ax, ay = work[i, 0] - work[i - 1, 0], work[i, 1] - work[i - 1, 1]
    bx, by = work[i + 1, 0] - work[i, 0], work[i + 1, 1] - work[i, 1]
    a, b = sqrt(ax * ax + ay * ay), sqrt(bx * bx + by * by)
    if a < 1e-9 or b < 1e-9:
        return 0
    # unit normals of both lines, away from q
    way = 1.0 if side == 0 else -1.0
    ax, ay = way * ay / a, -way * ax / a
    bx, by = way * by / b, -way * bx / b
    if (work[i, 0] - qx) * (ax + bx) + (work[i, 1] - qy) * (ay + by) <= 0.0:
        return 0
    return _between(ax, ay, bx, by, qx, qy, radius, arc)


@kernel(error_model="numpy")
def tangents(ax, ay, x, y, bx, by, qx, qy, radius, arc):
    """Corners that lead a line from a to b, which is too close to q at (x, y), round q at the distance
    ``radius`` on the side that it passes q on. See `_between`; 0 where a or b is in the circle."""
    ax, ay, bx, by, x, y = ax - qx, ay - qy, bx - qx, by - qy, x - qx, y - qy
    a, b = ax * ax + ay * ay, bx * bx + by * by
    square = radius * radius
    if min(a, b) <= square * (1.0 + 1e-6):
        return 0
    way = 1.0 if ax * y - ay * x > 0.0 else -1.0
    # where the tangent from a touches: turned from a by the angle whose cosine is radius / |a|
    c, s = radius / a, way * sqrt(a - square) / a
    ax, ay = c * ax - s * ay, s * ax + c * ay
    c, s = radius / b, -way * sqrt(b - square) / b
    bx, by = c * bx - s * by, s * bx + c * by
    return _between(ax, ay, bx, by, qx, qy, radius, arc)
