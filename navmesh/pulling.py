"""String pulling: from the chain of discs that A* chose to the line that a body walks.

1. The funnel over the portals gives the corners that the line has to turn at.
2. The line is walked through the clearance field. Where the body would not fit, the tightest place is pushed
   off what blocks it, just so far that the body fits, and the two halves are walked again. Where nothing can
   be pushed because walking ends on the line, the cells themselves are searched.
3. Corners that the line of sight jumps over are dropped; corners that stand further off than they need are
   drawn in.

What comes out has been walked: the body fits on all of it.
"""

from math import sqrt

import numpy as np
from numba import njit

from navmesh.detour import detour
from navmesh.field import floor_at, gap_at, same_place, walk

__all__ = ["grow", "pull"]

_SLACK = 0.01
"""Share of the radius kept on top of it where there is room: discs of the corridor hold the path inside."""
_MARGIN = 0.03
"""Pushed corners keep this share of the radius more than it, so that straight lines between them clear round
corners."""
_LOOSE = 0.1
"""A corner whose gap is above the radius by more than this share is drawn in."""
_DEPTH = 12  # of pushes within pushes; scratch.stack holds two more


@njit(cache=True)
def grow(scratch, count):
    """Make room for one more corner after ``count``."""
    if count < scratch.cells.size:
        return
    room = 2 * scratch.cells.size
    points = np.empty((room, 3), np.float64)
    points[:count] = scratch.points[:count]
    scratch.points = points
    cells = np.empty(room, np.int32)
    cells[:count] = scratch.cells[:count]
    scratch.cells = cells


@njit(cache=True, inline="always")
def _turn(ax, ay, bx, by, cx, cy):
    """Twice the area of a-b-c, positive where c lies to the left of a-b."""
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


@njit(cache=True)
def _funnel(doors, edges, first, last, work, cells, at, sx, sy, start_cell, gx, gy, goal_cell):
    """Corners of the shortest line through the portals edges[first:last]; returns how many, ends included.

    Writes x, y into work (n, 2), cells (n,) and into at (n,) the index of the portal that each corner is an
    end of (first - 1 for the start, last for the goal); all need last - first + 2 rows.
    """
    work[0, 0], work[0, 1] = sx, sy
    cells[0] = start_cell
    at[0] = first - 1
    count = 1
    ax, ay = sx, sy
    lx, ly, lcell, lat = sx, sy, start_cell, first - 1
    rx, ry, rcell, rat = sx, sy, start_cell, first - 1
    i = first
    while i <= last:
        if i < last:
            door = edges[i]
            nlx, nly, nlcell = doors.portal[door, 0], doors.portal[door, 1], doors.portal_cell[door, 0]
            nrx, nry, nrcell = doors.portal[door, 3], doors.portal[door, 4], doors.portal_cell[door, 1]
        else:
            nlx, nly, nlcell = gx, gy, goal_cell
            nrx, nry, nrcell = gx, gy, goal_cell
        if _turn(ax, ay, rx, ry, nrx, nry) >= 0.0:
            if (ax == rx and ay == ry) or _turn(ax, ay, lx, ly, nrx, nry) < 0.0:
                rx, ry, rcell, rat = nrx, nry, nrcell, i
            else:
                ax, ay = lx, ly
                work[count, 0], work[count, 1] = lx, ly
                cells[count] = lcell
                at[count] = lat
                count += 1
                rx, ry, rcell, rat = lx, ly, lcell, lat
                i = lat + 1
                continue
        if _turn(ax, ay, lx, ly, nlx, nly) <= 0.0:
            if (ax == lx and ay == ly) or _turn(ax, ay, rx, ry, nlx, nly) > 0.0:
                lx, ly, lcell, lat = nlx, nly, nlcell, i
            else:
                ax, ay = rx, ry
                work[count, 0], work[count, 1] = rx, ry
                cells[count] = rcell
                at[count] = rat
                count += 1
                lx, ly, lcell, lat = rx, ry, rcell, rat
                i = rat + 1
                continue
        i += 1
    work[count, 0], work[count, 1] = gx, gy
    cells[count] = goal_cell
    at[count] = last
    return count + 1


@njit(cache=True)
def _push(net, k, x, y, qx, qy, radius):
    """Move (x, y) in cell ``k`` away from (qx, qy) until the body fits with a margin; returns (fits, x, y,
    cell)."""
    target = radius * (1.0 + _MARGIN)
    enough = radius * (1.0 + _SLACK)
    gap = 0.0
    for _ in range(4):
        dx = x - qx
        dy = y - qy
        d = sqrt(dx * dx + dy * dy)
        if d < 1e-9:
            return False, x, y, k
        nx = qx + dx / d * target
        ny = qy + dy / d * target
        reached, cell, _, _, _, _ = walk(net, k, x, y, nx, ny, 0.0, True)
        if not reached:
            return False, x, y, k
        x, y, k = nx, ny, cell
        gap, qx, qy = gap_at(net, k, x, y)
        if gap >= enough:
            return True, x, y, k
    return gap >= radius, x, y, k


