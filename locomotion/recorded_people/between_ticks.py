"""Recorded people between their bodies' ticks: whose turn it is, and where the others are drawn meanwhile.

A body's tick takes several of ours. Bodies have theirs in turns, some in each of our ticks, so that all ticks
have equally much to do; between two of its own a figure goes along the straight line.
"""

import math

from locomotion.crowd import layout as body
from locomotion.recorded.skeletons import FULL
from locomotion.recorded_people import layout as at
from surefoot.kernels import kernel

__all__ = ["come_due", "go_on", "take_turns", "turn", "write_discs"]

_PLACE, _BEFORE = at.PLACE.start, at.BEFORE.start  # kernels know numbers
_LONG = 1.0  # [s] in which everybody's turn to be drawn comes


@kernel
def turn(angle):
    """The same angle, -π to π."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


@kernel
def take_turns(rows, walkers, origin, ticks, turns, apart):
    """Begin a tick, of which a body's takes so many ``ticks``: write whose body has its turn, ``turns`` (n,)
    bool, which goes on from where it is; and who plays its postures or has an obstacle on its way, ``apart``
    (n,) bool."""
    here = _BEFORE
    for n in range(rows.shape[0]):
        row, walker = rows[n], walkers[n]
        row[at.SINCE] = (row[at.SINCE] + 1.0) % ticks
        turns[n] = row[at.SINCE] == 0.0
        apart[n] = row[at.BUSY] > 0.0 or row[at.CROSSES] > at.NOTHING
        if turns[n]:
            for k in range(3):
                row[here + k] = walker[body.X + k] + origin[k]
            row[here + 3] = walker[body.YAW]


@kernel
def go_on(row, walker, origin, tick):
    """Let a figure go on on the straight line between its body's last two places."""
    dt, of = tick
    share = (row[at.SINCE] + 1.0) / of
    row[at.AGE] += 1.0
    row[at.LATE] += dt
    here, before = _PLACE, _BEFORE
    for k in range(3):
        now = walker[body.X + k] + origin[k]
        row[here + k] = row[before + k] + share * (now - row[before + k])
    turned = turn(walker[body.YAW] - row[before + 3])
    row[here + 3] = row[before + 3] + share * turned


@kernel
def write_discs(rows, walkers, out):
    """Write where all figures are drawn, at which velocities they move, and how wide they are, ``out`` (n, 6)
    as of `Crowd.lead`."""
    here = _PLACE
    for n in range(out.shape[0]):
        walker = walkers[n]
        for k in range(3):
            out[n, k] = rows[n, here + k]
        out[n, 3], out[n, 4], out[n, 5] = walker[body.VX], walker[body.VY], walker[body.RADIUS]


@kernel
def come_due(rates, rows, turns, indices, since, now, due):
    """Write which figures ``indices`` (n,) have had a moment to be drawn at after the times ``since`` (n,)
    [s], until ``now``, ``due`` (n,) bool: ``rates`` [Hz] of levels, ``turns`` of all."""
    for n in range(indices.shape[0]):
        level = int(rows[indices[n], at.LEVEL])
        rate, own, after = rates[level], turns[indices[n]], max(since[n], now - _LONG)
        due[n] = level == FULL or math.floor(rate * now - own) > math.floor(rate * after - own)
