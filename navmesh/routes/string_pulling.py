"""String pulling: from the chain of discs that A* chose to the line that a body walks.

1. The funnel over the portals gives the corners that the line has to turn at. Each is rounded: put where the
   line before it and the one after it touch the circle of the body's radius round what it turns about.
2. The line is walked through the clearance field. Where the body would not fit, the line is led round what
   blocks it, along the tangents to the circle of the body's radius about that, or its tightest place is
   pushed off, just so far that the body fits; the parts are walked again. Where walking ends on the line, it
   is pulled through the lenses of the portals instead, which lie in the discs; where discs do not overlap
   either, the cells themselves are searched.
3. Corners that the line of sight jumps over are dropped, and those that nothing holds are let go
   (`navmesh.routes.tightening`), unless nodes have costs.

What comes out has been walked: the body fits on all of it.
"""

from math import sqrt

import numpy as np

from navmesh.graph.portals import MARGIN
from navmesh.routes.cell_search import over_cells
from navmesh.routes.foresight import fetch_corners, fetch_line
from navmesh.routes.funnel import funnel, round_corner
from navmesh.routes.leading_round import SLACK, lead_round, round_in_disc
from navmesh.routes.tightening import tighten
from navmesh.routes.walked_line import append_corner
from navmesh.surface.clearance_field import floor_at, gap_at, same_place, walk
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["CELLS", "DISCS", "FITS", "LINES", "mend", "pull"]

FITS, _BLOCKED, _NO_WAY = range(3)
"""What can come of mending a line."""
LINES, DISCS, CELLS = range(3)
"""What is tried where walking ends on a line: to lead it through the discs where it comes near them; also
where it does not; also a search over cells."""
_ROUNDS = 4
"""Times that a line is led round what ends walking on it before it is pulled through the lenses."""
_DEPTH = 12  # of pushes within pushes; scratch.stack holds two more
_ON = 1.0
"""[m] beyond what ends walking on a line, to which the cells are searched if there is a portal."""
_SPLITS = 64  # of one line: corners that fall away when the next is added could take turns for ever


@kernel(error_model="numpy")
def _place_of(net, doors, door, side, x, y):
    """The cell of (x, y), a place on a portal or beside its left (0) or right (1) end."""
    ex, ey = doors.portal[door, 3 * side], doors.portal[door, 3 * side + 1]
    return walk(net, np.int64(doors.portal_cell[door, side]), ex, ey, x, y, 0.0, True)[1]


@kernel(error_model="numpy")
def _beyond(net, doors, scratch, low, high, ax, ay, bx, by, place):
    """Where the line a-b, on which walking ends at ``place``, can go on: the middle of a portal's lens.

    Of the portals edges[low:high] it is the first by `_ON` farther along the line. Returns (found, x, y,
    cell).
    """
    dx, dy = bx - ax, by - ay
    length = sqrt(dx * dx + dy * dy)
    least, most = place * length + _ON, length - _ON
    found, x, y, k = False, bx, by, np.int64(-1)
    for i in range(low, high):
        door = scratch.edges[i]
        t = 0.5 * (doors.lens[door, 0] + doors.lens[door, 1])
        px = doors.portal[door, 0] + t * (doors.portal[door, 3] - doors.portal[door, 0])
        py = doors.portal[door, 1] + t * (doors.portal[door, 4] - doors.portal[door, 1])
        along = ((px - ax) * dx + (py - ay) * dy) / length
        if least < along < most:
            found, x, y, k, most = True, px, py, _place_of(net, doors, door, 0, px, py), along
    return found, x, y, k