@njit(cache=True)
def _cost_along(net, doors, k, ax, ay, bx, by):
    """Length of the line from a, in cell ``k``, to b, weighted by the costs of the nodes that it crosses."""
    length = sqrt((bx - ax) ** 2 + (by - ay) ** 2)
    parts = int(length / (0.5 * net.cell)) + 1
    total = 0.0
    x, y = ax, ay
    for i in range(parts):
        px, py = ax + (bx - ax) * (i + 0.5) / parts, ay + (by - ay) * (i + 0.5) / parts
        k = walk(net, k, x, y, px, py, 0.0, True)[1]
        x, y = px, py
        node = net.label[k]
        total += length / parts * (doors.node_cost[node] if node >= 0 else 1.0)
    return total


@njit(cache=True)
def _append(net, doors, scratch, first, count, x, y, k):
    """Add a corner to the leg that begins at ``first``, dropping corners that the line of sight jumps
    over."""
    radius = doors.radius * (1.0 + _SLACK)
    points = scratch.points
    cells = scratch.cells
    while count - first >= 2:
        vx, vy = points[count - 1, 0], points[count - 1, 1]
        ax, ay = points[count - 2, 0], points[count - 2, 1]
        _, qx, qy = gap_at(net, cells[count - 1], vx, vy)
        dx = x - ax
        dy = y - ay
        length = dx * dx + dy * dy
        s = ((qx - ax) * dx + (qy - ay) * dy) / length if length > 0.0 else 0.0
        s = min(max(s, 0.0), 1.0)
        ex = ax + s * dx - qx
        ey = ay + s * dy - qy
        if ex * ex + ey * ey < radius * radius:
            break
        reached, cell, _, _, _, _ = walk(net, cells[count - 2], ax, ay, x, y, radius, False)
        if not reached or not same_place(net, cell, k):
            break
        if doors.weighted:
            a = cells[count - 2]
            bent = _cost_along(net, doors, a, ax, ay, vx, vy) + _cost_along(
                net, doors, cells[count - 1], vx, vy, x, y
            )
            if _cost_along(net, doors, a, ax, ay, x, y) > bent * (1.0 + 1e-9):
                break
        count -= 1
    grow(scratch, count + 1)
    scratch.points[count, 0] = x
    scratch.points[count, 1] = y
    scratch.cells[count] = k
    return count + 1


@njit(cache=True)
def _round(net, doors, scratch, low, high, ax, ay, bx, by, place):
    """A corner inside a disc that leads the line a-b round what ends walking at ``place`` on it.

    The disc is the one of nodes[low:high] that the place is deepest in; the corner is where it comes nearest
    to the line. Returns (found, x, y, cell).
    """
    x = ax + place * (bx - ax)
    y = ay + place * (by - ay)
    node = -1
    least = 1e300
    for i in range(low, high):
        other = scratch.nodes[i]
        dx = x - net.position[other, 0]
        dy = y - net.position[other, 1]
        power = dx * dx + dy * dy - net.node_radius[other] ** 2
        if power < least and net.node_radius[other] > doors.radius:
            least = power
            node = other
    if node < 0:
        return False, x, y, -1
    cx, cy = net.position[node, 0], net.position[node, 1]
    dx, dy = bx - ax, by - ay
    s = ((cx - ax) * dx + (cy - ay) * dy) / (dx * dx + dy * dy)
    s = min(max(s, 0.0), 1.0)
    dx, dy = ax + s * dx - cx, ay + s * dy - cy
    d = sqrt(dx * dx + dy * dy)
    room = net.node_radius[node] - doors.radius
    share = room / d if d > room else 1.0
    x, y = cx + share * dx, cy + share * dy
    reached, cell, _, _, _, _ = walk(net, net.node_cell[node], cx, cy, x, y, 0.0, True)
    return reached, x, y, cell


