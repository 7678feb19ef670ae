"""Where walking ends near a cell, as line segments seen from above: the footprints of walls and the ends of
the floor, exact, from the triangles themselves.

Each cell beside such a place has a list of those in its own square and in the squares beside it that it is
not linked to. Together the lists hold all of them; `navmesh.clearance` carries to every other cell whose
list is nearest.
"""

import math

import numpy as np

from navmesh.ledges import GAP, floor_at, floor_end
from navmesh.raster import FLOOR, PLANE, TOUCH, UPRIGHT, is_over
from navmesh.risers import faces_up, on_riser
from navmesh.walls import clip_band, nearest_on_polygon, range_in_column, wall_base
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["find_blockers", "nearest_blockers"]

_CORNERS = ((1, 1), (-1, 1), (-1, -1), (1, -1))
"""Where one gets by direction d, then d + 1, of `navmesh.surface.DIRECTIONS`."""
_UNKNOWN, _SHARED, _ALONE = 0, 1, 2
"""What is known of a triangle's edge: not asked yet; another floor goes on beyond it; none has the same
edge."""
_PIECE = 0.5
"""Share of a cell: an edge of the floor is asked this often whether there is floor beyond it."""
_BEYOND = 1e-3
"""[m] beyond an edge: there is floor there, or the edge is where it ends."""
_SAME = 1e-3
"""[m]: edges of the floor this near to a wall are where the wall stands."""
_SEEN = 0.02
"""[m]: a blocker this near to the way to a neighbour says why there is no link."""


@allocating_kernel
def _append(rows, count, ax, ay, bx, by):
    """Put a segment behind the first ``count`` rows; returns the rows, which may be new ones."""
    if count == rows.shape[0]:
        more = np.empty((2 * count, 4))
        more[:count] = rows
        rows = more
    if (bx, by) < (ax, ay):  # the same row from either triangle at an edge
        ax, ay, bx, by = bx, by, ax, ay
    rows[count, 0], rows[count, 1], rows[count, 2], rows[count, 3] = ax, ay, bx, by
    return rows


@kernel
def _part_in_square(ax, ay, bx, by, x, y, half):
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


@allocating_kernel
def _add_polygon(rows, count, polygon, corners, flat, x, y, half):
    """Add what of a convex polygon's outline is in the square about (x, y)."""
    if flat:  # all on one line: from its one end to the other
        low = high = 0
        for k in range(1, corners):
            if (polygon[k, 0], polygon[k, 1]) < (polygon[low, 0], polygon[low, 1]):
                low = k
            if (polygon[k, 0], polygon[k, 1]) > (polygon[high, 0], polygon[high, 1]):
                high = k
    for k in range(1 if flat else corners):
        i, j = (low, high) if flat else (k, k + 1 if k + 1 < corners else 0)
        ax, ay, bx, by = polygon[i, 0], polygon[i, 1], polygon[j, 0], polygon[j, 1]
        if (bx, by) < (ax, ay):
            ax, ay, bx, by = bx, by, ax, ay
        first, last = _part_in_square(ax, ay, bx, by, x, y, half)
        if first <= last:
            rows = _append(
                rows, count,
                ax + first * (bx - ax), ay + first * (by - ay), ax + last * (bx - ax), ay + last * (by - ay),
            )  # fmt: skip
            count += 1
    return rows, count


@kernel
def _walked_on(table, start, triangle, resolution, ny, x, y, z, step, headroom):
    """Whether (x, y) is a floor point (rule 1) within ``step`` of z."""
    column = math.floor(x / resolution) * ny + math.floor(y / resolution)
    if column < 0 or column >= start.shape[0] - 1 or start[column] == start[column + 1]:
        return False  # beyond the grid, or empty
    if floor_at(table, start, triangle, resolution, ny, x, y, z, step, headroom) >= 0:
        return True
    for k in range(start[column], start[column + 1]):
        f = triangle[k]
        if table[f, 14] != PLANE or not faces_up(table, f):
            continue
        here = table[f, 9] * x + table[f, 10] * y + table[f, 11]
        if abs(here - z) <= step + TOUCH and is_over(table, f, x, y):
            if on_riser(table, start, triangle, resolution, ny, f, x, y, step, headroom):
                return True
    return False


@kernel
def _is_shared(table, start, triangle, column, f, i, j):
    """Whether another floor in the column has the same edge, from corner j to corner i, as triangle f."""
    for k in range(start[column], start[column + 1]):
        g = triangle[k]
        if table[g, 14] != FLOOR or g == f:
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


