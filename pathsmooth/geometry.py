"""Small planar geometry on discs, compiled."""

from __future__ import annotations

import numpy as np

from surefoot.kernels import kernel


@kernel(inline="always")
def lens_corners(ax, ay, ra, bx, by, rb):
    """The two points where the rims of two discs meet; of no meaning where they do not."""
    dx = bx - ax
    dy = by - ay
    distance = max(np.sqrt(dx * dx + dy * dy), 1e-300)
    along = (distance * distance + ra * ra - rb * rb) / (2.0 * distance)
    across = np.sqrt(max(ra * ra - along * along, 0.0))
    ux = dx / distance
    uy = dy / distance
    x = ax + along * ux
    y = ay + along * uy
    return x - across * uy, y + across * ux, x + across * uy, y - across * ux


@kernel
def nearest_in_lens(x, y, ax, ay, ra, bx, by, rb):
    """The point nearest to (x, y) in two overlapping discs, which may be equal or one inside the other."""
    rounding = 1.0 + 1e-12
    a = np.sqrt((x - ax) ** 2 + (y - ay) ** 2)
    b = np.sqrt((x - bx) ** 2 + (y - by) ** 2)
    if a <= ra * rounding and b <= rb * rounding:
        return x, y
    if a > ra:
        px = ax + ra / a * (x - ax)
        py = ay + ra / a * (y - ay)
        if (px - bx) ** 2 + (py - by) ** 2 <= rb * rb * rounding:
            return px, py
    if b > rb:
        px = bx + rb / b * (x - bx)
        py = by + rb / b * (y - by)
        if (px - ax) ** 2 + (py - ay) ** 2 <= ra * ra * rounding:
            return px, py
    px, py, qx, qy = lens_corners(ax, ay, ra, bx, by, rb)
    if (px - x) ** 2 + (py - y) ** 2 <= (qx - x) ** 2 + (qy - y) ** 2:
        return px, py
    return qx, qy