@njit(cache=True)
def _mend(net, doors, scratch, first, count, gx, gy, goal_cell, low, high):
    """Add a walked line from the leg's last corner to g, through nodes[low:high].

    Returns the new count and whether the body fits all along.
    """
    radius = doors.radius
    stack, stack_cell = scratch.stack, scratch.stack_cell
    stack[0, 0], stack[0, 1] = gx, gy
    stack_cell[0] = goal_cell
    height = 1
    while height > 0:
        k = scratch.cells[count - 1]
        ax, ay = scratch.points[count - 1, 0], scratch.points[count - 1, 1]
        bx, by = stack[height - 1, 0], stack[height - 1, 1]
        target = stack_cell[height - 1]
        reached, cell, gap, place, qx, qy = walk(net, k, ax, ay, bx, by, radius, True)
        walked = reached and same_place(net, cell, target)
        if walked and gap >= radius * (1.0 + _SLACK):
            count = _append(net, doors, scratch, first, count, bx, by, target)
            height -= 1
            continue
        if walked and height <= _DEPTH:
            x = ax + place * (bx - ax)
            y = ay + place * (by - ay)
            at = walk(net, k, ax, ay, x, y, 0.0, True)[1]
            pushed, x, y, at = _push(net, at, x, y, qx, qy, radius)
            if pushed and (x - ax) ** 2 + (y - ay) ** 2 > 1e-12 and (x - bx) ** 2 + (y - by) ** 2 > 1e-12:
                stack[height, 0], stack[height, 1] = x, y
                stack_cell[height] = at
                height += 1
                continue
        if walked and gap >= radius:
            count = _append(net, doors, scratch, first, count, bx, by, target)
            height -= 1
            continue
        if not walked and height <= _DEPTH:
            found, x, y, at = _round(net, doors, scratch, low, high, ax, ay, bx, by, place)
            if found and (x - ax) ** 2 + (y - ay) ** 2 > 1e-6 and (x - bx) ** 2 + (y - by) ** 2 > 1e-6:
                stack[height, 0], stack[height, 1] = x, y
                stack_cell[height] = at
                height += 1
                continue
        cells = detour(net, scratch, k, target, radius)
        if cells.size == 0:
            return count, False
        for step in range(1, cells.size - 1):
            at = cells[step]
            column = net.cell_column[at]
            ix = column // net.ny
            x = (ix + 0.5) * net.cell
            y = (column - ix * net.ny + 0.5) * net.cell
            if net.clearance[at] < radius:
                gap, qx, qy = gap_at(net, at, x, y)
                pushed, x, y, at = _push(net, at, x, y, qx, qy, radius)
            count = _append(net, doors, scratch, first, count, x, y, at)
        count = _append(net, doors, scratch, first, count, bx, by, target)
        height -= 1
    return count, True


@njit(cache=True)
def _draw_in(net, doors, scratch, first, count):
    """Move loose corners towards the line between their neighbours, as far as the body fits: the ends of a
    portal may stand off the wall that the line turns round."""
    radius = doors.radius * (1.0 + _SLACK)
    points, cells = scratch.points, scratch.cells
    for i in range(first + 1, count - 1):
        x, y = points[i, 0], points[i, 1]
        if gap_at(net, cells[i], x, y)[0] <= radius * (1.0 + _LOOSE):
            continue
        ax, ay = points[i - 1, 0], points[i - 1, 1]
        bx, by = points[i + 1, 0], points[i + 1, 1]
        dx, dy = bx - ax, by - ay
        length = dx * dx + dy * dy
        s = ((x - ax) * dx + (y - ay) * dy) / length if length > 0.0 else 0.0
        s = min(max(s, 0.0), 1.0)
        dx, dy = ax + s * dx - x, ay + s * dy - y
        low, high = 0.0, 1.0
        for _ in range(9):
            t = 0.5 * (low + high)
            cx, cy = x + t * dx, y + t * dy
            fits, cell, _, _, _, _ = walk(net, cells[i - 1], ax, ay, cx, cy, radius, False)
            if fits:
                fits, last, _, _, _, _ = walk(net, cell, cx, cy, bx, by, radius, False)
                fits = fits and same_place(net, last, cells[i + 1])
            if fits:
                low = t
                points[i, 0], points[i, 1] = cx, cy
                cells[i] = cell
            else:
                high = t


@njit(cache=True)
def pull(net, doors, scratch, first, last, count, gx, gy, goal_cell):
    """Pull one walked leg taut: from the last corner in ``scratch.points`` through the portals of
    edges[first:last].

    Returns the new number of corners and whether the goal was reached.
    """
    leg = count - 1
    room = last - first + 2
    if scratch.corner_cell.size < room:
        scratch.corner = np.empty((2 * room, 2), np.float64)
        scratch.corner_cell = np.empty(2 * room, np.int32)
        scratch.corner_at = np.empty(2 * room, np.int32)
    work, cells, at = scratch.corner, scratch.corner_cell, scratch.corner_at
    sx, sy = scratch.points[leg, 0], scratch.points[leg, 1]
    corners = _funnel(
        doors, scratch.edges, first, last, work, cells, at, sx, sy, scratch.cells[leg], gx, gy, goal_cell
    )
    radius = doors.radius
    for i in range(1, corners):
        x, y, k = work[i, 0], work[i, 1], cells[i]
        if i < corners - 1:
            gap, qx, qy = gap_at(net, k, x, y)
            if gap < radius * (1.0 + _MARGIN):
                pushed, px, py, pk = _push(net, k, x, y, qx, qy, radius)
                if pushed:
                    x, y, k = px, py, pk
        count, fits = _mend(net, doors, scratch, leg, count, x, y, k, at[i - 1], at[i])
        if not fits:
            return count, False
    if not doors.weighted:
        _draw_in(net, doors, scratch, leg, count)
    for i in range(leg, count):
        scratch.points[i, 2] = floor_at(net, scratch.cells[i], scratch.points[i, 0], scratch.points[i, 1])
    return count, True
