"""Lists of line segments seen from above: rows of (ax, ay, bx, by), the lesser end first, so that a segment
is the same row from whichever side it was found."""

import numpy as np

from navmesh.level.raster import TOUCH
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["comes_near", "keep", "lies_on", "part_in_square", "put", "sort_and_thin", "twice"]

_SAME = 1e-3
"""[m]: edges of the floor this near to a wall are where the wall stands."""
_SEEN = 0.02
"""[m]: a blocker this near to the way to a neighbour says why there is no link."""


@kernel(error_model="numpy", forceinline=True)
def put(rows, count, ax, ay, bx, by):
    """Put a segment behind the first ``count`` rows; returns their new number."""
    if (bx, by) < (ax, ay):
        ax, ay, bx, by = bx, by, ax, ay
    rows[count, 0], rows[count, 1], rows[count, 2], rows[count, 3] = ax, ay, bx, by
    return count + 1


@kernel(error_model="numpy")
def part_in_square(ax, ay, bx, by, x, y, half):
    """From where to where (0 to 1) the segment a-b is in the square about (x, y); the first is greater where
    it is not."""
    first, last = 0.0, 1.0
    for axis in range(2):
        along = bx - ax if axis == 0 else by - ay
        off = ax - x if axis == 0 else ay - y
        if abs(along) < 1e-15:
            if abs(off) > half:
                return 1.0, 0.0
            continue
        one, two = (-half - off) / along, (half - off) / along
        first = max(first, min(one, two))
        last = min(last, max(one, two))
    return first, last


@kernel(error_model="numpy", forceinline=True)
def _is_at(row, x, y, within):
    """Whether (x, y) is ``within`` [m], along both axes together, of the segment ``row``."""
    ex, ey = row[2] - row[0], row[3] - row[1]
    vx, vy = x - row[0], y - row[1]
    length = ex * ex + ey * ey
    t = min(max((vx * ex + vy * ey) / length, 0.0), 1.0) if length > 0.0 else 0.0
    return abs(vx - t * ex) + abs(vy - t * ey) <= within


@kernel(error_model="numpy")
def lies_on(rows, count, ax, ay, bx, by):
    """Whether the segment a-b lies on one of the first ``count`` rows: a wall stands at the edge of the
    floor."""
    for k in range(count):
        row = rows[k]
        if row[0] == row[2] and row[1] == row[3]:
            continue
        if _is_at(row, ax, ay, _SAME) and _is_at(row, bx, by, _SAME):
            return True
    return False


@kernel(error_model="numpy")
def comes_near(rows, count, ax, ay, bx, by):
    """Whether one of the first ``count`` rows comes near the way from a to b, which runs along an axis. What
    is near to a only does not count: it may lie behind."""
    ax, ay = ax + 2.0 * _SEEN * ((bx > ax) - (bx < ax)), ay + 2.0 * _SEEN * ((by > ay) - (by < ay))
    low_x, high_x, low_y, high_y = min(ax, bx), max(ax, bx), min(ay, by), max(ay, by)
    middle_x, middle_y = 0.5 * (ax + bx), 0.5 * (ay + by)
    half = 0.5 * max(high_x - low_x, high_y - low_y) + _SEEN
    for k in range(count):
        begin, end = part_in_square(rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3], middle_x, middle_y, half)
        if begin > end:
            continue
        ex, ey = rows[k, 2] - rows[k, 0], rows[k, 3] - rows[k, 1]
        cx, cy = rows[k, 0] + begin * ex, rows[k, 1] + begin * ey
        dx, dy = rows[k, 0] + end * ex, rows[k, 1] + end * ey
        if high_x - low_x > high_y - low_y:
            if min(cy, dy) <= high_y + _SEEN and max(cy, dy) >= low_y - _SEEN:
                return True
        elif min(cx, dx) <= high_x + _SEEN and max(cx, dx) >= low_x - _SEEN:
            return True
    return False


@kernel(error_model="numpy")
def sort_and_thin(rows, count):
    """Sort the first ``count`` rows and drop those that lie on another one; returns how many are left. So the
    list does not depend on the order of the triangles."""
    for k in range(1, count):
        ax, ay, bx, by = rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3]
        at = k
        while at > 0 and (ax, ay, bx, by) < (
            rows[at - 1, 0],
            rows[at - 1, 1],
            rows[at - 1, 2],
            rows[at - 1, 3],
        ):
            for i in range(4):
                rows[at, i] = rows[at - 1, i]
            at -= 1
        rows[at, 0], rows[at, 1], rows[at, 2], rows[at, 3] = ax, ay, bx, by
    kept = 0
    for k in range(count):
        ax, ay, bx, by = rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3]
        size = (bx - ax) ** 2 + (by - ay) ** 2
        dropped = False
        for other in range(count):
            if rows[other, 0] > ax + TOUCH:
                break  # the rows are sorted by their lesser x
            if other == k or rows[other, 2] < bx - TOUCH:
                continue
            row = rows[other]
            if _is_at(row, ax, ay, TOUCH) and _is_at(row, bx, by, TOUCH):
                # of two that lie on each other the first stays
                length = (row[2] - row[0]) ** 2 + (row[3] - row[1]) ** 2
                if size < length - TOUCH or other < k:
                    dropped = True
                    break
        if not dropped:
            if kept < k:
                for i in range(4):
                    rows[kept, i] = rows[k, i]
            kept += 1
    return kept


@kernel(error_model="numpy")
def keep(rows, at, found, count):
    """Put the first ``count`` rows of ``found`` behind the first ``at`` rows; returns how many there are now.
    Where they have no room it puts none and returns -1."""
    if at + count > rows.shape[0]:
        return -1
    for k in range(count):
        for i in range(4):
            rows[at + k, i] = found[k, i]
    return at + count


@allocating_kernel(error_model="numpy")
def twice(rows):
    """The rows, with room for as many again."""
    more = np.empty((2 * rows.shape[0], rows.shape[1]))
    more[: rows.shape[0]] = rows
    return more
