"""One tick of a crowd: wishes, velocities, steps."""

from math import atan2, pi, sqrt

import numpy as np

from locomotion.crowd import layout as at
from locomotion.crowd.avoidance import MOST_WALLS, body_plane, wall_planes
from locomotion.crowd.moving import part, slide
from locomotion.crowd.neighbours import MOST, find_neighbours
from locomotion.crowd.orca_program import choose_velocity
from locomotion.crowd.queueing import direct, waiting_wish, waits_behind
from locomotion.crowd.steering import follow
from navmesh.surface.clearance_field import floor_at
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["advance_all"]

_HORIZON = 0.6
"""[s] for which a body predicts others."""
_FARTHEST = 3.5
"""[m] greatest distance between the rims of two bodies that notice each other."""
_ROUNDS = 4
"""Passes per tick that resolve overlaps."""
_TURN_RATE = 6.0
"""[rad/s] greatest turn of the figure."""
_ASIDE, _EARLY = 0.5, 1.5
"""[m/s] at which a standing body makes way, and [m] before one with the right of way touches it."""
_TOUCH = 0.1
"""[m] largest gap between two bodies in contact."""
_AT_REST = 0.05
"""[m/s] below which an externally moved body counts as standing."""
_COMPANY = 1.0
"""[m] between two bodies that count as near each other."""
_PATIENCE_ALONE, _PATIENCE = 8.0, 300.0
"""[s] without progress after which a body is stuck: with nobody in contact, and among others."""
_SIGHTLESS = 0.5
"""[s] without seeing its next corner after which a body requests another route."""


@allocating_kernel
def _reaches(rows):
    """How far each body looks for others [m], (n,)."""
    widest = rows[:, at.RADIUS].max()
    reach = np.empty(rows.shape[0])
    for i in range(rows.shape[0]):
        row = rows[i]
        speed = max(row[at.WISH], sqrt(row[at.VX] * row[at.VX] + row[at.VY] * row[at.VY]))
        reach[i] = row[at.RADIUS] + widest + min(2.0 * speed * _HORIZON, _FARTHEST)
    return reach


@kernel
def _settle(rows, i, neighbours, count):
    """Whether a body has come as near to its goal as those that stand there let it."""
    row = rows[i]
    dx, dy = row[at.GOAL_X] - row[at.X], row[at.GOAL_Y] - row[at.Y]
    if dx * dx + dy * dy > 400.0 * row[at.RADIUS] * row[at.RADIUS]:
        return False
    for k in range(count):
        other = rows[neighbours[k]]
        led = other[at.MODE] == at.LED
        goes_on = led and max(abs(other[at.VX]), abs(other[at.VY])) > _AT_REST
        if other[at.MODE] == at.WALKING or goes_on:
            continue
        px, py = other[at.X] - row[at.X], other[at.Y] - row[at.Y]
        near = row[at.RADIUS] + other[at.RADIUS] + _TOUCH
        if px * px + py * py > near * near:
            continue
        if led:
            near += 2.0 * row[at.RADIUS]  # it finds no room between that and its goal
        # it stands on the goal, or was on its way there too
        gx, gy = other[at.GOAL_X] - row[at.GOAL_X], other[at.GOAL_Y] - row[at.GOAL_Y]
        if (px - dx) * (px - dx) + (py - dy) * (py - dy) < near * near:
            return True
        if not led and gx * gx + gy * gy < row[at.RADIUS] * row[at.RADIUS]:
            return True
    return False


