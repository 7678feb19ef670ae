"""Where walking ends near a cell, as line segments seen from above: the footprints of walls and the ends of
the floor, exact, from the triangles themselves.

Each cell beside such a place has a list of those in its own square and in the squares beside it that it is
not linked to. Together the lists hold all of them; `navmesh.surface.clearance` carries to every other cell
whose list is nearest.
"""

import math

import numpy as np

from navmesh.level.raster import KIND, TOUCH, UPRIGHT, middle_of
from navmesh.surface.floor_ends import EDGE, MIDDLE, find_floor_ends
from navmesh.surface.ledges import floor_end
from navmesh.surface.segments import comes_near, keep, lies_on, part_in_square, put, sort_and_thin, twice
from navmesh.surface.walls import clip_band, nearest_on_polygon, range_in_column, wall_base
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["find_blockers", "nearest_blockers", "nearest_in_list"]

_OUTLINE = 9
"""Most segments that a triangle leaves in a square: the corners of a triangle cut off four times, and the
centre of the square that it covers."""


@kernel(error_model="numpy", forceinline=True)
def _square(link, c, d):
    """What is in the square beside cell ``c`` in direction d, 4 to 7 being the corners, and -1 its own.

    Returns (dx, dy, the linked cell there or -1, whether a cell beside c has that square to its side).
    """
    dx = (1 if d == 0 else 0) - (1 if d == 2 else 0)
    dy = (1 if d == 1 else 0) - (1 if d == 3 else 0)
    if d < 0:
        return dx, dy, c, False
    n = link[c, d % 4]
    if d < 4:
        return dx, dy, n, False
    dx = 1 if d == 4 or d == 7 else -1
    dy = 1 if d < 6 else -1
    m = link[c, (d + 1) % 4]
    corner = link[n, (d + 1) % 4] if n >= 0 else (link[m, d % 4] if m >= 0 else -1)
    return dx, dy, corner, n >= 0 or m >= 0


@kernel(error_model="numpy")
def _outline(table, f, x, y, z, p, q, low, high, rx, ry, half, polygon, spare, rows, count):
    """Put what of a triangle's part between ``low`` and ``high`` above a plane is in the square about (rx,
    ry), seen from above, behind the first ``count`` rows: (their number, corners of the part)."""
    corners = clip_band(table, f, x, y, z, p, q, low, high, polygon, spare)
    if corners == 0:
        return count, 0
    flat = table[f, KIND] == UPRIGHT
    least = most = 0
    if flat:  # all on one line: from its one end to the other
        for k in range(1, corners):
            if (polygon[k, 0], polygon[k, 1]) < (polygon[least, 0], polygon[least, 1]):
                least = k
            if (polygon[k, 0], polygon[k, 1]) > (polygon[most, 0], polygon[most, 1]):
                most = k
    for k in range(1 if flat else corners):
        i, j = (least, most) if flat else (k, k + 1 if k + 1 < corners else 0)
        ax, ay, bx, by = polygon[i, 0], polygon[i, 1], polygon[j, 0], polygon[j, 1]
        if (bx, by) < (ax, ay):
            ax, ay, bx, by = bx, by, ax, ay
        first, last = part_in_square(ax, ay, bx, by, rx, ry, half)
        if first <= last:
            ex, ey = bx - ax, by - ay
            count = put(rows, count, ax + first * ex, ay + first * ey, ax + last * ex, ay + last * ey)
    return count, corners