@kernel
def _lies_on(rows, first, count, ax, ay, bx, by):
    """Whether the segment a-b lies on a row from ``first`` on: a wall stands at the edge of the floor."""
    for k in range(first, count):
        ex, ey = rows[k, 2] - rows[k, 0], rows[k, 3] - rows[k, 1]
        length = ex * ex + ey * ey
        if length == 0.0:
            continue
        t = min(max(((ax - rows[k, 0]) * ex + (ay - rows[k, 1]) * ey) / length, 0.0), 1.0)
        if abs(rows[k, 0] + t * ex - ax) + abs(rows[k, 1] + t * ey - ay) > _SAME:
            continue
        t = min(max(((bx - rows[k, 0]) * ex + (by - rows[k, 1]) * ey) / length, 0.0), 1.0)
        if abs(rows[k, 0] + t * ex - bx) + abs(rows[k, 1] + t * ey - by) <= _SAME:
            return True
    return False


@allocating_kernel
def _add_floor_ends(
    rows, walls_start, walls_end, count, table, start, triangle, shared, resolution, ny, there, rx, ry,
    x, y, z, p, q, step, headroom,
):  # fmt: skip
    """Add the edges in the square about (rx, ry), column ``there``, behind which there is no floor.

    They are edges of floor within ``step`` of the plane of height z at (x, y) and of gradient (p, q).
    """
    half = 0.5 * resolution
    level = z + p * (rx - x) + q * (ry - y)
    reach = step + resolution * (abs(p) + abs(q)) + TOUCH
    low, high = level - reach, level + reach
    for k in range(start[there], start[there + 1]):
        f = triangle[k]
        if table[f, 14] != FLOOR or table[f, 13] < low or table[f, 12] > high:
            continue
        for m in range(3):
            if shared[f, m] == _SHARED:
                continue
            i, j = 3 * m, 3 * m + 3 if m < 2 else 0
            third = 3 * m - 3 if m > 0 else 6
            ax, ay, bx, by = table[f, i], table[f, i + 1], table[f, j], table[f, j + 1]
            first, last = _part_in_square(ax, ay, bx, by, rx, ry, half + TOUCH)
            length = math.hypot(bx - ax, by - ay)
            if (last - first) * length < 1e-9:
                continue
            middle = 0.5 * (first + last)
            mx, my = ax + middle * (bx - ax), ay + middle * (by - ay)
            mz = table[f, i + 2] + middle * (table[f, j + 2] - table[f, i + 2])
            if abs(mz - z - p * (mx - x) - q * (my - y)) > step + half * (abs(p) + abs(q)) + TOUCH:
                continue
            if shared[f, m] == _UNKNOWN:
                found = _is_shared(table, start, triangle, there, f, i, j)
                shared[f, m] = _SHARED if found else _ALONE
                if found:
                    continue
            if _lies_on(
                rows,
                walls_start,
                walls_end,
                ax + first * (bx - ax),
                ay + first * (by - ay),
                ax + last * (bx - ax),
                ay + last * (by - ay),
            ):
                continue
            ox, oy = (by - ay) / length, (ax - bx) / length  # to the side of the edge away from the face
            if (table[f, third] - ax) * ox + (table[f, third + 1] - ay) * oy > 0.0:
                ox, oy = -ox, -oy
            pieces = int((last - first) * length / (_PIECE * resolution)) + 1
            begun = -1.0
            for piece in range(pieces + 1):
                ends = False
                if piece < pieces:
                    s = first + (piece + 0.5) / pieces * (last - first)
                    sx, sy = ax + s * (bx - ax), ay + s * (by - ay)
                    sz = table[f, i + 2] + s * (table[f, j + 2] - table[f, i + 2])
                    ends = not _walked_on(
                        table, start, triangle, resolution, ny,
                        sx + _BEYOND * ox, sy + _BEYOND * oy, sz, step, headroom,
                    ) and not _walked_on(
                        table, start, triangle, resolution, ny,
                        sx + GAP * ox, sy + GAP * oy, sz, step, headroom,
                    )  # fmt: skip
                at = first + piece / pieces * (last - first)
                if ends and begun < 0.0:
                    begun = at
                elif not ends and begun >= 0.0:
                    rows = _append(
                        rows, count,
                        ax + begun * (bx - ax), ay + begun * (by - ay),
                        ax + at * (bx - ax), ay + at * (by - ay),
                    )  # fmt: skip
                    count += 1
                    begun = -1.0
    return rows, count


