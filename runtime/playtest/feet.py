"""A kinematic capsule that walks on the level's own triangles, and asks the graph nothing.

It goes where its legs are told to, bumps into what is there, slides along it, steps down what is low enough,
and falls where there is nothing: what it meets is what the mesh holds, not what the graph says of it.
"""

import math

import numpy as np

from navmesh.level.mesh_queries import crossed, surface_below
from navmesh.level.raster import FLOOR, KIND
from surefoot.kernels import kernel

__all__ = ["ARRIVED", "BUMPED", "FELL", "OUT_OF_TIME", "STUCK", "TICK", "follow", "roam"]

TICK = 0.05
"""[s] between two steps of the capsule."""
SAMPLE = 5
"""Ticks between two samples of its track."""
ARRIVED, STUCK, FELL, BUMPED, OUT_OF_TIME = range(5)
"""How a leg ends: at its goal, without headway, out of the level, against something in the middle of a
leap, or with the time that there was."""
_PATIENCE = 2.0  # [s] without headway after which it is stuck
_TURN = 5.0  # [rad/s] that it turns
_GAIN, _BRAKE = 4.0, 6.0  # [m/s²]
_NEAR = 0.2  # [m] from a waypoint that counts as there
_SLIM = 0.8  # of its radius that its feelers reach: the graph is exact to a quarter of a cell
_TOE = 0.02  # [m] at which the far side of a crack is felt for
_STRIDE = 0.1  # [m] at which feelers look at the floor
_SLACK = 0.01  # [m] that a body ducks
_SLOPE = 0.4  # that a ramp may rise under a feeler
_GRAVITY = 9.81
_HOP = 0.3  # [s] that a leap takes longer than walking as far


@kernel
def _free(grid, x, y, z, u, v, limits):
    """Whether the body gets from (x, y, z) to (u, v): nothing at hip, chest or head height, before it or
    at its sides. ``limits``: radius, step, headroom, greatest fall, widest crack."""
    dx, dy = u - x, v - y
    length = math.hypot(dx, dy)
    if length < 1e-9:
        return True
    dx, dy = dx / length, dy / length
    reach = _SLIM * limits[0]
    for j in range(3):
        side = (j - 1) * 0.7 * reach
        ahead = length + (reach if j == 1 else 0.7 * reach)
        ax, ay = x - side * dy, y + side * dx
        bx, by = ax + ahead * dx, ay + ahead * dy
        # stairs and ramps rise under the feelers, which follow the floor as far as it can be walked
        floor, along = z, 0.0
        while along < ahead:
            along = min(along + _STRIDE, ahead)
            px, py = ax + along * dx, ay + along * dy
            # a ceiling just as high as the body needs is none
            top = floor + limits[2] - _SLACK
            found, which = surface_below(grid, px, py, floor - limits[1] - _STRIDE, top)
            if which < 0:
                break
            if found > floor + limits[1] + _SLOPE * _STRIDE:
                return False
            floor = found
        rise = floor - z
        for k in range(3):
            up = z + limits[1] + 0.05 + 0.45 * k * (limits[2] - limits[1] - 0.1)
            if crossed(grid, ax, ay, up, bx, by, up + rise):
                return False
    return True


@kernel
def _over_crack(grid, x, y, z, limits):
    """The height of the floor on both sides of a crack in it at (x, y), across which a body steps; -inf where
    there is none, or a wider gap."""
    low, high = z - limits[1] - 0.05, z + limits[1] + 0.05
    for j in range(8):
        dx, dy = math.cos(j * math.pi / 8.0), math.sin(j * math.pi / 8.0)
        wide, floor = 0.0, -np.inf
        for side in (1.0, -1.0):
            far, which = 0.0, -1
            while which < 0 and wide + far <= limits[4]:
                far += _TOE
                found, which = surface_below(grid, x + side * far * dx, y + side * far * dy, low, high)
            wide += far
            if which >= 0:
                floor = max(floor, found)
        if wide <= limits[4]:
            return floor
    return -np.inf


@kernel
def _step(grid, x, y, z, heading, far, limits, careful):
    """One step of ``far`` [m]: (outcome, x, y, z). Outcome 0: done, 1: not free, 2: a ledge, 3: a fall
    down to z, 4: nothing below."""
    u, v = x + far * math.cos(heading), y + far * math.sin(heading)
    if not _free(grid, x, y, z, u, v, limits):
        return 1, x, y, z
    low = z - limits[1] - far
    floor, which = surface_below(grid, u, v, low, z + limits[1] + far)
    if which >= 0:
        if grid.triangles[which, KIND] == FLOOR:
            return 0, u, v, floor
        # a steep face: a riser if the floor goes on behind it
        floor, which = surface_below(
            grid, u + far * math.cos(heading), v + far * math.sin(heading), low, z + limits[1] + far
        )
        if which >= 0 and grid.triangles[which, KIND] == FLOOR:
            return 0, u, v, floor
        return 1, x, y, z
    floor = _over_crack(grid, u, v, z, limits)
    if floor > -np.inf:
        return 0, u, v, floor
    if careful:
        return 2, x, y, z
    floor, which = surface_below(grid, u, v, -np.inf, z)
    if which < 0:
        return 4, u, v, z
    # it lands where there is room for it beside the ledge
    u, v = u + limits[0] * math.cos(heading), v + limits[0] * math.sin(heading)
    landing, which = surface_below(grid, u, v, floor - limits[1], floor + limits[1])
    if (
        z - floor > limits[3]
        or which < 0
        or grid.triangles[which, KIND] != FLOOR
        or not _free(grid, x, y, z, u, v, limits)
    ):
        return 2, x, y, z
    return 3, u, v, landing


