"""Solids: closed parts of a mesh, and whether a point is inside of one.

A part is what hangs together over edges; vertices closer than `navmesh.level.welding.WELD` are one. It is
closed where every edge is passed as often in one direction as in the other, so that each point off its faces
has a winding number [1]: how many times more often the part's faces are left than entered on any way from the
point to infinity. Inside of a solid it is above 0. Faces turned inwards, as those of a room, make it
negative: such a part takes away from the solids that its ceiling is inside of, and from no others.

[1] A. Jacobson, L. Kavan, O. Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding
numbers", ACM Transactions on Graphics 32(4), 2013.
"""

import numpy as np

from navmesh.disjoint_sets import root
from navmesh.level.raster import (
    AX,
    AY,
    AZ,
    BX,
    BY,
    BZ,
    CX,
    CY,
    CZ,
    HIGHEST,
    KIND,
    LOWEST,
    PART,
    SAME_SURFACE,
    UPRIGHT,
    height_at,
)
from navmesh.level.welding import weld
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["closed_parts", "inside_solid"]


def closed_parts(vertices: np.ndarray, faces: np.ndarray, first: np.ndarray) -> np.ndarray:
    """For each face of ``faces`` (f, 3) int32 the first face of the closed part that it belongs to, or -1.

    ``vertices`` (v, 3) float64 [m]. Parts do not reach across chunks: those begin at the faces ``first``
    (c,) int64, rising, the first at 0. Where a part is closed but for faces that it has more than once, all
    but the first of those are left out: they get -1. Returns (f,) int32.
    """
    place, _ = weld(vertices)
    first = np.append(first, len(faces))
    return _closed_parts(place, faces, first, _repeated(place, faces, first))


@kernel(error_model="numpy")
def _slot_of(a, b, size):
    """Where to look first for two numbers in a table whose ``size`` is a power of two."""
    mixed = (a * 0x2545F4914F6CDD1D) ^ (b * 0x1B873593CC9E2D51)
    return (mixed ^ (mixed >> 29)) & (size - 1)


@allocating_kernel(error_model="numpy")
def _repeated(place, faces, first):
    """(f,) bool: whether an earlier face of the chunk has the same corners in the same direction."""
    count = faces.shape[0]
    size = 16
    while size < 2 * count:
        size *= 2
    slot = np.full(size, -1, np.int32)
    corner = np.empty((count, 3), np.int64)  # the lowest first
    repeated = np.zeros(count, np.bool_)
    for chunk in range(first.shape[0] - 1):
        for f in range(first[chunk], first[chunk + 1]):
            a, b, c = place[faces[f, 0]], place[faces[f, 1]], place[faces[f, 2]]
            while a > b or a > c:
                a, b, c = b, c, a
            corner[f, 0], corner[f, 1], corner[f, 2] = a, b, c
            at = _slot_of(a, b ^ (c << 20), size)
            while slot[at] >= 0:
                g = slot[at]
                if g >= first[chunk] and corner[g, 0] == a and corner[g, 1] == b and corner[g, 2] == c:
                    repeated[f] = True
                    break
                at = (at + 1) & (size - 1)
            if not repeated[f]:
                slot[at] = f
    return repeated


@allocating_kernel(error_model="numpy")
def _closed_parts(place, faces, first, repeated):
    """`closed_parts` of faces whose corners are at ``place`` (v,) int64; ``first`` ends with their number."""
    count = faces.shape[0]
    size = 16
    while size < 4 * count:
        size *= 2
    slot = np.full(size, -1, np.int32)  # edges by a hash of their ends
    low, high = np.empty(3 * count, np.int64), np.empty(3 * count, np.int64)
    # how much more often an edge is passed upwards than downwards; without repeated faces
    turns, once = np.zeros(3 * count, np.int32), np.zeros(3 * count, np.int32)
    face = np.empty(3 * count, np.int32)  # the first one at an edge
    parent = np.arange(count).astype(np.int32)
    edges = 0
    for chunk in range(first.shape[0] - 1):
        for f in range(first[chunk], first[chunk + 1]):
            for k in range(3):
                a, b = place[faces[f, k]], place[faces[f, k + 1 if k < 2 else 0]]
                if a == b:
                    continue
                turn = 1
                if a > b:
                    a, b, turn = b, a, -1
                at = _slot_of(a, b, size)
                e = slot[at]
                while e >= 0 and not (low[e] == a and high[e] == b and face[e] >= first[chunk]):
                    at = (at + 1) & (size - 1)
                    e = slot[at]
                if e < 0:
                    e = slot[at] = edges
                    low[e], high[e], face[e] = a, b, f
                    edges += 1
                turns[e] += turn
                once[e] += 0 if repeated[f] else turn
                one, other = root(parent, f), root(parent, face[e])
                parent[max(one, other)] = min(one, other)
    closed, closed_once = np.ones(count, np.bool_), np.ones(count, np.bool_)
    for e in range(edges):
        part_of = root(parent, face[e])
        closed[part_of] &= turns[e] == 0
        closed_once[part_of] &= once[e] == 0
    part = np.empty(count, np.int32)
    for f in range(count):
        part_of = root(parent, f)
        part[f] = part_of if closed[part_of] or (closed_once[part_of] and not repeated[f]) else -1
    return part


