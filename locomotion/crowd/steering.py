"""The velocity a body wants: along its route, from corner to corner, as far ahead as it sees."""

from math import cos, sin, sqrt

from locomotion.crowd import layout as at
from navmesh.surface.clearance_field import floor_at, walk
from surefoot.kernels import kernel

__all__ = ["HEADWAY", "follow"]

HEADWAY = 0.25
"""[m] that count as progress."""
_ARRIVED = 0.15
"""[m] from its goal at which a body has arrived."""
_STEADY = 0.8
"""Share of its acceleration with which a body brakes for its goal."""
_LOOKS = 4
"""Ticks between looks at the corners ahead."""
_THIN = 0.95
"""Share of the radius that must be free on a line to a corner: a body may be pressed against a wall."""
_VISITED = 0.3
"""[m] from its rim within which a body has visited a place on its route."""
_SEEN_STEP = 0.5
"""[m] allowed difference in height between the point reached and the one looked at."""
_SIDESTEP = 0.05
"""[rad] to the right that bodies keep when others are near, so that two that meet head-on pass."""


@kernel
def _sees(net, row, point):
    """Whether a body can go straight to ``point`` (x, y, z)."""
    reached, cell = walk(
        net, int(row[at.CELL]), row[at.X], row[at.Y], point[0], point[1], _THIN * row[at.RADIUS], False
    )[:2]
    return reached and abs(floor_at(net, cell, point[0], point[1]) - point[2]) < _SEEN_STEP


@kernel
def _look(net, row, routes, since):
    """Head for the farthest corner in sight; note when none has been seen for a while."""
    start, count, next_ = int(row[at.ROUTE_START]), int(row[at.ROUTE_COUNT]), int(row[at.NEXT])
    ahead = min(next_ + 1, count - 1)
    here = routes[start + next_]
    away = max(abs(here[at.POINT_X] - row[at.X]), abs(here[at.POINT_Y] - row[at.Y]))
    may_cut = here[at.VIA] == 0.0 or away < _VISITED + row[at.RADIUS]
    if ahead > next_ and may_cut and _sees(net, row, routes[start + ahead]):
        row[at.NEXT] = ahead
        row[at.BLIND] = 0.0
    elif _sees(net, row, routes[start + next_]):
        row[at.BLIND] = 0.0
    else:
        row[at.BLIND] += since


@kernel
def follow(net, row, routes, number, dt, crowded):
    """The velocity (x, y) [m/s] that a walking body wishes; keeps its row's account of the route.

    number: of the body; bodies look at their corners in turn. crowded: whether anybody is near.
    """
    if (int(row[at.AGE]) + number) % _LOOKS == 0:
        _look(net, row, routes, _LOOKS * dt)
    point = routes[int(row[at.ROUTE_START]) + int(row[at.NEXT])]
    dx, dy = point[0] - row[at.X], point[1] - row[at.Y]
    far = sqrt(dx * dx + dy * dy)
    left = far + point[at.LEFT]
    row[at.LEFT_NOW] = left
    if left < row[at.BEST] - HEADWAY:
        row[at.BEST], row[at.WAITED], row[at.ALONE] = left, 0.0, 0.0
    else:
        row[at.WAITED] += dt
    if left < _ARRIVED:
        row[at.NOTE] = at.ARRIVED
        return 0.0, 0.0
    speed = min(row[at.WISH], sqrt(2.0 * _STEADY * row[at.ACCELERATION] * left), left / dt)
    vx, vy = speed * dx / far, speed * dy / far
    if crowded:
        c, s = cos(_SIDESTEP), -sin(_SIDESTEP)
        vx, vy = c * vx - s * vy, s * vx + c * vy
    return vx, vy