@kernel
def _around(grid, x, y, z, heading, far, limits):
    """A careful step that slides along what is in the way: as `_step`, with the heading taken."""
    for k in range(7):
        turn = (0.0, 0.4, -0.4, 0.9, -0.9, 1.5, -1.5)[k]
        outcome, u, v, w = _step(grid, x, y, z, heading + turn, far * math.cos(turn), limits, True)
        if outcome == 0:
            return 0, u, v, w
    return 1, x, y, z


@kernel
def _angle(a):
    return (a + math.pi) % (2.0 * math.pi) - math.pi


@kernel
def follow(grid, place, heading, points, leaps, edges, speed, limits, time_limit, track):
    """Walk through ``points`` (k, 3), relative to the grid's origin, from ``place`` (3,), which is moved
    along.

    ``leaps`` (k,) bool: whether the way to the point is a leap, over ``edges`` (k, 3) [m].
    ``limits`` (5,): radius, step, headroom, greatest fall, widest crack that is stepped over [m]. The track
    (n, 4) gets time and place every fourth of a second. Returns (how it ended, time [s], heading [rad],
    samples, points reached).
    """
    x, y, z = place[0], place[1], place[2]
    time, pace, count, ticks = 0.0, 0.0, 0, 0
    headway, best = 0.0, np.inf
    at = 0
    end = ARRIVED
    while at < len(points):
        gx, gy, gz = points[at, 0], points[at, 1], points[at, 2]
        if leaps[at]:
            length = math.hypot(gx - x, gy - y)
            ex, ey, ez = edges[at, 0], edges[at, 1], edges[at, 2]
            for k in range(2):
                up = 0.3 + 0.6 * k * (limits[2] - 0.4)
                if crossed(grid, x, y, z + up, ex, ey, max(ez, z) + up):
                    end = BUMPED
                if crossed(grid, ex, ey, max(ez, z) + up, gx, gy, max(ez, gz) + up):
                    end = BUMPED
            floor, which = surface_below(grid, gx, gy, gz - 0.3, gz + 0.3)
            if end == BUMPED or which < 0:
                end = BUMPED
                break
            heading = math.atan2(gy - y, gx - x)
            lasts = length / speed + _HOP
            steps = math.ceil(lasts / TICK)
            peak = max(ez, max(z, gz)) + 0.15
            for k in range(1, steps + 1):
                s = k / steps
                ticks += 1
                if ticks % SAMPLE == 0 and count < len(track):
                    base = (1.0 - s) * z + s * gz
                    lift = 4.0 * s * (1.0 - s) * (peak - 0.5 * (z + gz))
                    track[count] = (
                        time + k * TICK,
                        x + s * (gx - x),
                        y + s * (gy - y),
                        base + max(lift, 0.0),
                    )
                    count += 1
            time += steps * TICK
            x, y, z = gx, gy, floor
            at += 1
            headway, best = 0.0, np.inf
            continue
        away = math.hypot(gx - x, gy - y)
        last = at == len(points) - 1 or leaps[at + 1]
        if away < (0.05 if last else _NEAR):
            at += 1
            headway, best = 0.0, np.inf
            continue
        if time >= time_limit:
            end = OUT_OF_TIME
            break
        wanted = math.atan2(gy - y, gx - x)
        off = _angle(wanted - heading)
        heading = _angle(heading + min(max(off, -_TURN * TICK), _TURN * TICK))
        goal = speed * max(math.cos(min(abs(off), 1.5)), 0.15)
        if last:
            goal = min(goal, math.sqrt(2.0 * _BRAKE * away) + 0.2)
        pace += min(max(goal - pace, -_BRAKE * TICK), _GAIN * TICK)
        outcome, u, v, w = _around(grid, x, y, z, wanted, min(pace * TICK, away), limits)
        if outcome == 0:
            x, y, z = u, v, w
        else:
            pace = 0.0
        time += TICK
        ticks += 1
        if ticks % SAMPLE == 0 and count < len(track):
            track[count] = (time, x, y, z)
            count += 1
        now = math.hypot(gx - x, gy - y)
        if now < best - 0.02:
            best, headway = now, time
        elif time - headway > _PATIENCE and headway > 0.0:
            end = STUCK
            break
        elif headway == 0.0:
            headway = time
    place[0], place[1], place[2] = x, y, z
    return end, time, heading, count, at


@kernel
def roam(grid, place, headings, speed, limits, time_limit, track):
    """Walk straight on, in the next of ``headings`` (h,) [rad] whenever something is in the way, like a
    player who tries the level's edges: off ledges that are low enough, and into holes.

    Arguments as of `follow`. Returns (ARRIVED when the time is over or FELL, time [s], samples).
    """
    x, y, z = place[0], place[1], place[2]
    time, count, ticks, turn = 0.0, 0, 0, 0
    end = ARRIVED
    while time < time_limit:
        outcome, u, v, w = _step(grid, x, y, z, headings[turn % len(headings)], speed * TICK, limits, False)
        time += TICK
        ticks += 1
        if outcome == 4:
            end = FELL
            break
        if outcome == 3:
            falls = math.sqrt(2.0 * (z - w) / _GRAVITY)
            time += falls
        if outcome == 0 or outcome == 3:
            x, y, z = u, v, w
        else:
            turn += 1
        if ticks % SAMPLE == 0 and count < len(track):
            track[count] = (time, x, y, z)
            count += 1
    place[0], place[1], place[2] = x, y, z
    return end, time, count