@kernel
def _make_way(rows, i, neighbours, count):
    """The velocity at which one that stands steps aside for those who want to pass."""
    wx = wy = 0.0
    for k in range(count):
        other = rows[neighbours[k]]
        px, py = rows[i, at.X] - other[at.X], rows[i, at.Y] - other[at.Y]
        wide = rows[i, at.RADIUS] + other[at.RADIUS] + _TOUCH
        near = wide if other[at.WEIGHT] <= rows[i, at.WEIGHT] else wide + _EARLY
        gx, gy = other[at.GO_X], other[at.GO_Y]
        size = sqrt(gx * gx + gy * gy)
        if other[at.MODE] == at.STANDING or gx * px + gy * py <= 0.0 or size < _ASIDE:
            continue
        if px * px + py * py > near * near or abs(gx * py - gy * px) > wide * size:
            continue
        if rows[i, at.MODE] == at.WALKING and other[at.WEIGHT] <= rows[i, at.WEIGHT]:
            continue
        side = 1.0 if gx * py - gy * px >= 0.0 else -1.0
        wx -= side * _ASIDE * gy / size
        wy += side * _ASIDE * gx / size
    return wx, wy


@kernel
def _in_company(rows, i, neighbours, count):
    if count == 0:
        return False
    other = rows[neighbours[0]]
    dx, dy = other[at.X] - rows[i, at.X], other[at.Y] - rows[i, at.Y]
    near = rows[i, at.RADIUS] + other[at.RADIUS] + _COMPANY
    return dx * dx + dy * dy < near * near


@kernel
def _wish(net, rows, routes, crossings, i, neighbours, count, dt):
    """The velocity that a body wishes, and notes for its owner."""
    row = rows[i]
    if row[at.NOTE] != at.QUIET:
        return 0.0, 0.0
    if row[at.MODE] == at.STANDING:
        return _make_way(rows, i, neighbours, count)
    wx, wy = follow(net, row, routes, i, dt, count > 0)
    if row[at.PASSAGE] == at.FAR and waits_behind(rows, crossings, i, neighbours, count):
        row[at.PASSAGE] = at.WAITING
    if row[at.PASSAGE] == at.WAITING or row[at.PASSAGE] == at.RETREATING:
        row[at.WAITED] = row[at.ALONE] = row[at.BLIND] = 0.0
        ax, ay = _make_way(rows, i, neighbours, count)
        if ax * ax + ay * ay > 0.0:
            return ax, ay
        return waiting_wish(rows, crossings, i, neighbours, count)
    if row[at.NOTE] == at.QUIET and row[at.WAITED] > 0.5 and _settle(rows, i, neighbours, count):
        row[at.NOTE] = at.ARRIVED
    if not _in_company(rows, i, neighbours, count):
        row[at.ALONE] += dt
    if row[at.NOTE] == at.QUIET:
        if row[at.ALONE] > _PATIENCE_ALONE or row[at.WAITED] > _PATIENCE:
            row[at.NOTE] = at.STUCK
        elif row[at.BLIND] > _SIGHTLESS:
            row[at.NOTE] = at.OFF_ROUTE
    return wx, wy


@kernel
def _turn(row, dt):
    """Face where it goes; at rest, where it was told to."""
    speed = sqrt(row[at.VX] * row[at.VX] + row[at.VY] * row[at.VY])
    if row[at.MODE] == at.WALKING:
        if speed < 0.15:
            return
        wanted = atan2(row[at.VY], row[at.VX])
    else:
        wanted = row[at.FACING]
        if np.isnan(wanted):
            return
    turn = (wanted - row[at.YAW] + pi) % (2.0 * pi) - pi
    most = _TURN_RATE * dt
    row[at.YAW] = (row[at.YAW] + min(max(turn, -most), most) + pi) % (2.0 * pi) - pi