@kernel(error_model="numpy")
def _walls_in_square(
    table, start, triangle, there, rx, ry, x, y, z, p, q, low, headroom, side,
    polygon, spare, rows, count,
):  # fmt: skip
    """Put the outlines of what rises more than ``low`` above the plane of height z at (x, y) and of gradient
    (p, q) behind the first ``count`` rows, as far as they are in the square of column ``there`` about (rx,
    ry)."""
    half = 0.5 * side
    slope = (abs(p) + abs(q)) * side * 1.5
    for k in range(start[there], start[there + 1]):
        f = triangle[k]
        bottom, top = range_in_column(table, f, rx, ry, half)
        if top <= z + low - slope or bottom >= z + headroom + slope:
            continue
        count, corners = _outline(
            table, f, x, y, z, p, q, low, headroom, rx, ry, half + TOUCH, polygon, spare, rows, count
        )
        if corners > 0 and rx == x and ry == y and table[f, KIND] != UPRIGHT:
            vx, vy = nearest_on_polygon(polygon, corners, x, y)
            if vx == 0.0 and vy == 0.0:
                count = put(rows, count, x, y, x, y)
    return count


@kernel(error_model="numpy")
def _own_walls(
    table, start, triangle, base, cell_column, height, gradient, patch, headroom,
    polygon, spare, own, own_start, rows, c,
):  # fmt: skip
    """Fill in the walls in the cells' own squares from cell ``c`` on, as far as there are rows; returns the
    first cell that is left."""
    while c < cell_column.shape[0]:
        end = own_start[c]
        if base[c] < np.inf:
            column = cell_column[c]
            x, y = middle_of(patch, column)
            count = _walls_in_square(
                table, start, triangle, column, x, y, x, y, height[c], gradient[c, 0], gradient[c, 1],
                base[c], headroom, patch.side, polygon, spare, own, 0,
            )  # fmt: skip
            count = sort_and_thin(own, count)
            end = keep(rows, end, own, count)
            if end < 0:
                return c
        c += 1
        own_start[c] = end
    return c


@kernel(error_model="numpy")
def _find_beside(link, base, beside):
    """Say which cells are ``beside`` something (1), and which of them are not linked to all sides (2).
    Returns how many there are of both, and of the latter."""
    for c in range(link.shape[0]):  # what may be: at most two links from what is not as on an open floor
        if base[c] < np.inf or min(link[c, 0], link[c, 1], link[c, 2], link[c, 3]) < 0:
            beside[c] = 1
            for d in range(4):
                n = link[c, d]
                if n >= 0:
                    beside[n] = 1
                    corner = link[n, (d + 3) % 4]
                    if corner >= 0:
                        beside[corner] = 1
    count = cut_off = 0
    for c in range(link.shape[0]):
        if beside[c] == 0:
            continue
        cut = False  # whether walking ends on the way to a neighbour
        near = base[c] < np.inf
        for d in range(4):
            n = link[c, d]
            cut |= n < 0
            near |= n < 0 or base[n] < np.inf
        if not near:
            # a square at a corner may hold the end of a wall that no square to the sides knows
            for d in range(4):
                m = link[link[c, d], (d + 1) % 4]
                near |= m < 0 or base[m] < np.inf
                cut |= m < 0
        beside[c] = 2 if near and cut else int(near)
        count += int(near)
        cut_off += int(near and cut)
    return count, cut_off


@kernel(error_model="numpy")
def _heights_to_ask(link, cell_column, height, gradient, start, patch, step, beside, cells, row, asked):
    """Say between which heights the floor in a column matters to those of the ``cells`` that are not linked
    to all sides: ``asked`` (rows, 2), in the ``row`` of each column, which is -1 where it does not matter."""
    rows = 0
    for i in range(cells.shape[0]):
        c = cells[i]
        if beside[c] != 2:
            continue
        p, q = gradient[c, 0], gradient[c, 1]
        reach = step + patch.side * (abs(p) + abs(q)) + TOUCH
        for d in range(-1, 8):
            dx, dy, n, known = _square(link, c, d)
            there = cell_column[c] + dx * patch.ny + dy
            if (d < 0 or (n < 0 and not known)) and start[there] < start[there + 1]:
                level = height[c] + patch.side * (p * dx + q * dy)
                at = row[there]
                if at < 0:
                    row[there], asked[rows, 0], asked[rows, 1] = rows, level - reach, level + reach
                    rows += 1
                else:
                    asked[at, 0] = min(asked[at, 0], level - reach)
                    asked[at, 1] = max(asked[at, 1], level + reach)


