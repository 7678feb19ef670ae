"""Rule 1 for steep faces: those of a step, however its riser slants, belong to the floor."""

import numpy as np

from navmesh.level.raster import (
    AX,
    AY,
    BX,
    BY,
    CX,
    CY,
    FALL,
    FLOOR,
    KIND,
    SAME_SURFACE,
    TOUCH,
    UPHILL_X,
    UPHILL_Y,
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


@kernel(error_model="numpy")
def faces_up(table, f):
    """Whether a prepared triangle faces up."""
    return (table[f, BX] - table[f, AX]) * (table[f, CY] - table[f, AY]) - (table[f, BY] - table[f, AY]) * (
        table[f, CX] - table[f, AX]
    ) > 0.0


@kernel(error_model="numpy")
def _ways_out(table, f, x, y, dx, dy):
    """How far it is from (x, y), a point of an upward face, to the face's edge [m]: in direction (dx, dy),
    and in the opposite one."""
    ahead, behind = np.inf, np.inf
    for k in range(3):
        j = 3 * k + 3 if k < 2 else 0
        ex, ey = table[f, j] - table[f, 3 * k], table[f, j + 1] - table[f, 3 * k + 1]
        leaving = dx * ey - dy * ex
        if abs(leaving) > 1e-12:
            out = ((table[f, 3 * k] - x) * ey - (table[f, 3 * k + 1] - y) * ex) / leaving
            if leaving > 0.0:
                ahead = min(ahead, out)
            else:
                behind = min(behind, -out)
    return max(ahead, 0.0), max(behind, 0.0)


@kernel(error_model="numpy")
def _next_face(table, start, triangle, patch, x, y, z, left):
    """The steep face at (x, y, z) that faces up, or -1, and whether a level enough one is within ``left``."""
    column = column_at(patch, x, y)
    if column < 0:
        return -1, False
    chosen = -1
    level = False
    for k in range(start[column], start[column + 1]):
        t = triangle[k]
        if table[t, KIND] == UPRIGHT:
            break
        floor = table[t, KIND] == FLOOR
        reach = left + TOUCH if floor else SAME_SURFACE
        if (floor and level) or abs(height_at(table, t, x, y) - z) > reach or not is_over(table, t, x, y):
            continue
        if floor:
            level = True
        elif faces_up(table, t) and (chosen < 0 or comes_first(table, t, chosen)):
            chosen = t
    return chosen, level


@kernel(error_model="numpy")
def _height_to_floor(table, start, triangle, patch, t, x, y, way, out, step, headroom):
    """Height from (x, y) on the steep face ``t`` along the fall line, up (way 1) or down (way -1), to the
    first floor [m], or inf when that is more than ``step``. It is ``out`` [m] to the edge of ``t``."""
    z = height_at(table, t, x, y)
    begin = z
    for face in range(_FACES):
        dx, dy = way * table[t, UPHILL_X], way * table[t, UPHILL_Y]
        if face > 0:
            out, _ = _ways_out(table, t, x, y, dx, dy)
        z += way * out * table[t, FALL]
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


@kernel(error_model="numpy")
def on_riser(table, start, triangle, patch, t, x, y, step, headroom):
    """Whether (x, y) on the steep face ``t``, which faces up, is on a riser: the fall line through it leads
    over steep faces to floor above and to floor below that are at most ``step`` apart in height."""
    dx, dy = table[t, UPHILL_X], table[t, UPHILL_Y]
    # most steep faces are too high, by themselves or with those above them
    ahead, behind = _ways_out(table, t, x, y, dx, dy)
    below = behind * table[t, FALL]
    if below + ahead * table[t, FALL] > step + TOUCH:
        return False
    up = _height_to_floor(table, start, triangle, patch, t, x, y, 1.0, ahead, step - below, headroom)
    if up == np.inf:
        return False
    down = _height_to_floor(table, start, triangle, patch, t, x, y, -1.0, behind, step - up, headroom)
    return up + down <= step + TOUCH
