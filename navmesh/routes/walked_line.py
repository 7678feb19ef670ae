"""The line that string pulling has walked so far: corners in ``scratch.points``, and their cells."""

from math import sqrt

import numpy as np

from navmesh.routes.leading_round import SLACK
from navmesh.surface.clearance_field import gap_at, same_place, walk
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["append_corner"]


@kernel(error_model="numpy")
def _cost_along(net, doors, k, ax, ay, bx, by):
    """Length of the line from a, in cell ``k``, to b, weighted by the costs of the nodes that it crosses."""
    length = sqrt((bx - ax) ** 2 + (by - ay) ** 2)
    parts = int(length / (0.5 * net.cell)) + 1
    total = 0.0
    x, y = ax, ay
    for i in range(parts):
        px, py = ax + (bx - ax) * (i + 0.5) / parts, ay + (by - ay) * (i + 0.5) / parts
        k = walk(net, k, x, y, px, py, 0.0, True)[1]
        x, y = px, py
        node = net.label[k]
        total += length / parts * (doors.node_cost[node] if node >= 0 else 1.0)
    return total


@allocating_kernel(error_model="numpy")
def append_corner(net, doors, scratch, first, count, x, y, k):
    """Add a corner to the leg that begins at ``first``, dropping corners that the line of sight jumps
    over."""
    radius = doors.radius * (1.0 + SLACK)
    points = scratch.points
    cells = scratch.cells
    while count - first >= 2:
        vx, vy = points[count - 1, 0], points[count - 1, 1]
        ax, ay = points[count - 2, 0], points[count - 2, 1]
        _, qx, qy = gap_at(net, np.int64(cells[count - 1]), vx, vy)
        dx = x - ax
        dy = y - ay
        length = dx * dx + dy * dy
        s = ((qx - ax) * dx + (qy - ay) * dy) / length if length > 0.0 else 0.0
        s = min(max(s, 0.0), 1.0)
        ex = ax + s * dx - qx
        ey = ay + s * dy - qy
        if ex * ex + ey * ey < radius * radius:
            break
        reached, cell = walk(net, np.int64(cells[count - 2]), ax, ay, x, y, radius, False)[:2]
        if not reached or not same_place(net, cell, k):
            break
        if doors.weighted:
            a = np.int64(cells[count - 2])
            bent = _cost_along(net, doors, a, ax, ay, vx, vy) + _cost_along(
                net, doors, np.int64(cells[count - 1]), vx, vy, x, y
            )
            if _cost_along(net, doors, a, ax, ay, x, y) > bent * (1.0 + 1e-9):
                break
        count -= 1
    points[count, 0] = x
    points[count, 1] = y
    cells[count] = k
    return count + 1
