"""The nearest places where walking ends, recalled: they are not kept for every cell.

For each cell a byte says where it took its place from in each of the four turns in which clearances were
carried (`navmesh.surface.clearance`). Followed back to a list of blockers, and added up again hop by hop,
they give the vectors bit for bit.
"""

import numpy as np

from navmesh.surface.blockers import nearest_in_list
from navmesh.surface.clearance import AHEAD, BACK, BACK_AHEAD, BACK_BEHIND, BEHIND, BEHIND_BACK, OWN
from navmesh.surface.clearance_field import gap_in, middle_of_column
from navmesh.surface.columns import column_of
from navmesh.surface.storeys import linked, over
from surefoot.kernels import kernel

__all__ = ["came_from", "nearest_in", "nearest_of", "nearly_nearest_in", "nearly_nearest_of", "recall"]

_LAST = 3
"""The last of the four turns."""


@kernel(error_model="numpy")
def came_from(net, c, column, turn):
    """Where cell ``c`` of ``column`` took from what it knew after ``turn``: (cell, the turn after which that
    knew it, hop in x, hop in y), hops in cells; cell -1 where it is from its own list, -2 where no link leads
    there."""
    while True:
        back, side, other = (2, 3, 1) if turn < 2 else (0, 1, 3)
        forth = 1 if turn < 2 else -1
        bits = net.choice[c] >> (4 * (turn >> 1))
        if turn & 1 == 1:
            if bits & AHEAD:
                return _over(net, c, column, other), turn, 0, forth
        else:
            way = bits & 7
            if way == BEHIND:
                return _over(net, c, column, side), turn, 0, -forth
            if way == BACK:
                return _over(net, c, column, back), turn + 1, -forth, 0
            if way == BACK_AHEAD or way == BACK_BEHIND:
                n, along = _over(net, c, column, back), other if way == BACK_AHEAD else side
                step = forth if way == BACK_AHEAD else -forth
                return _over(net, n, column - forth * net.ny, along), turn + 1, -forth, step
            if way == BEHIND_BACK:
                n = _over(net, c, column, side)
                return _over(net, n, column - forth, back), turn + 1, -forth, -forth
        if turn == 0:
            return np.int64(-1), 0, 0, 0
        turn -= 1


@kernel(error_model="numpy", forceinline=True)
def _over(net, c, column, way):
    """The cell that a link leads to; -2 where there is none."""
    other = over(net, c, column, way) if c >= 0 else np.int64(-2)
    return other if other >= 0 else np.int64(-2)


@kernel(error_model="numpy")
def recall(field, column_start, nx, nearest):
    """Fill in ``nearest`` (n, 2) float64 [m] of all cells of a `NET` of ``nx`` strips of columns. The turns
    are gone through again in their order, so each cell finds what it took."""
    choice, cells = field.choice, field.choice.shape[0]
    nearest[:] = np.inf
    for i in range(field.list_cell.shape[0]):
        c = field.list_cell[i]
        nearest[c, 0], nearest[c, 1] = _place_in(field, i, column_of(field, c))
    h = field.cell
    for turn in range(0, 4, 2):
        back, side, other = (2, 3, 1) if turn == 0 else (0, 1, 3)
        forth = h if turn == 0 else -h
        for s in range(nx):
            ix = s if turn == 0 else nx - 1 - s
            first, last = column_start[ix * field.ny], column_start[(ix + 1) * field.ny]
            for i in range(first, last):
                c = i if turn == 0 else first + last - 1 - i
                way = (choice[c] >> (2 * turn)) & 7
                if way == OWN:
                    continue
                first_step = side if way == BEHIND or way == BEHIND_BACK else back
                n, x, y = linked(field, c, first_step), -forth, 0.0
                if way == BEHIND:
                    x, y = 0.0, -forth
                elif way == BACK_AHEAD:
                    n, y = linked(field, n, other), forth
                elif way == BACK_BEHIND:
                    n, y = linked(field, n, side), -forth
                elif way == BEHIND_BACK:
                    n, y = linked(field, n, back), -forth
                _take(nearest, c, n, x, y)
            for i in range(first, last):
                c = first + last - 1 - i if turn == 0 else i
                if (choice[c] >> (2 * turn)) & AHEAD:
                    _take(nearest, c, linked(field, c, other), 0.0, forth)
    for c in range(cells):
        nearest[c, 0], nearest[c, 1] = _settled(field, c, column_of(field, c), nearest[c, 0], nearest[c, 1])


