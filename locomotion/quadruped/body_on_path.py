"""Where the body is: root between the rear feet, spine bent so that the front feet are on the path too.

A motion (trail or script) gives the wanted pose. When one motion takes over from another, the difference at
that moment is kept as an offset and decays like a critically damped spring, so that no part jumps (Bollo,
"Inertialization", 2016; Holden's exact spring).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from locomotion.quadruped import layout as at
from locomotion.quadruped.motion import DT, script_at
from locomotion.quadruped.spine import bend_for, chord
from locomotion.quadruped.trail import trail_at, trail_point
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["front_of", "on_trail", "place_body", "root_behind", "spring", "wanted_pose", "wrap"]

_HALF_LIFE = 0.16  # [s] of an offset


@kernel(forceinline=True)
def wrap(angle):
    """The same angle [rad] between -π and π."""
    return angle - 2.0 * math.pi * math.floor((angle + math.pi) / (2.0 * math.pi))


@kernel(forceinline=True)
def spring(value, rate, half_life):
    """A critically damped spring towards 0 after one tick: (value, rate)."""
    y = 2.0 * 0.69314718056 / half_life
    j = rate + value * y
    e = math.exp(-y * DT)
    return e * (value + j * DT), e * (rate - j * y * DT)


@kernel
def on_trail(pool, first, count, step, arc, front, bones, bone, flex, max_bend):
    """The body whose root is at ``arc`` [m] on a trail and whose spine ends on the trail too.

    ``front`` [m] is a guess of where. Returns (x, y, z, yaw, bend, arc length of the front [m]).
    """
    x, y, z, heading = trail_at(pool, first, count, step, arc)
    turn, bend = 0.0, 0.0
    for _ in range(8):
        fx, fy, _ = trail_point(pool, first, count, step, front)
        dx, dy = fx - x, fy - y
        turn = wrap(math.atan2(dy, dx) - heading)
        bend = min(max(bend_for(flex * turn, bones), -max_bend), max_bend)
        miss = chord(bend, bones, bone) - math.sqrt(dx * dx + dy * dy)
        front += miss
        if abs(miss) < 1e-6:
            break
    return x, y, z, heading + turn - 0.5 * (bones + 1.0) * bend, bend, front


@kernel
def wanted_pose(st, pr, pool, arc, time):
    """(x, y, z, yaw, bend, front) that the motion wants with the root at ``arc`` [m], or ``time`` [s] into a
    script; ``front`` is the arc length of the front feet's midpoint, as it was when not on a trail."""
    first, count = int(st[at.ROW_START]), int(st[at.ROW_COUNT])
    if st[at.MODE] == at.ON_TRAIL:
        return on_trail(
            pool, first, count, st[at.ROW_STEP], arc, st[at.FRONT_ARC] + arc - st[at.ARC], pr[at.BONES],
            pr[at.BONE] * math.cos(st[at.PITCH]), pr[at.FLEX], pr[at.MAX_BEND],
        )  # fmt: skip
    if st[at.MODE] == at.SCRIPTED:
        x, y, z, yaw, bend = script_at(pool, first, count, time / st[at.SCRIPT_LENGTH])
        return x, y, z, yaw, bend, st[at.FRONT_ARC]
    return st[at.X], st[at.Y], st[at.HEIGHT], st[at.YAW], st[at.BEND], st[at.FRONT_ARC]


@kernel
def front_of(x, y, yaw, bend, bones, bone):
    """(x, y) of the spine's end for a root at (x, y)."""
    seen = yaw + 0.5 * (bones + 1.0) * bend
    reach = chord(bend, bones, bone)
    return x + reach * math.cos(seen), y + reach * math.sin(seen)


@allocating_kernel
def place_body(st, pr, pool):
    """Write the pose of this tick into the row ``st``: what the motion wants, and what is left of offsets."""
    x, y, z, yaw, bend, front = wanted_pose(st, pr, pool, st[at.ARC], st[at.SCRIPT_TIME])
    if st[at.MODE] != at.STANDING:
        st[at.FRONT_ARC], st[at.HEIGHT] = front, z
        for k in range(4):
            st[at.OFFSET + k], st[at.OFFSET_RATE + k] = spring(
                st[at.OFFSET + k], st[at.OFFSET_RATE + k], _HALF_LIFE
            )
        x += st[at.OFFSET]
        y += st[at.OFFSET + 1]
        yaw += st[at.OFFSET + 2]
        bend += st[at.OFFSET + 3]
    bend = min(max(bend, -pr[at.MAX_BEND]), pr[at.MAX_BEND])
    if st[at.FIRST_TICK] > 0.0:
        st[at.FIRST_TICK] = 0.0
    else:
        st[at.RATE] = (x - st[at.X]) / DT
        st[at.RATE + 1] = (y - st[at.Y]) / DT
        st[at.RATE + 2] = wrap(yaw - st[at.YAW]) / DT
        st[at.RATE + 3] = (bend - st[at.BEND]) / DT
    st[at.X], st[at.Y], st[at.YAW], st[at.BEND] = x, y, yaw, bend
    bone = pr[at.BONE] * math.cos(st[at.PITCH])
    st[at.FRONT_X], st[at.FRONT_Y] = front_of(x, y, yaw, bend, pr[at.BONES], bone)
    st[at.CHEST] = yaw + pr[at.BONES] * bend


def root_behind(rows: NDArray[np.float64], step: float, params: NDArray[np.float64], pitch: float) -> float:
    """[m] of the root along a trail (rows (n, ROW), ``step`` [m] apart) when the front feet's midpoint is at
    its end, the trunk tilted by ``pitch`` [rad]; by halving."""
    st = np.zeros(at.STATE)
    st[at.MODE], st[at.ROW_COUNT], st[at.ROW_STEP], st[at.PITCH] = at.ON_TRAIL, len(rows), step, pitch
    reach, length = params[at.BONES] * params[at.BONE], step * (len(rows) - 1)

    def front(arc: float) -> float:
        st[at.ARC], st[at.FRONT_ARC] = arc, arc + reach
        return wanted_pose(st, params, rows, arc, 0.0)[5]

    low, high = max(length - 1.2 * reach, 0.0), length
    if front(low) >= length:
        return low
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if front(middle) >= length else (middle, high)
    return 0.5 * (low + high)
