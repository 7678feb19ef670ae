"""The last step of string pulling: corners that nothing holds are let go.

The funnel's line must cross the portals of the discs that A* chose, and some of them lie far off the way. A
corner is *taut* where what ends walking stands within the turn, about a radius away. One that is not is drawn
towards the straight line between its neighbours until the body touches something; there the line gets a new
corner, and the old one is drawn on. Every line of the result has been walked.
"""

from math import sqrt

from navmesh.graph.portals import MARGIN
from navmesh.routes.funnel import tangents
from navmesh.routes.leading_round import SLACK
from navmesh.surface.clearance_field import gap_at, same_place, walk
from surefoot.kernels import kernel

__all__ = ["tighten"]

_GAIN = 1e-3  # [m] that a change must save
_FIRST = 1.0 / 16.0  # share of the way from a loose corner to the straight line that is tried first
_HALVINGS = 6  # of the way then
_CHANGES = 48  # of one leg


@kernel(error_model="numpy", forceinline=True)
def _far(ax, ay, bx, by):
    return sqrt((ax - bx) * (ax - bx) + (ay - by) * (ay - by))


@kernel(error_model="numpy")
def _clear(net, k, ax, ay, bx, by, target, enough):
    """Whether a body that needs ``enough`` room passes from a, in cell ``k``, straight to b in ``target``."""
    reached, cell = walk(net, k, ax, ay, bx, by, enough, False)[:2]
    return reached and same_place(net, cell, target)


@kernel(error_model="numpy")
def _replace(scratch, at, count, new):
    """Put the first ``new`` rows of scratch.trial in the place of corner ``at``; returns the new count."""
    points, cells = scratch.points, scratch.cells
    shift = new - 1
    first, last, way = (count - 1, at, -1) if shift > 0 else (at + 1, count, 1)
    if shift != 0:
        for i in range(first, last, way):
            points[i + shift, 0], points[i + shift, 1] = points[i, 0], points[i, 1]
            cells[i + shift] = cells[i]
    for i in range(new):
        points[at + i, 0], points[at + i, 1] = scratch.trial[i, 0], scratch.trial[i, 1]
        cells[at + i] = scratch.trial_cell[i]
    return count + shift


@kernel(error_model="numpy")
def _walk_bend(net, scratch, parts, base, k, ax, ay, enough):
    """Walk from a, in cell ``k``, to the first ``parts`` corners of scratch.bend in turn, and write them into
    scratch.trial from row ``base`` on; returns whether the body passes."""
    bend = scratch.bend
    for part in range(parts):
        px, py = bend[part, 0], bend[part, 1]
        reached, k = walk(net, k, ax, ay, px, py, enough, False)[:2]
        if not reached:
            return False
        scratch.trial[base + part, 0], scratch.trial[base + part, 1] = px, py
        scratch.trial_cell[base + part] = k
        ax, ay = px, py
    return parts > 0


@kernel(error_model="numpy")
def _line(ax, ay, rows, count, bx, by):
    """Length of the line from a through the first ``count`` rows to b."""
    total = 0.0
    for i in range(count):
        total += _far(ax, ay, rows[i, 0], rows[i, 1])
        ax, ay = rows[i, 0], rows[i, 1]
    return total + _far(ax, ay, bx, by)


@kernel(error_model="numpy")
def _round_better(net, scratch, at, radius, enough):
    """Try to lead the line round what stands within the turn at corner ``at`` on a shorter way.

    Returns (whether something holds the corner, rows in scratch.trial to put in its place or 0).
    """
    points, cells = scratch.points, scratch.cells
    ax, ay, bx, by = points[at - 1, 0], points[at - 1, 1], points[at + 1, 0], points[at + 1, 1]
    x, y = points[at, 0], points[at, 1]
    gap, qx, qy = gap_at(net, cells[at], x, y)
    if gap > 1.5 * radius:
        return False, 0
    side = (x - ax) * (by - ay) - (y - ay) * (bx - ax)
    # within the turn: on the other side of both lines than the turn's outside
    if ((x - ax) * (qy - ay) - (y - ay) * (qx - ax)) * side <= 0.0:
        return False, 0
    if ((bx - x) * (qy - y) - (by - y) * (qx - x)) * side <= 0.0:
        return False, 0
    length = (bx - ax) ** 2 + (by - ay) ** 2
    s = ((qx - ax) * (bx - ax) + (qy - ay) * (by - ay)) / length if length > 0.0 else 0.0
    s = min(max(s, 0.0), 1.0)
    px, py = ax + s * (bx - ax) - qx, ay + s * (by - ay) - qy
    beyond = ((bx - ax) * (qy - ay) - (by - ay) * (qx - ax)) * side < 0.0
    if px * px + py * py >= enough * enough and beyond:
        return False, 0
    held = gap <= radius * (1.0 + 2.0 * MARGIN)
    bend = scratch.bend
    parts = tangents(ax, ay, x, y, bx, by, qx, qy, radius * (1.0 + MARGIN), bend)
    if parts == 0:
        return held, 0
    if _line(ax, ay, bend, parts, bx, by) > _far(ax, ay, x, y) + _far(x, y, bx, by) - _GAIN:
        return True, 0
    if not _walk_bend(net, scratch, parts, 0, cells[at - 1], ax, ay, enough):
        return held, 0
    last = parts - 1
    k = scratch.trial_cell[last]
    if not _clear(net, k, bend[last, 0], bend[last, 1], bx, by, cells[at + 1], enough):
        return held, 0
    return True, parts