@allocating_kernel
def advance_all(net, rows, turns, ways, gates, dt):
    """Advance the bodies of ``rows`` (n, ROW) whose turn it is, ``turns`` (m,) bool of the first m, by ``dt``
    [s]; the others are where they are, moving as they do. ``ways``: routes and crossings; ``gates``: how many
    there are."""
    n, crossings = rows.shape[0], ways[1]
    moves = np.zeros(n, np.bool_)
    for i in range(turns.size):
        moves[i] = turns[i] and rows[i, at.MODE] < at.LED  # and not rooted
    if gates > 0:
        direct(rows, crossings, gates, turns, dt)
    order, neighbours, counts = find_neighbours(
        rows[:, at.X].copy(),
        rows[:, at.Y].copy(),
        rows[:, at.Z].copy(),
        _reaches(rows),
        moves,
    )
    movers = np.empty(n, np.int64)
    count = 0
    for i in order:
        if moves[i]:
            movers[count] = i
            count += 1
    movers = movers[:count]
    near = movers, neighbours, counts
    planes, velocity = np.empty((2, MOST + MOST_WALLS, 3)), np.empty((n, 2))
    _choose_all(net, rows, ways, near, planes, velocity, dt)
    room = rows[:, at.X].copy(), rows[:, at.Y].copy(), np.empty(n, np.int64)
    _move_all(net, rows, velocity, near, room, dt)
    for i in range(turns.size):
        if turns[i]:
            rows[i, at.AGE] += 1.0


@kernel
def _choose_all(net, rows, ways, near, planes, velocity, dt):
    """Write the velocity of each body that moves. ``ways``: routes and crossings; ``near``: their numbers,
    such that near ones are near each other among them, then as of `find_neighbours`. ``planes`` (2, k, 3) is
    overwritten."""
    routes, crossings = ways
    movers, neighbours, counts = near
    planes, work = planes[0], planes[1]
    for i in movers:
        row = rows[i]
        wx, wy = _wish(net, rows, routes, crossings, i, neighbours[i], counts[i], dt)
        row[at.GO_X], row[at.GO_Y] = wx, wy
        radius, top = row[at.RADIUS], max(row[at.WISH], 0.5)
        walls = wall_planes(net, planes, int(row[at.CELL]), row[at.X], row[at.Y], radius, top)
        used = walls
        for k in range(counts[i]):
            other = rows[neighbours[i, k]]
            body_plane(
                planes, used, other[at.X] - row[at.X], other[at.Y] - row[at.Y],
                row[at.VX], row[at.VY], other[at.VX], other[at.VY], radius + other[at.RADIUS],
                other[at.WEIGHT] / (row[at.WEIGHT] + other[at.WEIGHT]), _HORIZON,
            )  # fmt: skip
            used += 1
        vx, vy = choose_velocity(planes, used, walls, top, wx, wy, work)
        dx, dy = vx - row[at.VX], vy - row[at.VY]
        change = sqrt(dx * dx + dy * dy)
        most = row[at.ACCELERATION] * dt
        if change > most:
            vx, vy = row[at.VX] + dx * most / change, row[at.VY] + dy * most / change
        velocity[i, 0], velocity[i, 1] = vx, vy


@kernel
def _move_all(net, rows, velocity, near, room, dt):
    """Take the steps, out of each other and along the walls. ``room``: x and y of all, cells (n,) that are
    overwritten."""
    movers, neighbours, counts = near
    x, y, cells = room
    for i in movers:
        x[i] += dt * velocity[i, 0]
        y[i] += dt * velocity[i, 1]
    for turn in range(_ROUNDS):
        for i in movers:
            part(rows, x, y, i, neighbours[i], counts[i])
            if turn == _ROUNDS - 1 or net.clearance[int(rows[i, at.CELL])] < 2.0 * rows[i, at.RADIUS]:
                cells[i], x[i], y[i] = slide(
                    net, int(rows[i, at.CELL]), rows[i, at.X], rows[i, at.Y], x[i], y[i], rows[i, at.RADIUS]
                )
    for i in movers:
        row = rows[i]
        row[at.VX], row[at.VY] = (x[i] - row[at.X]) / dt, (y[i] - row[at.Y]) / dt
        top = max(row[at.WISH], 0.5)
        speed = sqrt(row[at.VX] * row[at.VX] + row[at.VY] * row[at.VY])
        if speed > top:
            row[at.VX] *= top / speed
            row[at.VY] *= top / speed
        row[at.X], row[at.Y], row[at.CELL] = x[i], y[i], cells[i]
        row[at.Z] = floor_at(net, cells[i], x[i], y[i])
        _turn(row, dt)