@kernel(error_model="numpy")
def _turn_about(table, f, x, y):
    """How often the outline of a prepared triangle, seen from above, goes round (x, y): 1 counter-clockwise,
    -1 clockwise or 0.

    Of the triangles that share an edge through the point exactly one has the point, so that what the faces of
    a closed part have together is 0.
    """
    turn = 0
    for k in range(3):
        j = 3 * k + 3 if k < 2 else 0
        ax, ay, bx, by = table[f, 3 * k], table[f, 3 * k + 1], table[f, j], table[f, j + 1]
        if (ax > x) == (bx > x):
            continue
        way = 1
        if ax < bx:  # the same numbers in the same order for both triangles at the edge
            ax, ay, bx, by, way = bx, by, ax, ay, -1
        if y < ay + (by - ay) * ((x - ax) / (bx - ax)):
            turn += way
    return turn


@kernel(error_model="numpy")
def _height(table, f, x, y):
    """The height of a prepared triangle over (x, y), also of one that is all but upright."""
    if table[f, KIND] != UPRIGHT:
        return height_at(table, f, x, y)
    ux, uy, uz = table[f, BX] - table[f, AX], table[f, BY] - table[f, AY], table[f, BZ] - table[f, AZ]
    vx, vy, vz = table[f, CX] - table[f, AX], table[f, CY] - table[f, AY], table[f, CZ] - table[f, AZ]
    area = ux * vy - uy * vx
    if area == 0.0:
        return table[f, LOWEST]
    along_x, along_y = (uy * vz - uz * vy) / area, (uz * vx - ux * vz) / area
    z = table[f, AZ] - along_x * (x - table[f, AX]) - along_y * (y - table[f, AY])
    return min(max(z, table[f, LOWEST]), table[f, HIGHEST])


@kernel(error_model="numpy")
def _left_above(crossing, count, z):
    """How much more often the parts that hold a point are left than entered above z."""
    left = 0.0
    for i in range(count):
        if crossing[i, 3] > 0.0 and crossing[i, 2] > z:
            left += crossing[i, 1]
    return left


@kernel(error_model="numpy")
def _is_hollow(crossing, count, i, z):
    """Whether what is above z within the part of crossing ``i``, whose faces are turned inwards, is hollowed
    out of a solid: whether its ceiling is inside of one."""
    ceiling = np.inf
    for j in range(count):
        if crossing[j, 0] == crossing[i, 0] and crossing[j, 1] < 0.0 and crossing[j, 2] > z:
            ceiling = min(ceiling, crossing[j, 2])
    return _left_above(crossing, count, ceiling - SAME_SURFACE) > 0.0


@kernel(error_model="numpy")
def inside_solid(table, start, triangle, column, x, y, z, crossing):
    """Whether what is just above (x, y, z), a point of the square of ``column``, is inside a solid: inside of
    more closed parts than are hollowed out of them there.

    ``table``, ``start``, ``triangle`` come from `navmesh.level.raster`. ``crossing`` (n, 4) has room for as
    many triangles as the column has. Faces at most `SAME_SURFACE` above z do not count as above.
    """
    z += SAME_SURFACE
    count = 0
    for k in range(start[column], start[column + 1]):
        f = triangle[k]
        if table[f, PART] < 0.0:
            continue
        turn = _turn_about(table, f, x, y)
        if turn != 0:
            crossing[count, 0], crossing[count, 1] = table[f, PART], turn
            crossing[count, 2] = _height(table, f, x, y)
            count += 1
    hollows = False
    for i in range(count):
        above, total = 0.0, 0.0
        for j in range(count):
            if crossing[j, 0] == crossing[i, 0]:
                total += crossing[j, 1]
                above += crossing[j, 1] if crossing[j, 2] > z else 0.0
        # the total is another than 0 where the line goes through a crack between vertices that count as one
        crossing[i, 3] = above if total == 0.0 else 0.0
        hollows |= crossing[i, 3] < 0.0
    left = _left_above(crossing, count, z)
    if left > 0.0 and hollows:
        for i in range(count):
            if crossing[i, 3] < 0.0 and crossing[i, 2] > z and _is_hollow(crossing, count, i, z):
                left += crossing[i, 1]
    return left > 0.0