@kernel
def _is_near(rows, first, count, ax, ay, bx, by):
    """Whether a row from ``first`` on comes within `_SEEN` of the segment a-b, which runs along an axis."""
    low_x, high_x, low_y, high_y = min(ax, bx), max(ax, bx), min(ay, by), max(ay, by)
    middle_x, middle_y = 0.5 * (ax + bx), 0.5 * (ay + by)
    half = 0.5 * max(high_x - low_x, high_y - low_y) + _SEEN
    for k in range(first, count):
        begin, end = _part_in_square(rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3], middle_x, middle_y, half)
        if begin > end:
            continue
        cx, cy = (
            rows[k, 0] + begin * (rows[k, 2] - rows[k, 0]),
            rows[k, 1] + begin * (rows[k, 3] - rows[k, 1]),
        )
        dx, dy = rows[k, 0] + end * (rows[k, 2] - rows[k, 0]), rows[k, 1] + end * (rows[k, 3] - rows[k, 1])
        if high_x - low_x > high_y - low_y:
            if min(cy, dy) <= high_y + _SEEN and max(cy, dy) >= low_y - _SEEN:
                return True
        elif min(cx, dx) <= high_x + _SEEN and max(cx, dx) >= low_x - _SEEN:
            return True
    return False


@allocating_kernel
def _sort_and_thin(rows, first, count):
    """Sort the rows from ``first`` on and drop those that lie on another one; returns the new count. So the
    list does not depend on the order of the triangles."""
    for k in range(first + 1, count):
        ax, ay, bx, by = rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3]
        at = k
        while at > first and (ax, ay, bx, by) < (
            rows[at - 1, 0],
            rows[at - 1, 1],
            rows[at - 1, 2],
            rows[at - 1, 3],
        ):
            rows[at] = rows[at - 1]
            at -= 1
        rows[at, 0], rows[at, 1], rows[at, 2], rows[at, 3] = ax, ay, bx, by
    kept = first
    for k in range(first, count):
        lies_on = False
        for other in range(first, count):
            if other == k:
                continue
            ex, ey = rows[other, 2] - rows[other, 0], rows[other, 3] - rows[other, 1]
            length = ex * ex + ey * ey
            inside = True
            for end in range(0, 3, 2):
                vx, vy = rows[k, end] - rows[other, 0], rows[k, end + 1] - rows[other, 1]
                t = min(max((vx * ex + vy * ey) / length, 0.0), 1.0) if length > 0.0 else 0.0
                inside &= abs(vx - t * ex) + abs(vy - t * ey) < TOUCH
            if inside:
                # of two that lie on each other the first stays
                fx, fy = rows[k, 2] - rows[k, 0], rows[k, 3] - rows[k, 1]
                if fx * fx + fy * fy < length - TOUCH or other < k:
                    lies_on = True
                    break
        if not lies_on:
            rows[kept] = rows[k]
            kept += 1
    return kept


