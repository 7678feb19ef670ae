"""Rule 1 for steep faces: those of a step, however its riser slants, belong to the floor."""

import math

import numpy as np

from navmesh.level.raster import (
    AX,
    AY,
    BX,
    BY,
    CX,
    CY,
    FLOOR,
    KIND,
    SAME_SURFACE,
    SLOPE_X,
    SLOPE_Y,
    TOUCH,
    UPRIGHT,
    column_at,
    height_at,
    is_over,
)
from navmesh.surface.ledges import comes_first, floor_at
from surefoot.kernels import kernel

__all__ = ["faces_up", "on_riser"]

_FACES = 6
"""Most faces in a row that a riser has."""
_BEYOND = 1e-4
"""[m] by which the fall line is followed over an edge, to what lies beyond it."""


@kernel
def faces_up(table, f):
    """Whether a prepared triangle faces up."""
    return (table[f, BX] - table[f, AX]) * (table[f, CY] - table[f, AY]) - (table[f, BY] - table[f, AY]) * (
        table[f, CX] - table[f, AX]
    ) > 0.0


@kernel
def _way_out(table, f, x, y, dx, dy):
    """How far it is from (x, y), a point of an upward face, in direction (dx, dy) to the face's edge [m]."""
    out = np.inf
    for k in range(3):
        j = 3 * k + 3 if k < 2 else 0
        ex, ey = table[f, j] - table[f, 3 * k], table[f, j + 1] - table[f, 3 * k + 1]
        leaving = dx * ey - dy * ex
        if leaving > 1e-12:
            out = min(out, ((table[f, 3 * k] - x) * ey - (table[f, 3 * k + 1] - y) * ex) / leaving)
    return max(out, 0.0)


@kernel
def _next_face(table, start, triangle, patch, x, y, z, left):
    """The steep face at (x, y, z) that faces up, or -1, and whether a level enough one is within ``left``."""
    column = column_at(patch, x, y)
    if column < 0:
        return -1, False
    chosen = -1
    level = False
    for k in range(start[column], start[column + 1]):
        t = triangle[k]
        reach = left + TOUCH if table[t, KIND] == FLOOR else SAME_SURFACE
        if (
            table[t, KIND] == UPRIGHT
            or abs(height_at(table, t, x, y) - z) > reach
            or not is_over(table, t, x, y)
        ):
            continue
        if table[t, KIND] == FLOOR:
            level = True
        elif faces_up(table, t) and (chosen < 0 or comes_first(table, t, chosen)):
            chosen = t
    return chosen, level


@kernel
def _height_to_floor(table, start, triangle, patch, t, x, y, way, step, headroom):
    """Height from (x, y) on the steep face ``t`` along the fall line, up (way 1) or down (way -1), to the
    first floor [m], or inf when that is more than ``step``."""
    z = height_at(table, t, x, y)
    begin = z
    for _ in range(_FACES):
        fall = math.hypot(table[t, SLOPE_X], table[t, SLOPE_Y])
        dx, dy = way * table[t, SLOPE_X] / fall, way * table[t, SLOPE_Y] / fall
        out = _way_out(table, t, x, y, dx, dy)
        z += way * out * fall
        left = step - abs(z - begin)
        if left < -TOUCH:
            return np.inf
        x += (out + _BEYOND) * dx
        y += (out + _BEYOND) * dy
        t, level = _next_face(table, start, triangle, patch, x, y, z, left)
        if level:
            floor = floor_at(table, start, triangle, patch, x, y, z, left, headroom)
            if floor >= 0:
                return abs(height_at(table, floor, x, y) - begin)
        if t < 0:
            return np.inf
    return np.inf


@kernel
def on_riser(table, start, triangle, patch, t, x, y, step, headroom):
    """Whether (x, y) on the steep face ``t``, which faces up, is on a riser: the fall line through it leads
    over steep faces to floor above and to floor below that are at most ``step`` apart in height."""
    fall = math.hypot(table[t, SLOPE_X], table[t, SLOPE_Y])
    dx, dy = table[t, SLOPE_X] / fall, table[t, SLOPE_Y] / fall
    # most steep faces are too high, by themselves or with those above them
    below = _way_out(table, t, x, y, -dx, -dy) * fall
    if below + _way_out(table, t, x, y, dx, dy) * fall > step + TOUCH:
        return False
    up = _height_to_floor(table, start, triangle, patch, t, x, y, 1.0, step - below, headroom)
    if up == np.inf:
        return False
    down = _height_to_floor(table, start, triangle, patch, t, x, y, -1.0, step - up, headroom)
    return up + down <= step + TOUCH
