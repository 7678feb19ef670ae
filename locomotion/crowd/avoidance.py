"""Velocities that are forbidden to a body: a half-plane for each neighbour and each wall nearby.

Rows (nx, ny, c) as in `locomotion.crowd.orca_program`. The planes of neighbours are those of van den Berg and
others (2011), sections 4 and 5.1, with shares by weight instead of halves. Walls: the nearest points of the
surface's end, to the body and to the cells around it, each forbid coming closer than the radius.
"""

from math import sqrt

from navmesh.surface.clearance_field import centre_of, gap_at
from navmesh.surface.recall import nearest_of
from navmesh.surface.storeys import linked
from surefoot.kernels import kernel

__all__ = ["MOST_WALLS", "body_plane", "wall_planes"]

MOST_WALLS = 5
_SETTLE = 0.15
"""[s] within which overlapping bodies separate, and a body too near a wall leaves it."""
_WALL_TIME = 0.3
"""[s] that a body looks ahead for walls."""
_SAME = 0.97
"""Cosine of the angle up to which two points of a wall count as one."""


@kernel
def body_plane(planes, row, px, py, vx, vy, ox, oy, reach, share, horizon):
    """Write into planes[row] what a neighbour forbids.

    (px, py): where it is, seen from the body [m]; (vx, vy), (ox, oy): velocities of the body and of the
    other [m/s]; reach: sum of the radii [m]; share: of the change that the body takes; horizon [s].
    """
    wx, wy = vx - ox, vy - oy
    squared = px * px + py * py
    if squared > reach * reach:
        ax, ay = wx - px / horizon, wy - py / horizon
        size = ax * ax + ay * ay
        toward = ax * px + ay * py
        if toward < 0.0 and toward * toward > reach * reach * size:
            # out by the round front of the cone
            size = sqrt(size)
            nx, ny = ax / size, ay / size
            off = reach / horizon - size
        else:
            leg = sqrt(squared - reach * reach)
            if px * ay - py * ax > 0.0:
                nx, ny = -(px * reach + py * leg) / squared, (px * leg - py * reach) / squared
            else:
                nx, ny = -(px * reach - py * leg) / squared, -(px * leg + py * reach) / squared
            off = -(wx * nx + wy * ny)
    else:
        ax, ay = wx - px / _SETTLE, wy - py / _SETTLE
        size = sqrt(ax * ax + ay * ay)
        if size > 1e-9:
            nx, ny = ax / size, ay / size
        else:
            nx, ny = 1.0, 0.0
        off = reach / _SETTLE - size
    planes[row, 0], planes[row, 1] = -nx, -ny
    planes[row, 2] = -(nx * vx + ny * vy) - share * off


@kernel
def _add_wall(planes, count, x, y, qx, qy, radius):
    """Add the plane of the surface's end at (qx, qy) unless it has one; returns how many there are."""
    nx, ny = qx - x, qy - y
    far = sqrt(nx * nx + ny * ny)
    if far < 1e-9:
        return count
    nx /= far
    ny /= far
    room = far - radius
    limit = room / (_WALL_TIME if room > 0.0 else _SETTLE)
    for i in range(count):
        if planes[i, 0] * nx + planes[i, 1] * ny > _SAME:
            if limit < planes[i, 2]:
                planes[i, 0], planes[i, 1], planes[i, 2] = nx, ny, limit
            return count
    if count == MOST_WALLS:
        return count
    planes[count, 0], planes[count, 1], planes[count, 2] = nx, ny, limit
    return count + 1


@kernel
def wall_planes(net, planes, k, x, y, radius, speed):
    """Write the planes of the walls around (x, y), a point in cell ``k``; returns how many."""
    reach = radius + speed * _WALL_TIME
    if net.clearance[k] > reach + net.cell:
        return 0
    gap, qx, qy = gap_at(net, k, x, y)
    if gap > reach:
        return 0
    count = _add_wall(planes, 0, x, y, qx, qy, radius)
    away = max(int(radius / net.cell + 0.5), 1)
    for way in range(4):
        c = k
        for _ in range(away):
            other = linked(net, c, way)
            if other < 0:
                break
            c = other
        if c == k:
            continue
        if net.clearance[c] > reach + (away + 2) * net.cell:
            continue
        cx, cy = centre_of(net, c)
        off_x, off_y = nearest_of(net, c)
        px, py = cx + off_x, cy + off_y
        if (px - x) * (px - x) + (py - y) * (py - y) < reach * reach:
            count = _add_wall(planes, count, x, y, px, py, radius)
    return count
