"""Edges of the floor behind which it does not go on, in the squares of the columns where that is asked."""

import math

import numpy as np

from navmesh.level.raster import (
    FLOOR,
    HIGHEST,
    KIND,
    LOWEST,
    PLANE,
    TOUCH,
    UPRIGHT,
    column_at,
    height_at,
    is_over,
    middle_of,
)
from navmesh.surface.ledges import GAP, floor_at
from navmesh.surface.risers import faces_up, on_riser
from navmesh.surface.segments import part_in_square, twice
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["EDGE", "END", "MIDDLE", "find_floor_ends"]

END = 9
"""Numbers of a floor end: the part of an edge at which the floor ends, as a segment; from `EDGE` on the part
of the edge that is in the square, as a segment; and at `MIDDLE` the height of that one's middle [m]."""
EDGE, MIDDLE = 4, 8
_UNKNOWN, _SHARED, _ALONE = 0, 1, 2
"""What is known of a triangle's edge: not asked yet; another floor goes on beyond it; none has the same
edge."""
_PIECE = 0.5
"""Share of a cell: an edge of the floor is asked this often whether there is floor beyond it."""
_KNOWN = 4096
"""Parts of edges that are remembered: more than the columns along a side of most levels come to."""
_BEYOND = 1e-3
"""[m] beyond an edge: there is floor there, or the edge is where it ends."""


@kernel(error_model="numpy")
def _walked_on(table, start, triangle, patch, x, y, z, step, headroom):
    """Whether (x, y) is a floor point (rule 1) within ``step`` of z."""
    column = column_at(patch, x, y)
    if column < 0 or start[column] == start[column + 1]:
        return False
    if floor_at(table, start, triangle, patch, x, y, z, step, headroom) >= 0:
        return True
    for k in range(start[column], start[column + 1]):
        f = triangle[k]
        if table[f, KIND] == UPRIGHT:
            break
        if table[f, KIND] != PLANE or not faces_up(table, f):
            continue
        here = height_at(table, f, x, y)
        if abs(here - z) <= step + TOUCH and is_over(table, f, x, y):
            if on_riser(table, start, triangle, patch, f, x, y, step, headroom):
                return True
    return False


@kernel(error_model="numpy")
def _is_shared(table, start, triangle, column, f, i, j):
    """Whether another floor in the column has the same edge, from corner j to corner i, as triangle f."""
    for k in range(start[column], start[column + 1]):
        g = triangle[k]
        if table[g, KIND] != FLOOR:
            break
        if g == f:
            continue
        for m in range(3):
            n = 3 * m + 3 if m < 2 else 0
            same = True
            for axis in range(3):
                same &= table[g, 3 * m + axis] == table[f, j + axis]
                same &= table[g, n + axis] == table[f, i + axis]
            if same:
                return True
    return False