@kernel(error_model="numpy")
def _blockers_from(
    table, start, triangle, base, cell_column, height, gradient, link, patch, step, headroom,
    beside, cells, own_start, own_walls, end_start, floor_ends, polygon, spare, edge, near,
    list_start, rows, i,
):  # fmt: skip
    """Fill in the lists of ``cells`` from the i-th on, as far as there are rows; returns the first that is
    left."""
    half = 0.5 * patch.side
    while i < cells.shape[0]:
        c, count = cells[i], 0
        column = cell_column[c]
        x, y = middle_of(patch, column)
        z, p, q = height[c], gradient[c, 0], gradient[c, 1]
        for d in range(-1, 8):
            dx, dy, n, known = _square(link, c, d)
            there = column + dx * patch.ny + dy
            if n >= 0:
                for k in range(own_start[n], own_start[n + 1]):
                    count = put(
                        near, count,
                        own_walls[k, 0], own_walls[k, 1], own_walls[k, 2], own_walls[k, 3],
                    )  # fmt: skip
            elif not known and start[there] < start[there + 1]:
                rx, ry = x + dx * patch.side, y + dy * patch.side
                rise = (p * dx + q * dy) * half
                low = rise + wall_base(table, start, triangle, there, rx, ry, z + rise, patch.side, step)
                count = _walls_in_square(
                    table, start, triangle, there, rx, ry, x, y, z, p, q, low, headroom, patch.side,
                    polygon, spare, near, count,
                )  # fmt: skip
        walls = count
        for d in range(-1, 8 if beside[c] == 2 else -1):
            dx, dy, n, known = _square(link, c, d)
            if d >= 0 and (n >= 0 or known):
                continue
            there = column + dx * patch.ny + dy
            for k in range(end_start[there], end_start[there + 1]):
                end = floor_ends[k]
                ax, ay, bx, by = end[EDGE], end[EDGE + 1], end[EDGE + 2], end[EDGE + 3]
                level = z + p * (0.5 * (ax + bx) - x) + q * (0.5 * (ay + by) - y)
                if abs(end[MIDDLE] - level) > step + half * (abs(p) + abs(q)) + TOUCH:
                    continue
                if not lies_on(near, walls, ax, ay, bx, by):
                    count = put(near, count, end[0], end[1], end[2], end[3])
        for d in range(4):
            if link[c, d] >= 0:
                continue
            dx = (1 if d == 0 else 0) - (1 if d == 2 else 0)
            dy = (1 if d == 1 else 0) - (1 if d == 3 else 0)
            if comes_near(near, count, x, y, x + dx * patch.side, y + dy * patch.side):
                continue
            # something that is no edge of the floor ends it: a low obstacle without floor on top
            t = floor_end(
                table, start, triangle, patch, x, y, d, z, p, q, step, headroom, edge
            )  # fmt: skip
            count = put(near, count, x + t * dx, y + t * dy, x + t * dx, y + t * dy)
        count = sort_and_thin(near, count)
        end = keep(rows, list_start[i], near, count)
        if end < 0:
            return i
        i += 1
        list_start[i] = end
    return i


@kernel
def _put_marked(mark, marked):
    """Put the numbers of those that have a ``mark`` into ``marked``."""
    count = 0
    for c in range(mark.shape[0]):
        if mark[c] != 0:
            marked[count] = c
            count += 1


@kernel
def _leave_out_empty(list_cell, list_start):
    """Leave out empty lists, in place; returns how many lists there are then."""
    lists = 0
    for i in range(list_cell.shape[0]):
        if list_start[i + 1] > list_start[lists]:
            list_cell[lists], list_start[lists + 1] = list_cell[i], list_start[i + 1]
            lists += 1
    return lists


