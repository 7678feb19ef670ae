"""How far each cell is from where walking ends: the nearest places that the cells beside walls and the ends
of the floor know (`navmesh.surface.blockers`), carried on in two passes over the links, so that storeys come
for free.

Each pass goes over the strips of equal ix, forth and back within a strip: that makes four *turns*. A byte for
each cell says where it took its place from in each turn (`choice`): so what was known anywhere after any turn
can be recalled, see `navmesh.surface.clearance_changes`.
"""

import numpy as np

from navmesh.surface.clearance_field import centre_of, gap_at
from navmesh.surface.storeys import APART
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["settle_clearance", "settle_window", "spread_clearance", "sweep"]

OWN, BACK, BACK_AHEAD, BACK_BEHIND, BEHIND_BACK, BEHIND = range(6)
"""Choices of the first turn of a pass, going forth: what it had; the cell in the strip behind; those beside
that one; the same as the latter, by the other way; the cell just behind in the strip."""
AHEAD = 8
"""The choice of the second turn, going back, where it is not the same as in the first: the cell ahead."""
_NONE = -0.0
"""[m] This added to a number gives the number, also to -0.0."""


@kernel(forceinline=True)
def _nearer(nearest, n, dx, dy, way, best, x, y, origin, so_far):
    """The nearer of the place that cell ``n`` knows, (dx, dy) from here, and the one (x, y) that cell
    ``origin`` told by the way ``so_far``: (squared distance, x, y, cell, way). -1 is no cell."""
    if n >= 0:
        vx, vy = nearest[n, 0] + dx, nearest[n, 1] + dy
        if vx * vx + vy * vy < best:
            return vx * vx + vy * vy, vx, vy, np.int64(n), way
    return best, x, y, origin, so_far


@kernel(forceinline=True)
def _over(column_start, storey, c, way, column):
    """The cell of ``column`` that cell ``c`` is linked to, -1 for none."""
    return np.int64(column_start[column]) + storey[c, way] if storey[c, way] != APART else np.int64(-1)


@kernel(nogil=True)
def sweep(
    turn, column_start, cell_column, storey, nearest, squared, source, choice, resolution, nx, ny,
    fixed, known, known_source,
):  # fmt: skip
    """One pass over all strips, forth where ``turn`` is 0 and back where it is 1; in place.

    ``nearest`` (n, 2) float64, ``squared`` (n,) its square, ``source`` (n,) int32, ``choice`` (n,) uint8, to
    which four bits are added. Where there are cells in ``fixed`` (n,) bool, those take what they know after
    each of the four turns from ``known`` (4, n, 2) float64 and ``known_source`` (4, n), and of the others it
    is put there.
    """
    back, side, other = (2, 3, 1) if turn == 0 else (0, 1, 3)
    h = -resolution if turn == 0 else resolution
    strip_behind, just_behind = (-ny, -1) if turn == 0 else (ny, 1)  # columns
    part = fixed.shape[0] > 0
    for strip in range(nx):
        ix = strip if turn == 0 else nx - 1 - strip
        first, last = column_start[ix * ny], column_start[(ix + 1) * ny]
        for k in range(first, last):
            c = k if turn == 0 else first + last - 1 - k
            if part and fixed[c]:
                _take(c, 2 * turn, nearest, squared, source, known, known_source)
                continue
            column = np.int64(cell_column[c])
            n = _over(column_start, storey, c, back, column + strip_behind)
            m = _over(column_start, storey, c, side, column + just_behind)
            ahead = behind = np.int64(-1)  # beside the cell in the strip behind
            if n >= 0:
                column += strip_behind
                ahead = _over(column_start, storey, n, other, column - just_behind)
                behind = _over(column_start, storey, n, side, column + just_behind)
            other_way = BACK_BEHIND
            if n < 0 and m >= 0:
                behind = _over(column_start, storey, m, back, column + just_behind + strip_behind)
                other_way = BEHIND_BACK
            best, x, y, origin, way = squared[c], nearest[c, 0], nearest[c, 1], np.int64(c), OWN
            best, x, y, origin, way = _nearer(nearest, n, h, _NONE, BACK, best, x, y, origin, way)
            best, x, y, origin, way = _nearer(nearest, ahead, h, -h, BACK_AHEAD, best, x, y, origin, way)
            best, x, y, origin, way = _nearer(nearest, behind, h, h, other_way, best, x, y, origin, way)
            best, x, y, origin, way = _nearer(nearest, m, _NONE, h, BEHIND, best, x, y, origin, way)
            if way != OWN:
                squared[c], nearest[c, 0], nearest[c, 1], source[c] = best, x, y, source[origin]
                choice[c] |= way << (4 * turn)
            if part:
                _put(c, 2 * turn, nearest, source, known, known_source)
        for k in range(first, last):
            c = first + last - 1 - k if turn == 0 else k
            if part and fixed[c]:
                _take(c, 2 * turn + 1, nearest, squared, source, known, known_source)
                continue
            best, x, y, origin, way = squared[c], nearest[c, 0], nearest[c, 1], np.int64(c), OWN
            n = _over(column_start, storey, c, other, np.int64(cell_column[c]) - just_behind)
            best, x, y, origin, way = _nearer(nearest, n, _NONE, -h, AHEAD, best, x, y, origin, way)
            if way != OWN:
                squared[c], nearest[c, 0], nearest[c, 1], source[c] = best, x, y, source[origin]
                choice[c] |= way << (4 * turn)
            if part:
                _put(c, 2 * turn + 1, nearest, source, known, known_source)