@allocating_kernel
def find_blockers(
    table, start, triangle, base, cell_column, height, gradient, link, resolution, ny, step, headroom
):
    """The lists of all cells: those of cell c are ``blocker[blocker_start[c]:blocker_start[c + 1]]``.

    The arrays are those of `navmesh.raster`, `navmesh.floors` and `navmesh.walls`. Returns blocker_start (n
    + 1,) int32 and blocker (k, 4) float64 [m]: x, y of both ends of a segment, relative to the grid's corner.
    """
    cells = cell_column.shape[0]
    blocker_start = np.zeros(cells + 1, np.int32)
    rows = np.empty((4 * int(math.sqrt(cells)) + 64, 4))
    count = 0
    polygon = np.empty((8, 3))
    spare = np.empty((8, 3))
    edge = np.empty(4)
    shared = np.zeros((table.shape[0], 3), np.uint8)
    ends = np.zeros(9, np.bool_)  # by direction: whether the floor may end in that square; [-1]: in its own
    half = 0.5 * resolution
    for c in range(cells):
        blocker_start[c] = count
        cut = False  # whether walking ends on the way to a neighbour
        beside = base[c] < np.inf
        for d in range(4):
            n = link[c, d]
            cut |= n < 0
            beside |= n < 0 or base[n] < np.inf
        if not beside:
            # a square at a corner may hold the end of a wall that no square to the sides knows
            for d in range(4):
                m = link[link[c, d], (d + 1) % 4]
                cut |= m < 0
                beside |= m < 0 or base[m] < np.inf
            if not beside:
                continue
        first = count
        column = cell_column[c]
        ix = column // ny
        x = (ix + 0.5) * resolution
        y = (column - ix * ny + 0.5) * resolution
        for d in range(-1, 8):
            ends[d] = False
            dx = (1 if d == 0 else 0) - (1 if d == 2 else 0)
            dy = (1 if d == 1 else 0) - (1 if d == 3 else 0)
            n = c if d < 0 else link[c, d % 4]
            if d >= 4:
                m = link[c, (d + 1) % 4]
                dx, dy = _CORNERS[d - 4]
                known = n >= 0 or m >= 0  # a cell beside has that square to its side
                n = link[n, (d + 1) % 4] if n >= 0 else (link[m, d % 4] if m >= 0 else -1)
                if n < 0 and known:
                    continue
            there = column + dx * ny + dy
            if start[there] == start[there + 1]:
                continue
            rx, ry = x + dx * resolution, y + dy * resolution
            ends[d] = cut and (n < 0 or d < 0)
            if n >= 0 and base[n] == np.inf:
                continue
            if n >= 0:
                px, py, z, p, q = rx, ry, height[n], gradient[n, 0], gradient[n, 1]
                lowest = base[n]
            else:
                px, py, z, p, q = x, y, height[c], gradient[c, 0], gradient[c, 1]
                rise = (p * dx + q * dy) * half
                lowest = rise + wall_base(table, start, triangle, there, rx, ry, z + rise, resolution, step)
            slope = (abs(p) + abs(q)) * resolution * 1.5
            for k in range(start[there], start[there + 1]):
                f = triangle[k]
                low, high = range_in_column(table, f, rx, ry, half)
                if high <= z + lowest - slope or low >= z + headroom + slope:
                    continue
                corners = clip_band(table, f, px, py, z, p, q, lowest, headroom, polygon, spare)
                if corners == 0:
                    continue
                rows, count = _add_polygon(
                    rows, count, polygon, corners, table[f, 14] == UPRIGHT, rx, ry, half + TOUCH
                )
                if d < 0 and table[f, 14] != UPRIGHT:
                    vx, vy = nearest_on_polygon(polygon, corners, x, y)
                    if vx == 0.0 and vy == 0.0:
                        rows = _append(rows, count, x, y, x, y)
                        count += 1
        walls_end = count
        for d in range(-1, 8 if cut else -1):
            if not ends[d]:
                continue
            dx = (1 if d == 0 else 0) - (1 if d == 2 else 0)
            dy = (1 if d == 1 else 0) - (1 if d == 3 else 0)
            if d >= 4:
                dx, dy = _CORNERS[d - 4]
            rows, count = _add_floor_ends(
                rows, first, walls_end, count, table, start, triangle, shared, resolution, ny,
                column + dx * ny + dy,
                x + dx * resolution, y + dy * resolution,
                x, y, height[c], gradient[c, 0], gradient[c, 1], step, headroom,
            )  # fmt: skip
        for d in range(4):
            if link[c, d] >= 0:
                continue
            dx = (1.0 if d == 0 else 0.0) - (1.0 if d == 2 else 0.0)
            dy = (1.0 if d == 1 else 0.0) - (1.0 if d == 3 else 0.0)
            if _is_near(rows, first, count, x, y, x + dx * resolution, y + dy * resolution):
                continue
            # something that is no edge of the floor ends it: a low obstacle without floor on top
            t = floor_end(
                table, start, triangle, resolution, ny, x, y, d,
                height[c], gradient[c, 0], gradient[c, 1], step, headroom, edge,
            )  # fmt: skip
            rows = _append(rows, count, x + t * dx, y + t * dy, x + t * dx, y + t * dy)
            count += 1
        count = _sort_and_thin(rows, first, count)
    blocker_start[cells] = count
    return blocker_start, rows[:count].copy()


@allocating_kernel
def nearest_blockers(blocker_start, blocker, cell_column, resolution, ny):
    """The vector from each cell's centre to the nearest place in its own list: (n, 2) float64, inf without
    one."""
    cells = cell_column.shape[0]
    nearest = np.full((cells, 2), np.inf)
    for c in range(cells):
        if blocker_start[c] == blocker_start[c + 1]:
            continue
        column = cell_column[c]
        ix = column // ny
        x = (ix + 0.5) * resolution
        y = (column - ix * ny + 0.5) * resolution
        best = np.inf
        for k in range(blocker_start[c], blocker_start[c + 1]):
            ax, ay = blocker[k, 0] - x, blocker[k, 1] - y
            ex, ey = blocker[k, 2] - blocker[k, 0], blocker[k, 3] - blocker[k, 1]
            length = ex * ex + ey * ey
            t = min(max(-(ax * ex + ay * ey) / length, 0.0), 1.0) if length > 0.0 else 0.0
            vx, vy = ax + t * ex, ay + t * ey
            if vx * vx + vy * vy < best:
                best = vx * vx + vy * vy
                nearest[c, 0] = vx
                nearest[c, 1] = vy
    return nearest