@allocating_kernel(error_model="numpy", nogil=True)
def find_blockers(table, start, triangle, base, cell_column, height, gradient, link, patch, step, headroom):
    """The lists of all cells that have one: list i, ``blocker[list_start[i]:list_start[i + 1]]``, is that of
    cell ``list_cell[i]``.

    The arrays are those of `navmesh.level.raster`, `navmesh.surface.floors` and `navmesh.surface.walls`.
    Returns list_cell (l,) int32, rising, list_start (l + 1,) int32 and blocker (k, 4) float64 [m]: x, y of
    both ends of a segment, relative to the grid's corner.
    """
    cells = cell_column.shape[0]
    most = 0  # triangles in a column
    for column in range(start.shape[0] - 1):
        most = max(most, start[column + 1] - start[column])
    polygon, spare, edge = np.empty((8, 3)), np.empty((8, 3)), np.empty(4)
    room = 4 * int(math.sqrt(cells)) + 64

    own_start, own_walls = np.zeros(cells + 1, np.int32), np.empty((room, 4))
    own = np.empty((_OUTLINE * most, 4))
    c = 0
    while True:
        c = _own_walls(
            table, start, triangle, base, cell_column, height, gradient, patch, headroom,
            polygon, spare, own, own_start, own_walls, c,
        )  # fmt: skip
        if c == cells:
            break
        own_walls = twice(own_walls)

    beside, row = np.zeros(cells, np.uint8), np.full(start.shape[0] - 1, -1, np.int32)
    count, cut_off = _find_beside(link, base, beside)
    list_cell, asked = np.empty(count, np.int32), np.empty((9 * cut_off, 2))
    _put_marked(beside, list_cell)
    _heights_to_ask(
        link, cell_column, height, gradient, start, patch, step, beside, list_cell, row, asked
    )  # fmt: skip
    end_start, floor_ends = find_floor_ends(table, start, triangle, row, asked, patch, step, headroom)
    ends = 0
    for column in range(start.shape[0] - 1):
        ends = max(ends, end_start[column + 1] - end_start[column])

    list_start, blocker = np.zeros(count + 1, np.int32), np.empty((room, 4))
    near = np.empty((9 * (_OUTLINE * most + ends) + 4, 4))
    i = 0
    while True:
        i = _blockers_from(
            table, start, triangle, base, cell_column, height, gradient, link, patch, step, headroom,
            beside, list_cell, own_start, own_walls, end_start, floor_ends, polygon, spare, edge, near,
            list_start, blocker, i,
        )  # fmt: skip
        if i == count:
            break
        blocker = twice(blocker)
    lists = _leave_out_empty(list_cell, list_start)
    return list_cell[:lists].copy(), list_start[: lists + 1].copy(), blocker[: list_start[lists]].copy()


@kernel(error_model="numpy")
def nearest_in_list(blocker, first, last, x, y):
    """The vector (dx, dy) from (x, y) to the nearest place on the segments ``blocker[first:last]``."""
    best, dx, dy = np.inf, np.inf, np.inf
    for k in range(first, last):
        ax, ay = blocker[k, 0] - x, blocker[k, 1] - y
        ex, ey = blocker[k, 2] - blocker[k, 0], blocker[k, 3] - blocker[k, 1]
        length = ex * ex + ey * ey
        t = min(max(-(ax * ex + ay * ey) / length, 0.0), 1.0) if length > 0.0 else 0.0
        vx, vy = ax + t * ex, ay + t * ey
        if vx * vx + vy * vy < best:
            best, dx, dy = vx * vx + vy * vy, vx, vy
    return dx, dy


@allocating_kernel(error_model="numpy")
def nearest_blockers(list_cell, list_start, blocker, cell_column, patch):
    """The vector from each cell's centre to the nearest place in its own list: (n, 2) float64, inf without
    one."""
    nearest = np.full((cell_column.shape[0], 2), np.inf)
    for i in range(list_cell.shape[0]):
        c = list_cell[i]
        x, y = middle_of(patch, cell_column[c])
        nearest[c] = nearest_in_list(blocker, list_start[i], list_start[i + 1], x, y)
    return nearest
