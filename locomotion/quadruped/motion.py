"""Progress along a motion: speed on a trail, the stop that ends in place, and the time of a script.

The stop is one polynomial from the present speed and acceleration to rest over the remaining length; without
acceleration, its speed falls by the smoothstep. Planning and playing a stop use the same code.
"""

from __future__ import annotations

from locomotion.quadruped import layout as at
from locomotion.quadruped.trail import trail_speed
from surefoot.kernels import kernel

__all__ = [
    "DT",
    "SLACKEN",
    "advance_along",
    "begin_stop",
    "script_at",
    "stop_length",
    "stop_place",
    "stop_time",
    "travel",
]

DT = 0.01
"""[s] of a tick."""
_SHORTEST_STOP = 0.35  # [s]
_EAGERNESS = 3.0  # [1/s] by which a difference of speed becomes acceleration
_JERK = 12.0  # [m/s³]
SLACKEN = 2.4
"""[1/s] by which a difference of speed becomes a slowing, with the jerk's delay in it."""
_FORESIGHT = 0.25  # [s] ahead on the trail that the speed of a bend is looked up


@kernel(forceinline=True)
def stop_time(speed, braking):
    """[s] of a stop from ``speed`` [m/s] that never brakes harder than ``braking`` [m/s²]."""
    return max(1.5 * speed / braking, _SHORTEST_STOP)


@kernel(forceinline=True)
def stop_length(speed, braking):
    """[m] that a stop from ``speed`` [m/s] takes."""
    return 0.5 * speed * stop_time(speed, braking)


@kernel
def stop_place(speed, push, length, time, now):
    """Place [m], speed and acceleration ``now`` [s] into a stop from ``speed`` and ``push`` [m/s²] that
    takes ``time`` [s] over ``length`` [m]."""
    if now >= time:
        return length, 0.0, 0.0
    u = now / time
    v, a = speed * time, push * time * time
    h, hv, ha = length - v - 0.5 * a, -v - a, -a
    c3, c4, c5 = 10.0 * h - 4.0 * hv + 0.5 * ha, -15.0 * h + 7.0 * hv - ha, 6.0 * h - 3.0 * hv + 0.5 * ha
    s = u * (v + u * (0.5 * a + u * (c3 + u * (c4 + u * c5))))
    sv = v + u * (a + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))
    sa = a + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))
    return s, sv / time, sa / (time * time)


@kernel
def advance_along(st, pr, pool):
    """One tick on a trail: changes speed and arc length in the row ``st`` of the state."""
    if st[at.STOPPING] > 0.0:
        st[at.STOP_BEGIN] += DT
        s, v, a = stop_place(
            st[at.STOP_SPEED], st[at.STOP_PUSH], st[at.STOP_DISTANCE], st[at.STOP_TIME], st[at.STOP_BEGIN]
        )
        st[at.ARC] = st[at.ARC_END] + st[at.WAY] * (s - st[at.STOP_DISTANCE])
        st[at.SPEED], st[at.PUSH] = v, a
        return
    speed, way = st[at.SPEED], st[at.WAY]
    first, count, step = int(st[at.ROW_START]), int(st[at.ROW_COUNT]), st[at.ROW_STEP]
    ahead = st[at.ARC] + way * speed * _FORESIGHT
    wished = st[at.PACE] * min(st[at.WISH], trail_speed(pool, first, count, step, ahead))
    push = min(max(_EAGERNESS * (wished - speed), -2.0 * pr[at.BRAKING]), pr[at.ACCELERATION])
    change = _JERK * DT
    push = min(max(push, st[at.PUSH] - change), st[at.PUSH] + change)
    speed = max(speed + push * DT, 0.0)
    st[at.SPEED], st[at.PUSH] = speed, push
    st[at.ARC] += way * speed * DT
    left = way * (st[at.ARC_END] - st[at.ARC])
    if left <= stop_length(speed, pr[at.BRAKING]):
        begin_stop(st, left)


@kernel
def begin_stop(st, left):
    """Begin the stop motion over ``left`` [m]."""
    st[at.STOPPING], st[at.STOP_BEGIN] = 1.0, 0.0
    st[at.STOP_DISTANCE], st[at.STOP_SPEED], st[at.STOP_PUSH] = left, st[at.SPEED], st[at.PUSH]
    st[at.STOP_TIME] = max(2.0 * left / max(st[at.SPEED], 1e-6), _SHORTEST_STOP) if left > 1e-9 else 0.0


@kernel
def travel(st, pr, ahead):
    """[m] that the root will move along its trail within ``ahead`` [s], if nothing else happens."""
    speed = st[at.SPEED]
    if st[at.STOPPING] > 0.0:
        s = stop_place(
            st[at.STOP_SPEED], st[at.STOP_PUSH], st[at.STOP_DISTANCE], st[at.STOP_TIME],
            st[at.STOP_BEGIN] + ahead,
        )[0]  # fmt: skip
        return s - st[at.STOP_DISTANCE] + st[at.WAY] * (st[at.ARC_END] - st[at.ARC])
    left = st[at.WAY] * (st[at.ARC_END] - st[at.ARC])
    soon = min(ahead, 0.3)
    freely = max(speed * ahead + st[at.PUSH] * soon * (ahead - 0.5 * soon), 0.0)
    needed = stop_length(speed, pr[at.BRAKING])
    if freely <= left - needed or speed < 1e-3:
        return min(freely, left)
    cruise = max(left - needed, 0.0) / speed
    if cruise >= ahead:
        return min(freely, left)
    length = min(needed, left)
    s = stop_place(speed, 0.0, length, 2.0 * length / speed, ahead - cruise)[0]
    return min(speed * cruise + s, left)


@kernel
def script_at(pool, first, count, share):
    """(x, y, z, yaw, bend) at a share (0 to 1) of a script, by cubic interpolation of its rows."""
    along = min(max(share, 0.0), 1.0) * (count - 1)
    i = min(int(along), count - 2)
    w = along - i
    p, a, b = pool[first + max(i - 1, 0)], pool[first + i], pool[first + i + 1]
    n = pool[first + min(i + 2, count - 1)]
    v = 1.0 - w
    pa, pb = v * v * (1.0 + 2.0 * w), w * w * (3.0 - 2.0 * w)
    ta, tb = 0.5 * w * v * v, -0.5 * w * w * v
    x = pa * a[0] + pb * b[0] + ta * (b[0] - p[0]) + tb * (n[0] - a[0])
    y = pa * a[1] + pb * b[1] + ta * (b[1] - p[1]) + tb * (n[1] - a[1])
    yaw = pa * a[3] + pb * b[3] + ta * (b[3] - p[3]) + tb * (n[3] - a[3])
    bend = pa * a[4] + pb * b[4] + ta * (b[4] - p[4]) + tb * (n[4] - a[4])
    return x, y, v * a[2] + w * b[2], yaw, bend
