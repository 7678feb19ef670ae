"""Move bodies over the surface, out of each other, never off it or into a wall."""

from math import sqrt

from locomotion.crowd import layout as at
from navmesh.surface.clearance_field import gap_at, walk
from surefoot.kernels import kernel

__all__ = ["part", "slide"]

_PRESSED = 0.995
"""Share of the radius that is always kept free of walls."""
_STIFF = 0.9
"""Share of an overlap that is resolved per pass."""


@kernel
def part(rows, x, y, i, neighbours, count):
    """Move body ``i`` out of its neighbours by its share of the overlaps, in x and y (n,)."""
    px, py = x[i], y[i]
    for k in range(count):
        j = neighbours[k]
        dx, dy = px - x[j], py - y[j]
        reach = rows[i, at.RADIUS] + rows[j, at.RADIUS]
        squared = dx * dx + dy * dy
        if squared >= reach * reach:
            continue
        far = sqrt(squared)
        share = _STIFF * rows[j, at.WEIGHT] / (rows[i, at.WEIGHT] + rows[j, at.WEIGHT])
        if far > 1e-6:
            px += share * (reach - far) * dx / far
            py += share * (reach - far) * dy / far
        else:  # coincident bodies: separate them by number
            px += share * reach * (1.0 if i > j else -1.0)
    x[i], y[i] = px, py


@kernel
def _reach(net, k, x, y, tx, ty):
    """(reached, cell) of a step over linked cells."""
    return walk(net, k, x, y, tx, ty, 1e-3, False)[:2]


@kernel
def slide(net, k, x, y, tx, ty, radius):
    """Where a body at (x, y) in cell ``k`` that wants to be at (tx, ty) gets: (cell, x, y).

    Only over linked cells, and no nearer to walls than its radius, or than it was if that is nearer.
    """
    step = sqrt((tx - x) * (tx - x) + (ty - y) * (ty - y))
    if net.clearance[k] > radius + step + 1.5 * net.cell:
        reached, cell = _reach(net, k, x, y, tx, ty)
        if reached:
            return cell, tx, ty
    needed = min(_PRESSED * radius, gap_at(net, k, x, y)[0])
    for _ in range(3):
        reached, cell = _reach(net, k, x, y, tx, ty)
        if reached:
            gap, qx, qy = gap_at(net, cell, tx, ty)
            if gap >= needed:
                return cell, tx, ty
        else:
            # the surface ends in between: slide back along what is nearest to the start
            gap, qx, qy = gap_at(net, k, x, y)
            nx, ny = (qx - x) / max(gap, 1e-9), (qy - y) / max(gap, 1e-9)
            over = nx * (tx - x) + ny * (ty - y) - (gap - radius)
            if over <= 0.0:
                break
            tx -= over * nx
            ty -= over * ny
            continue
        if gap < 1e-9:
            break
        push = (radius - gap) / gap
        tx += push * (tx - qx)
        ty += push * (ty - qy)
    reached, cell = _reach(net, k, x, y, tx, ty)
    if reached and gap_at(net, cell, tx, ty)[0] >= needed:
        return cell, tx, ty
    return k, x, y