@kernel(error_model="numpy")
def _ends_of_column(
    table, start, triangle, shared, known, known_part, column, low, high, patch, step, headroom, ends, count
):  # fmt: skip
    """Put the floor ends in the square of ``column``, between two heights, behind the first ``count`` rows;
    returns their number, which is greater than there are rows where those do not suffice.

    An edge on the border of two columns is in both of their squares: what was found for the one is ``known``
    (`_KNOWN`, 3), the edge with the rows from the first up to the last, and ``known_part`` of the edge.
    """
    half = 0.5 * patch.side
    x, y = middle_of(patch, column)
    for k in range(start[column], start[column + 1]):
        f = triangle[k]
        if table[f, KIND] != FLOOR:
            break
        if table[f, HIGHEST] < low or table[f, LOWEST] > high:
            continue
        for m in range(3):
            if shared[f, m] == _SHARED:
                continue
            i, j = 3 * m, 3 * m + 3 if m < 2 else 0
            ax, ay, bx, by = table[f, i], table[f, i + 1], table[f, j], table[f, j + 1]
            first, last = part_in_square(ax, ay, bx, by, x, y, half + TOUCH)
            length = math.hypot(bx - ax, by - ay)
            if (last - first) * length < 1e-9:
                continue
            rise = table[f, j + 2] - table[f, i + 2]
            middle = table[f, i + 2] + 0.5 * (first + last) * rise
            if not low <= middle <= high:
                continue
            if shared[f, m] == _UNKNOWN:
                found = _is_shared(table, start, triangle, column, f, i, j)
                shared[f, m] = _SHARED if found else _ALONE
                if found:
                    continue
            edge = 3 * np.int64(f) + m
            slot = (edge + int(_KNOWN * last)) & (_KNOWN - 1)
            if known[slot, 0] == edge and known_part[slot, 0] == first and known_part[slot, 1] == last:
                for at in range(known[slot, 1], known[slot, 2]):
                    for number in range(END if count < ends.shape[0] else 0):
                        ends[count, number] = ends[at, number]
                    count += 1
                continue
            begin = count
            third = 3 * m - 3 if m > 0 else 6
            ox, oy = (by - ay) / length, (ax - bx) / length  # to the side of the edge away from the face
            if (table[f, third] - ax) * ox + (table[f, third + 1] - ay) * oy > 0.0:
                ox, oy = -ox, -oy
            pieces = int((last - first) * length / (_PIECE * patch.side)) + 1
            begun = -1.0
            for piece in range(pieces + 1):
                floor_ends = False
                if piece < pieces:
                    s = first + (piece + 0.5) / pieces * (last - first)
                    sx, sy, sz = ax + s * (bx - ax), ay + s * (by - ay), table[f, i + 2] + s * rise
                    floor_ends = not _walked_on(
                        table, start, triangle, patch,
                        sx + _BEYOND * ox, sy + _BEYOND * oy, sz, step, headroom,
                    ) and not _walked_on(
                        table, start, triangle, patch,
                        sx + GAP * ox, sy + GAP * oy, sz, step, headroom,
                    )  # fmt: skip
                at = first + piece / pieces * (last - first)
                if floor_ends and begun < 0.0:
                    begun = at
                elif not floor_ends and begun >= 0.0:
                    if count < ends.shape[0]:
                        for axis in range(2):
                            corner, way = table[f, i + axis], table[f, j + axis] - table[f, i + axis]
                            ends[count, axis] = corner + begun * way
                            ends[count, 2 + axis] = corner + at * way
                            ends[count, EDGE + axis] = corner + first * way
                            ends[count, EDGE + 2 + axis] = corner + last * way
                        ends[count, MIDDLE] = middle
                    count += 1
                    begun = -1.0
            if count <= ends.shape[0]:
                known[slot, 0], known[slot, 1], known[slot, 2] = edge, begin, count
                known_part[slot, 0], known_part[slot, 1] = first, last
    return count


@kernel(error_model="numpy")
def _ends_from(
    table, start, triangle, shared, known, known_part, row, asked, patch, step, headroom,
    end_start, ends, column,
):  # fmt: skip
    """Fill in the columns from ``column`` on, as far as there are rows; returns the first that is left."""
    while column < row.shape[0]:
        count, at = end_start[column], row[column]
        if at >= 0:
            count = _ends_of_column(
                table, start, triangle, shared, known, known_part, column, asked[at, 0], asked[at, 1],
                patch, step, headroom, ends, count,
            )  # fmt: skip
            if count > ends.shape[0]:
                return column
        column += 1
        end_start[column] = count
    return column


@allocating_kernel(error_model="numpy")
def find_floor_ends(table, start, triangle, row, asked, patch, step, headroom):
    """The floor ends in the squares of all columns: those of column c are
    ``ends[end_start[c]:end_start[c + 1]]``.

    The arrays are those of `navmesh.level.raster`. ``row`` (columns,) int32 says which row of ``asked``
    (r, 2) [m] has the heights between which floor is looked at, -1 for none. Returns end_start (columns + 1,)
    int32 and ends (k, `END`) float64.
    """
    end_start = np.zeros(row.shape[0] + 1, np.int32)
    ends = np.empty((64, END))
    shared = np.zeros((table.shape[0], 3), np.uint8)
    known, known_part = np.full((_KNOWN, 3), -1, np.int64), np.empty((_KNOWN, 2))
    column = 0
    while True:
        column = _ends_from(
            table, start, triangle, shared, known, known_part, row, asked, patch, step, headroom,
            end_start, ends, column,
        )  # fmt: skip
        if column == row.shape[0]:
            return end_start, ends
        ends = twice(ends)