@allocating_kernel(error_model="numpy")
def mend(net, doors, scratch, first, count, gx, gy, goal_cell, low, high, effort):
    """Add a walked line from the leg's last corner to g, through nodes[low:high].

    ``effort``: `LINES`, `DISCS` or `CELLS`. Returns the new count and FITS; _BLOCKED, with only a part of the
    line added, where walking ends on it and cells are not searched; or _NO_WAY.
    """
    radius = doors.radius
    enough = radius * (1.0 + SLACK)
    points, stack, stack_cell = scratch.points, scratch.stack, scratch.stack_cell
    stack[0, 0], stack[0, 1] = gx, gy
    stack_cell[0] = goal_cell
    height = 1
    splits = parts = 0
    room = scratch.cells.size
    while height > 0:
        if count >= room:
            return count, _NO_WAY
        k = np.int64(scratch.cells[count - 1])
        ax, ay = points[count - 1, 0], points[count - 1, 1]
        bx, by = stack[height - 1, 0], stack[height - 1, 1]
        target = np.int64(stack_cell[height - 1])
        reached, cell, gap, place, qx, qy, tight = walk(net, k, ax, ay, bx, by, enough, True)
        walked = reached and same_place(net, cell, target)
        if walked and gap >= enough:
            count = append_corner(net, doors, scratch, first, count, bx, by, target)
            height -= 1
            continue
        if walked and height <= _DEPTH and splits < _SPLITS:
            x = ax + place * (bx - ax)
            y = ay + place * (by - ay)
            more = lead_round(net, scratch, height, tight, ax, ay, x, y, bx, by, qx, qy, radius)
            if more > 0:
                height += more
                splits += more
                continue
        if walked and gap >= radius:
            count = append_corner(net, doors, scratch, first, count, bx, by, target)
            height -= 1
            continue
        if not walked and height <= _ROUNDS and splits < _SPLITS:
            found, x, y, at = round_in_disc(
                net, doors, scratch, low, high, ax, ay, bx, by, place, effort > LINES
            )
            if found:
                stack[height, 0], stack[height, 1] = x, y
                stack_cell[height] = at
                height += 1
                splits += 1
                continue
        if effort < CELLS:
            return count, _BLOCKED
        if parts < high - low:  # to search few cells
            found, x, y, at = _beyond(net, doors, scratch, low + 1, high, ax, ay, bx, by, place)
            if found:
                parts += 1
                count, fits = over_cells(net, doors, scratch, first, count, height, x, y, at)
                if fits:
                    continue
        count, fits = over_cells(net, doors, scratch, first, count, height, bx, by, target)
        if not fits:
            return count, _NO_WAY
        height -= 1
    return count, FITS


@kernel(error_model="numpy")
def _through_lenses(net, doors, scratch, first, count, low, high, free, gx, gy, goal_cell, last_try):
    """Add a walked line from the leg's last corner to g through the lenses of the portals edges[low:high].

    ``free`` is the first free row of the funnel's memory. Returns the new count and whether the body fits.
    """
    work, at = scratch.corner, scratch.corner_at
    sx, sy = scratch.points[count - 1, 0], scratch.points[count - 1, 1]
    corners = funnel(doors, scratch.edges, low, high, True, work, at, free, sx, sy, gx, gy)
    effort = CELLS if last_try else DISCS
    for i in range(free + 1, free + corners):
        x, y, k = work[i, 0], work[i, 1], goal_cell
        if i < free + corners - 1:
            k = _place_of(net, doors, scratch.edges[at[i] >> 1], at[i] & 1, x, y)
        before, here = at[i - 1] >> 1, at[i] >> 1
        count, state = mend(net, doors, scratch, first, count, x, y, k, before, here, effort)
        if state != FITS:
            return count, False
    return count, True


@kernel(error_model="numpy")
def _save(scratch, leg, count):
    """Note the last corners, from ``leg`` on, so that `_take_back` can bring them back; returns how many."""
    saved = min(count - leg, scratch.saved_cell.size)
    for i in range(saved):
        at = count - saved + i
        scratch.saved[i, 0], scratch.saved[i, 1] = scratch.points[at, 0], scratch.points[at, 1]
        scratch.saved_cell[i] = scratch.cells[at]
    return saved


