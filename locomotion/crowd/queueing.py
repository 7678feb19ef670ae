"""Who goes through a gate when: one direction at a time, a few bodies at a time, the longest wait first.

Bodies near a gate wait to the right of its entrance, clear of those coming out, until they are admitted; they
do not push those ahead. If the other side has waited for a while, no more are admitted on this side; once the
gate is empty, the side that has waited longest goes. Everything remembered between ticks is in the bodies'
rows.
"""

from math import sqrt

import numpy as np

from locomotion.crowd import layout as at
from navmesh.surface.clearance_field import cell_at, walk
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["direct", "trace_gates", "waiting_wish", "waits_behind"]

NEAR = 2.5
"""[m] before a gate from which a body waits for its turn."""
_AHEAD = 4
"""Most bodies admitted and not yet inside, for each gate."""
_PATIENCE = 8.0
"""[s] of one side's wait after which the other side's admission stops."""
_CLEAR, _OUT = 0.5, 6.0
"""[m] behind a gate where a body is through, and up to where it keeps the right of way."""
_FIRST, _URGENT = 1.0, 6.0
"""Weight of a body, and of one with the right of way."""
_SPOT_BACK, _SPOT_RIGHT = 1.3, 1.0
"""[m] from a gate's entrance to where bodies wait, backwards and to the right."""
_LANE = 1.2
"""[m] to the left of a gate's entrance that waiting bodies keep free for those coming out."""
_BEHIND = 0.25
"""[m] that a waiting body keeps from those ahead."""
_LONG = 1.0
"""[m] of a gate over which its direction is measured."""


@allocating_kernel
def trace_gates(net, row_of, gate_of, along, axis, width, most, table):
    """The gates that a route goes through: rows (k, CROSSING), for a body that heeds gates up to ``most``
    [m] wide. table (m, POINT): the route."""
    found = np.empty((64, at.CROSSING))
    count = 0
    k = cell_at(net, table[0, at.POINT_X], table[0, at.POINT_Y], table[0, at.POINT_Z])
    inside = -1
    first = -1
    x, y = table[0, at.POINT_X], table[0, at.POINT_Y]
    for i in range(1, table.shape[0]):
        ax, ay = table[i - 1, at.POINT_X], table[i - 1, at.POINT_Y]
        dx, dy = table[i, at.POINT_X] - ax, table[i, at.POINT_Y] - ay
        length = sqrt(dx * dx + dy * dy)
        steps = int(length / (0.5 * net.cell)) + 1
        for j in range(1, steps + 1):
            px, py = ax + dx * j / steps, ay + dy * j / steps
            k = walk(net, k, x, y, px, py, 0.0, True)[1]
            x, y = px, py
            here = row_of[k]
            gate = gate_of[here] if here >= 0 else -1
            if gate >= 0 and width[gate] >= most:
                gate = -1
            last = i == table.shape[0] - 1 and j == steps
            left = table[i, at.LEFT] + length * (steps - j) / steps
            if inside >= 0 and (gate != inside or last):
                row = found[count]
                row[at.GATE], row[at.LEFT_OUT] = inside, left
                way = along[here] - along[first] if gate == inside else 0.0
                if abs(way) < _LONG:
                    way = axis[first, 0] * (x - row[at.IN_X]) + axis[first, 1] * (y - row[at.IN_Y])
                row[at.SIGN] = 1.0 if way >= 0.0 else -1.0
                count += 1
                inside = -1
                if count == found.shape[0]:
                    return found
            if gate >= 0 and inside < 0 and not last:
                inside, first = gate, here
                row = found[count]
                row[at.LEFT_IN], row[at.IN_X], row[at.IN_Y] = left, x, y
                sense = 1.0 if axis[here, 0] * dx + axis[here, 1] * dy >= 0.0 else -1.0
                row[at.INTO_X], row[at.INTO_Y] = sense * axis[here, 0], sense * axis[here, 1]
    return found[:count].copy()


@kernel
def _next_gate(row, crossings):
    """The gate that a body is before or in; (row of crossings or -1, [m] to it, [m] to its end)."""
    while row[at.GATE_NEXT] < row[at.GATE_COUNT]:
        c = int(row[at.GATE_START] + row[at.GATE_NEXT])
        after = row[at.LEFT_NOW] - crossings[c, at.LEFT_OUT]
        if after > -_CLEAR:
            return c, row[at.LEFT_NOW] - crossings[c, at.LEFT_IN], after
        row[at.GATE_NEXT] += 1.0
        row[at.PASSAGE], row[at.GATE_WAIT] = at.FAR, 0.0
        row[at.RIGHT_UNTIL] = crossings[c, at.LEFT_OUT] - _OUT
    return -1, 0.0, 0.0