@kernel(error_model="numpy", forceinline=True)
def _take(nearest, c, n, dx, dy):
    """Put in what cell ``c`` took from cell ``n``."""
    nearest[c, 0] = nearest[n, 0] + dx if dx != 0.0 else nearest[n, 0]
    nearest[c, 1] = nearest[n, 1] + dy if dy != 0.0 else nearest[n, 1]


@kernel(error_model="numpy", forceinline=True)
def _place_in(net, own, column):
    """The vector to the nearest place in list ``own`` from the centre of the cell that it is of, in
    ``column``; inf for list -1."""
    if own < 0:
        return np.inf, np.inf
    x, y = middle_of_column(net, column)
    return nearest_in_list(net.blocker, net.list_start[own], net.list_start[own + 1], x, y)


@kernel(error_model="numpy", forceinline=True)
def _after(x, y, dx, dy, h):
    if dx != 0:
        x += dx * h
    if dy != 0:
        y += dy * h
    return x, y


@kernel(error_model="numpy")
def _known(net, c, column):
    """What cell ``c`` of ``column`` knew after the last turn."""
    choice = net.choice
    at, then, count, beside = c, _LAST, 0, column
    east, west, north, south = 0, 0, 0, 0
    while choice[at] != 0:
        other, then, dx, dy = came_from(net, at, beside, then)
        if other < 0:
            break
        beside += dx * net.ny + dy
        east, west = east + (dx > 0), west + (dx < 0)
        north, south = north + (dy > 0), south + (dy < 0)
        at = other
        count += 1
    x, y = _place_in(net, net.source[c], beside)
    if east * west == 0 and north * south == 0:  # one by one, as they were added
        for _ in range(east + west):
            x += net.cell if east else -net.cell
        for _ in range(north + south):
            y += net.cell if north else -net.cell
        return x, y
    for hop in range(count - 1, -1, -1):  # there and back: each after those nearer to the place
        at, then, dx, dy, beside = c, _LAST, 0, 0, column
        for _ in range(hop + 1):
            at, then, dx, dy = came_from(net, at, beside, then)
            beside += dx * net.ny + dy
        x, y = _after(x, y, dx, dy, net.cell)
    return x, y


@kernel(error_model="numpy")
def _settled(field, c, column, x, y):
    """What `navmesh.surface.clearance.settle_clearance` makes of the vector (x, y) carried to cell ``c`` of
    ``column``: it stays, or something nearer was found when the clearance was measured."""
    if np.sqrt(x * x + y * y) == field.clearance[c]:
        return x, y
    cx, cy = middle_of_column(field, column)
    _, qx, qy = gap_in(field, c, column, cx, cy)
    return qx - cx, qy - cy


@kernel(error_model="numpy")
def nearest_in(net, c, column):
    """The vector [m] from the centre of cell ``c`` of ``column`` to the nearest place where walking ends."""
    if net.nearest.shape[0] > 0:
        return net.nearest[c, 0], net.nearest[c, 1]
    x, y = _known(net, np.int64(c), column)
    return _settled(net, c, column, x, y)


@kernel(error_model="numpy")
def nearest_of(net, c):
    """`nearest_in` of a cell whose column is yet to be looked up."""
    if net.nearest.shape[0] > 0:
        return net.nearest[c, 0], net.nearest[c, 1]
    return nearest_in(net, c, column_of(net, c))


@kernel(error_model="numpy")
def nearly_nearest_in(net, c, column):
    """`nearest_in`, but for rounding: without going the way that the place was carried."""
    if net.nearest.shape[0] > 0 or net.clearance[c] < 2.0 * net.cell:
        return nearest_in(net, c, column)
    source = np.int64(net.source[c])
    if source < 0:
        return np.inf, np.inf
    beside = column_of(net, net.list_cell[source])
    x, y = _place_in(net, source, beside)
    cx, cy = middle_of_column(net, column)
    px, py = middle_of_column(net, beside)
    return x + (px - cx), y + (py - cy)


@kernel(error_model="numpy")
def nearly_nearest_of(net, c):
    """`nearly_nearest_in` of a cell whose column is yet to be looked up."""
    return nearly_nearest_in(net, c, column_of(net, c))