@kernel(error_model="numpy")
def _take_back(scratch, leg, before, saved, count):
    """Undo what has been added to ``before`` corners since `_save`, where the first of those noted is still
    there or is the leg's; returns the new count."""
    points, first = scratch.points, before - saved
    there = points[first, 0] == scratch.saved[0, 0] and points[first, 1] == scratch.saved[0, 1]
    if first > leg and not (there and count > first):
        return count
    for i in range(saved):
        points[first + i, 0], points[first + i, 1] = scratch.saved[i, 0], scratch.saved[i, 1]
        scratch.cells[first + i] = scratch.saved_cell[i]
    return before


@kernel(error_model="numpy")
def _put_on_floor(net, scratch, first, last):
    """Give the corners [first:last] the height of the floor."""
    points, cells = scratch.points, scratch.cells
    for i in range(first, last):
        points[i, 2] = floor_at(net, np.int64(cells[i]), points[i, 0], points[i, 1])


@kernel(error_model="numpy")
def pull(net, doors, scratch, first, last, count, gx, gy, goal_cell, last_try):
    """Pull one walked leg taut: from the last corner in ``scratch.points`` through the portals of
    edges[first:last].

    Where straight lines cannot be mended the cells are searched, on the ``last_try``. Returns the new number
    of corners, whether the goal was reached, and how much [m] longer the funnel's line got by rounding.
    """
    leg = count - 1
    work, at, arc = scratch.corner, scratch.corner_at, scratch.arc
    sx, sy = scratch.points[leg, 0], scratch.points[leg, 1]
    corners = funnel(doors, scratch.edges, first, last, False, work, at, 0, sx, sy, gx, gy)
    radius = doors.radius
    edges = scratch.edges
    fetch_corners(net, doors, edges, at, corners)
    lx, ly, rounding = sx, sy, 0.0
    for i in range(1, corners):
        rounding -= sqrt((work[i, 0] - work[i - 1, 0]) ** 2 + (work[i, 1] - work[i - 1, 1]) ** 2)
        parts = 0
        door, side = 0, at[i] & 1
        if i < corners - 1:
            door = edges[at[i] >> 1]
            qx, qy = doors.block[door, 2 * side], doors.block[door, 2 * side + 1]
            if qx < np.inf:
                parts = round_corner(work, i, side, qx, qy, radius * (1.0 + MARGIN), arc)
        for part in range(max(parts, 1)):
            x, y, k = work[i, 0], work[i, 1], goal_cell
            if i < corners - 1:
                k = np.int64(doors.portal_cell[door, side])
            if parts > 0:
                px, py = arc[part, 0], arc[part, 1]
                pk = _place_of(net, doors, door, side, px, py)
                if gap_at(net, pk, px, py)[0] >= radius * (1.0 + SLACK):
                    x, y, k = px, py, pk
            rounding += sqrt((x - lx) ** 2 + (y - ly) ** 2)
            lx, ly = x, y
            low, high = at[i - 1] >> 1, at[i] >> 1
            px, py = scratch.points[count - 1, 0], scratch.points[count - 1, 1]
            fetch_line(net, scratch.nodes, low, high, px, py, x, y, radius * (1.0 + SLACK))
            saved = _save(scratch, leg, count)
            before = count
            count, state = mend(net, doors, scratch, leg, count, x, y, k, low, high, LINES)
            if state == _BLOCKED:
                count = _take_back(scratch, leg, before, saved, count)
                low, high = max(low, first), min(high + 1, last)
                count, fits = _through_lenses(
                    net, doors, scratch, leg, count, low, high, corners, x, y, k, last_try
                )
                state = FITS if fits else _NO_WAY
            if state != FITS:
                _put_on_floor(net, scratch, leg, count)
                return count, False, rounding
    if not doors.weighted:
        count = tighten(net, scratch, leg, count, radius)
    _put_on_floor(net, scratch, leg, count)
    return count, True, rounding