@allocating_kernel
def direct(rows, crossings, gates, turns, dt):
    """Decide who of ``rows`` may pass the ``gates`` (how many there are) now. Those whose turn it is,
    ``turns`` (m,) bool of the first m, have waited for ``dt`` [s] more."""
    n = rows.shape[0]
    passing = np.zeros((gates, 2), np.int64)  # by direction: admitted and not out yet
    coming = np.zeros((gates, 2), np.int64)  # of these, not inside yet
    longest = np.zeros((gates, 2))
    here = np.full(n, -1, np.int64)
    for i in range(n):
        row = rows[i]
        if row[at.MODE] != at.WALKING:
            if row[at.MODE] == at.STANDING:
                row[at.WEIGHT] = _FIRST
                row[at.PASSAGE] = at.FAR
            continue
        c, to, after = _next_gate(row, crossings)
        row[at.WEIGHT] = _URGENT if row[at.LEFT_NOW] > row[at.RIGHT_UNTIL] else _FIRST
        if c < 0:
            continue
        here[i] = c
        gate, side = int(crossings[c, at.GATE]), int(crossings[c, at.SIGN] > 0.0)
        if row[at.PASSAGE] == at.FAR and to < NEAR:
            row[at.PASSAGE] = at.WAITING if to > 0.0 else at.PASSING
        if row[at.PASSAGE] == at.WAITING:
            row[at.GATE_WAIT] += dt if turns[i] else 0.0
            longest[gate, side] = max(longest[gate, side], row[at.GATE_WAIT])
        if row[at.PASSAGE] == at.PASSING:
            row[at.WEIGHT] = _URGENT
            if after > 0.0:
                passing[gate, side] += 1
                if to > 0.0:
                    coming[gate, side] += 1
    _let_in(rows, crossings, here, passing, coming, longest)


@allocating_kernel
def _let_in(rows, crossings, here, passing, coming, longest):
    """Let those in whose turn it is, the nearest first, and send back those who meet others inside."""
    gates = passing.shape[0]
    nearest = np.full(gates, -1, np.int64)
    least = np.full(gates, np.inf)
    for i in range(rows.shape[0]):
        c = here[i]
        if c < 0:
            continue
        row = rows[i]
        gate, side = int(crossings[c, at.GATE]), int(crossings[c, at.SIGN] > 0.0)
        to = row[at.LEFT_NOW] - crossings[c, at.LEFT_IN]
        against = passing[gate, 1 - side]
        outnumbered = against > passing[gate, side] or (against == passing[gate, side] > 0 and side == 1)
        inside = row[at.LEFT_NOW] > crossings[c, at.LEFT_OUT]
        if row[at.PASSAGE] == at.PASSING and inside and outnumbered:
            row[at.PASSAGE] = at.RETREATING
        elif row[at.PASSAGE] == at.RETREATING and to > 0.5 * NEAR:
            row[at.PASSAGE] = at.WAITING
        elif row[at.PASSAGE] == at.WAITING and against == 0:
            turn = longest[gate, 1 - side] < _PATIENCE
            if passing[gate, side] == 0 and longest[gate, side] >= longest[gate, 1 - side]:
                turn = True
            if turn and coming[gate, side] < _AHEAD and to < least[gate]:
                least[gate], nearest[gate] = to, i
    for gate in range(gates):
        if nearest[gate] >= 0:
            rows[nearest[gate], at.PASSAGE] = at.PASSING
    for i in range(rows.shape[0]):
        c = here[i]
        if c >= 0 and rows[i, at.PASSAGE] == at.WAITING:
            let_in = nearest[int(crossings[c, at.GATE])]
            if let_in >= 0 and crossings[here[let_in], at.SIGN] == crossings[c, at.SIGN]:
                rows[i, at.GATE_WAIT] = 0.0


@kernel
def waits_behind(rows, crossings, i, neighbours, count):
    """Whether somebody who waits at the next gate of body ``i`` stands before it, in touch."""
    row = rows[i]
    if row[at.GATE_NEXT] >= row[at.GATE_COUNT]:
        return False
    own = crossings[int(row[at.GATE_START] + row[at.GATE_NEXT])]
    for k in range(count):
        other = rows[neighbours[k]]
        px, py = other[at.X] - row[at.X], other[at.Y] - row[at.Y]
        near = row[at.RADIUS] + other[at.RADIUS] + _BEHIND
        if px * px + py * py > near * near:
            break
        if other[at.PASSAGE] != at.WAITING or other[at.MODE] != at.WALKING:
            continue
        its = crossings[int(other[at.GATE_START] + other[at.GATE_NEXT])]
        if its[at.GATE] != own[at.GATE] or its[at.SIGN] != own[at.SIGN]:
            continue
        if other[at.LEFT_NOW] - its[at.LEFT_IN] < row[at.LEFT_NOW] - own[at.LEFT_IN]:
            return True
    return False


@kernel
def waiting_wish(rows, crossings, i, neighbours, count):
    """The velocity (x, y) [m/s] of one that waits for its turn or goes back out of a gate."""
    row = rows[i]
    c = crossings[int(row[at.GATE_START] + row[at.GATE_NEXT])]
    fx, fy = c[at.INTO_X], c[at.INTO_Y]
    dx, dy = row[at.X] - c[at.IN_X], row[at.Y] - c[at.IN_Y]
    depth, beside = -(fx * dx + fy * dy), fy * dx - fx * dy
    speed = 0.5 * row[at.WISH]
    if row[at.PASSAGE] == at.WAITING:
        if -_LANE < beside < 0.5 * _SPOT_RIGHT and depth < _OUT:
            return speed * fy, -speed * fx
        if waits_behind(rows, crossings, i, neighbours, count):
            return 0.0, 0.0
    back = _SPOT_BACK if row[at.PASSAGE] == at.WAITING else NEAR
    wx, wy = -back * fx + _SPOT_RIGHT * fy - dx, -back * fy - _SPOT_RIGHT * fx - dy
    far = sqrt(wx * wx + wy * wy)
    share = speed / max(far, speed)
    return share * wx, share * wy