@kernel(error_model="numpy")
def _draw(net, scratch, at, radius, enough, moved):
    """Draw corner ``at`` towards the line between its neighbours; returns rows in scratch.trial to put in its
    place, or -1 where it cannot be drawn. That line is known to be blocked if nothing has ``moved`` yet."""
    points, cells = scratch.points, scratch.cells
    ax, ay, bx, by = points[at - 1, 0], points[at - 1, 1], points[at + 1, 0], points[at + 1, 1]
    x, y = points[at, 0], points[at, 1]
    a, b = cells[at - 1], cells[at + 1]
    if moved and _clear(net, a, ax, ay, bx, by, b, enough):
        return 0
    one, two = _far(ax, ay, x, y), _far(x, y, bx, by)
    if one + two - _far(ax, ay, bx, by) < _GAIN:
        return -1
    share = one / (one + two)
    mx, my = ax + share * (bx - ax) - x, ay + share * (by - ay) - y
    low, high = 0.0, 1.0
    cell = cells[at]
    for i in range(_HALVINGS):
        t = 0.5 * (low + high) if i > 0 else _FIRST
        px, py = x + t * mx, y + t * my
        reached, k = walk(net, a, ax, ay, px, py, enough, False)[:2]
        if reached and _clear(net, k, px, py, bx, by, b, enough):
            low, cell = t, k
        else:
            high = t
            if i == 0:
                break
    # led round what stops it
    px, py = x + high * mx, y + high * my
    reached, k, gap, place, qx, qy, _ = walk(net, a, ax, ay, px, py, enough, True)
    rows = 0
    done = False
    trial, trial_cell, bend, tight = scratch.trial, scratch.trial_cell, scratch.bend, radius * (1.0 + MARGIN)
    if reached and gap < enough:
        sx, sy = ax + place * (px - ax), ay + place * (py - ay)
        parts = tangents(ax, ay, sx, sy, px, py, qx, qy, tight, bend)
        if _walk_bend(net, scratch, parts, 0, a, ax, ay, enough):
            lx, ly = bend[parts - 1, 0], bend[parts - 1, 1]
            reached, k = walk(net, trial_cell[parts - 1], lx, ly, px, py, enough, False)[:2]
            done = reached and _clear(net, k, px, py, bx, by, b, enough)
            trial[parts, 0], trial[parts, 1], trial_cell[parts] = px, py, k
            rows = parts + 1
    elif reached:
        trial[0, 0], trial[0, 1], trial_cell[0] = px, py, k
        reached, _, gap, place, qx, qy, _ = walk(net, k, px, py, bx, by, enough, True)
        if reached and gap < enough:
            sx, sy = px + place * (bx - px), py + place * (by - py)
            parts = tangents(px, py, sx, sy, bx, by, qx, qy, tight, bend)
            if _walk_bend(net, scratch, parts, 1, k, px, py, enough):
                lx, ly = bend[parts - 1, 0], bend[parts - 1, 1]
                done = _clear(net, trial_cell[parts], lx, ly, bx, by, b, enough)
                rows = parts + 1
    if done and _line(ax, ay, trial, rows, bx, by) < one + two - _GAIN:
        return rows
    if low == 0.0:
        return -1
    px, py = x + low * mx, y + low * my
    if _far(ax, ay, px, py) + _far(px, py, bx, by) > one + two - _GAIN:
        return -1
    scratch.trial[0, 0], scratch.trial[0, 1], scratch.trial_cell[0] = px, py, cell
    return 1


@kernel(error_model="numpy")
def tighten(net, scratch, first, count, radius):
    """Let go what nothing holds on the walked leg scratch.points[first:count]; returns the new count."""
    enough = radius * (1.0 + SLACK)
    changes = 0
    at = first + 1
    while at < count - 1 and changes < _CHANGES and count + 8 < scratch.cells.size:
        held, rows = _round_better(net, scratch, at, radius, enough)
        if held and rows == 0:
            at += 1
            continue
        if rows == 0:
            rows = _draw(net, scratch, at, radius, enough, changes > 0)
            if rows < 0:
                at += 1
                continue
        count = _replace(scratch, at, count, rows)
        changes += 1
        at = max(at - 1, first + 1)
    return count