@kernel(forceinline=True)
def _take(c, turn, nearest, squared, source, known, known_source):
    x, y = known[turn, c, 0], known[turn, c, 1]
    nearest[c, 0], nearest[c, 1], squared[c], source[c] = x, y, x * x + y * y, known_source[turn, c]


@kernel(forceinline=True)
def _put(c, turn, nearest, source, known, known_source):
    known[turn, c, 0], known[turn, c, 1] = nearest[c, 0], nearest[c, 1]
    known_source[turn, c] = source[c]


@allocating_kernel
def spread_clearance(column_start, cell_column, storey, nearest, source, resolution, nx, ny):
    """Carry the nearest places over the links, in place; returns the clearance (n,) and the choices (n,)
    uint8.

    ``nearest`` (n, 2) float64 are the vectors of `navmesh.surface.blockers.nearest_blockers`, ``source`` (n,)
    int32 the list of blockers that the place is from, or -1. A cell takes from the cells behind it, the
    two diagonal ones included.
    """
    cells = storey.shape[0]
    squared = np.empty(cells)
    for c in range(cells):
        squared[c] = nearest[c, 0] * nearest[c, 0] + nearest[c, 1] * nearest[c, 1]
    choice = np.zeros(cells, np.uint8)
    fixed, known, known_source = np.empty(0, np.bool_), np.empty((4, 0, 2)), np.empty((4, 0), np.int32)
    for turn in range(2):
        sweep(
            turn, column_start, cell_column, storey, nearest, squared, source, choice, resolution, nx, ny,
            fixed, known, known_source,
        )  # fmt: skip
    for c in range(cells):
        squared[c] = np.sqrt(squared[c])  # in place: another array would be a tenth of what there is
    return squared, choice


@kernel(nogil=True)
def settle_clearance(field, first, last):
    """Measure the clearance of those of the cells from ``first`` up to, not including, ``last`` that are
    within two cells of where walking ends, in place, in the lists of the cells around: what was carried over
    the links is the nearest place of another cell. So is `nearest`, if it is kept."""
    for c in range(first, last):
        if field.clearance[c] < 2.0 * field.cell:
            x, y = centre_of(field, c)
            gap, at_x, at_y = gap_at(field, c, x, y)
            if gap < field.clearance[c]:
                field.clearance[c] = gap
                if field.nearest.shape[0] > 0:
                    field.nearest[c, 0], field.nearest[c, 1] = at_x - x, at_y - y


@kernel(nogil=True)
def settle_window(field, column_start, window):
    """`settle_clearance` of the cells in the columns of ``window``."""
    for ix in range(window[0], window[2]):
        here = ix * field.ny
        settle_clearance(field, column_start[here + window[1]], column_start[here + window[3]])
