"""Contacts of a capsule or sphere with a triangle soup: the kernel that MuJoCo calls.

A capsule touches
- a face with the centre of an end cap above it, or behind it by less than the face's depth limit, unless
  the centre is in front of another side of the same sharp wedge: then it is outside;
- an edge or corner that sticks out, with the nearest point of its axis, within the cone of directions
  that the neighbouring faces leave free;
- an edge that its axis has come through, with ends before one of the two faces each, by less than the depth
  limit of the faces: a foot that comes down fast on the nose of a step.
Faces are one-sided. `locomotion.ground.collider.reference` is the slow version of the same rules.
"""

from __future__ import annotations

import math

from locomotion.ground.collider.build import DEPTH_CAP, share_corner
from locomotion.ground.collider.layout import (
    CONE,
    CONE_ROW,
    CORNER,
    DEPTH_LIMIT,
    EDGE_DEPTH_LIMIT,
    EXPOSED,
    FIRST_X,
    FIRST_Y,
    HIGH_X,
    HIGH_Y,
    HIGH_Z,
    LOW_X,
    LOW_Y,
    LOW_Z,
    NX,
    NY,
    NZ,
    OFFSET,
    PER_METRE,
    SIDE,
    SIDE_ROW,
    SIDES_END,
    SOUTH,
    VERTEX,
    WEST,
)
from surefoot.kernels import kernel

__all__ = ["MAX_CONTACTS", "capsule_contacts"]

#: most contacts between one capsule and the ground.
MAX_CONTACTS = 8
#: candidates kept before the reduction; the kernel's output has as many rows.
MAX_CANDIDATES = 32
#: Columns of a candidate: distance [m, negative: depth]; position (3) [m] halfway between the two surfaces;
#: unit normal (3) away from the ground; place on the axis [m]; height [m] of the axis over a face; 1 for a
#: face, or 0.
DISTANCE, POSITION, NORMAL, AT, HEIGHT, IS_FACE = 0, 1, 4, 7, 8, 9
CANDIDATE = 10
#: where MuJoCo reads the first tangent (3) of a contact, from the same row.
TANGENT = 7
#: [m] a face reaches this far beyond its sides, so that nothing falls between two of them.
SIDE_TOLERANCE = 5e-4
#: [m] a side of a wedge lies across a way this far beyond its own sides, too.
BESIDE = 2.0 * SIDE_TOLERANCE
#: [m] two contacts belong to the same point of the axis, or to the same plane, within this.
SAME = 1e-3
#: cosine of the angle below which two contacts at the same point of the axis are one.
PARALLEL = 0.9995


@kernel(inline="never")
def _add(out, count, dist, qx, qy, qz, radius, nx, ny, nz, at, height, is_face):
    """Append a candidate; one that repeats another keeps the deeper of the two."""
    for i in range(count):
        if (
            abs(out[i, AT] - at) < SAME
            and out[i, NORMAL] * nx + out[i, NORMAL + 1] * ny + out[i, NORMAL + 2] * nz > PARALLEL
        ):
            if dist >= out[i, DISTANCE]:
                return count
            count -= 1
            for j in range(CANDIDATE):
                out[i, j] = out[count, j]
            break
    if count >= MAX_CANDIDATES:
        return count
    reach = radius + 0.5 * dist
    out[count, DISTANCE] = dist
    out[count, POSITION] = qx - reach * nx
    out[count, POSITION + 1] = qy - reach * ny
    out[count, POSITION + 2] = qz - reach * nz
    out[count, NORMAL], out[count, NORMAL + 1], out[count, NORMAL + 2] = nx, ny, nz
    out[count, AT] = at
    out[count, HEIGHT] = height
    out[count, IS_FACE] = is_face
    return count + 1


@kernel(inline="never")
def _outside(rows, flags, cell_start, cell_triangles, grid, shape, t, x, y, z, height):
    """Whether (x, y, z), -``height`` behind face ``t``, is in front of another side of the same wedge: a face
    that shares a corner with ``t`` lies across the way straight out. (Depth limits tell it of other faces.)
    """
    row = rows[t]
    sx, sy, sz = x - height * row[NX], y - height * row[NY], z - height * row[NZ]
    x0, x1 = (
        int((min(x, sx) - grid[WEST]) * grid[PER_METRE]),
        int((max(x, sx) - grid[WEST]) * grid[PER_METRE]),
    )
    y0, y1 = (
        int((min(y, sy) - grid[SOUTH]) * grid[PER_METRE]),
        int((max(y, sy) - grid[SOUTH]) * grid[PER_METRE]),
    )
    for ix in range(max(x0, 0), min(x1, shape[0] - 1) + 1):
        for iy in range(max(y0, 0), min(y1, shape[1] - 1) + 1):
            cell = ix * shape[1] + iy
            for i in range(cell_start[cell], cell_start[cell + 1]):
                s = cell_triangles[i]
                side = rows[s]
                before = side[NX] * x + side[NY] * y + side[NZ] * z - side[OFFSET]
                behind = side[NX] * sx + side[NY] * sy + side[NZ] * sz - side[OFFSET]
                if before <= SIDE_TOLERANCE or behind >= SIDE_TOLERANCE or not share_corner(flags, s, t):
                    continue
                share = before / (before - behind)
                px, py, pz = x + share * (sx - x), y + share * (sy - y), z + share * (sz - z)
                across = True
                for k in range(SIDE, SIDES_END, SIDE_ROW):
                    if side[k] * px + side[k + 1] * py + side[k + 2] * pz - side[k + 3] > BESIDE:
                        across = False
                        break
                if across:
                    return True
    return False


@kernel
def _face(rows, flags, cell_start, cell_triangles, grid, shape, t, x, y, z, radius, margin, at, out, count):
    """Candidate between face ``t`` and one end of the axis."""
    row = rows[t]
    height = row[NX] * x + row[NY] * y + row[NZ] * z - row[OFFSET]
    if height - radius >= margin or height < -row[DEPTH_LIMIT]:
        return count
    for k in range(SIDE, SIDES_END, SIDE_ROW):
        if row[k] * x + row[k + 1] * y + row[k + 2] * z - row[k + 3] > SIDE_TOLERANCE:
            return count
    if height < 0.0 and _outside(
        rows, flags, cell_start, cell_triangles, grid, shape, t, x, y, z, height
    ):  # fmt: skip
        return count
    return _add(out, count, height - radius, x, y, z, radius, row[NX], row[NY], row[NZ], at, height, 1.0)


@kernel
def _edge_point(row, k, x, y, z, radius, margin, at, cx, cy, cz, out, count):
    """Candidate between the point (cx, cy, cz) of edge k and the point (x, y, z) of the axis."""
    ux, uy, uz = x - cx, y - cy, z - cz
    length = math.sqrt(ux * ux + uy * uy + uz * uz)
    if length - radius >= margin or length < 1e-9:
        return count
    c = CONE + CONE_ROW * k
    ux, uy, uz = ux / length, uy / length, uz / length
    if ux * row[c] + uy * row[c + 1] + uz * row[c + 2] < -1e-9:
        return count
    if ux * row[c + 3] + uy * row[c + 4] + uz * row[c + 5] < -1e-9:
        return count
    return _add(out, count, length - radius, x, y, z, radius, ux, uy, uz, at, 1.0, 0.0)


@kernel(inline="never")
def _through(row, k, ax, ay, az, bx, by, bz, x, y, z, radius, at, cx, cy, cz, out, count):
    """Candidate between the point (cx, cy, cz) of edge k and the point (x, y, z) of an axis that has come
    through it."""
    ux, uy, uz = cx - x, cy - y, cz - z
    length = math.sqrt(ux * ux + uy * uy + uz * uz)
    if length > row[EDGE_DEPTH_LIMIT + k] or length < 1e-9:
        return count
    ux, uy, uz = ux / length, uy / length, uz / length
    # of two faces the cone has the directions out of them across the edge
    c, side = CONE + CONE_ROW * k, SIDE + SIDE_ROW * k
    if ux * row[c] + uy * row[c + 1] + uz * row[c + 2] < 0.0:
        return count
    if ux * row[side] + uy * row[side + 1] + uz * row[side + 2] < 0.0:
        return count
    # along the edge, and the normal of the other face
    ex = row[side + 1] * row[NZ] - row[side + 2] * row[NY]
    ey = row[side + 2] * row[NX] - row[side] * row[NZ]
    ez = row[side] * row[NY] - row[side + 1] * row[NX]
    nx = row[c + 1] * ez - row[c + 2] * ey
    ny = row[c + 2] * ex - row[c] * ez
    nz = row[c] * ey - row[c + 1] * ex
    if ux * row[NX] + uy * row[NY] + uz * row[NZ] < 0.0 or ux * nx + uy * ny + uz * nz < 0.0:
        return count
    offset = nx * cx + ny * cy + nz * cz
    own_a = row[NX] * ax + row[NY] * ay + row[NZ] * az - row[OFFSET]
    own_b = row[NX] * bx + row[NY] * by + row[NZ] * bz - row[OFFSET]
    before_a = max(own_a, nx * ax + ny * ay + nz * az - offset)
    before_b = max(own_b, nx * bx + ny * by + nz * bz - offset)
    if min(before_a, before_b) <= 0.0:
        return count
    return _add(out, count, -length - radius, x, y, z, radius, ux, uy, uz, at, 1.0, 0.0)


@kernel
def _edge(row, k, ax, ay, az, bx, by, bz, length, radius, margin, out, count):
    """Candidates between exposed edge k and both ends and the inside of the axis."""
    i, j = CORNER + 3 * k, CORNER + 3 * ((k + 1) % 3)
    px, py, pz = row[i], row[i + 1], row[i + 2]
    ex, ey, ez = row[j] - px, row[j + 1] - py, row[j + 2] - pz
    ee = ex * ex + ey * ey + ez * ez
    wa = ((ax - px) * ex + (ay - py) * ey + (az - pz) * ez) / ee
    if 0.0 < wa < 1.0:
        count = _edge_point(
            row, k, ax, ay, az, radius, margin, 0.0, px + wa * ex, py + wa * ey, pz + wa * ez, out, count
        )
    if length <= 0.0:
        return count
    wb = ((bx - px) * ex + (by - py) * ey + (bz - pz) * ez) / ee
    if 0.0 < wb < 1.0:
        count = _edge_point(
            row, k, bx, by, bz, radius, margin, length, px + wb * ex, py + wb * ey, pz + wb * ez, out, count
        )
    # nearest points of two lines: minimise |a + s d - p - w e| over s and w
    dx, dy, dz = bx - ax, by - ay, bz - az
    dd = dx * dx + dy * dy + dz * dz
    de = dx * ex + dy * ey + dz * ez
    rx, ry, rz = ax - px, ay - py, az - pz
    determinant = dd * ee - de * de
    if determinant <= 1e-6 * dd * ee:
        return count
    dr, er = dx * rx + dy * ry + dz * rz, ex * rx + ey * ry + ez * rz
    s = (de * er - ee * dr) / determinant
    w = (dd * er - de * dr) / determinant
    if 0.0 < s < 1.0 and 0.0 < w < 1.0:
        x, y, z = ax + s * dx, ay + s * dy, az + s * dz
        cx, cy, cz = px + w * ex, py + w * ey, pz + w * ez
        count = _edge_point(row, k, x, y, z, radius, margin, s * length, cx, cy, cz, out, count)
        count = _through(
            row, k, ax, ay, az, bx, by, bz, x, y, z, radius, s * length, cx, cy, cz, out, count
        )  # fmt: skip
    return count


@kernel
def _corner(
    row, k, vertex, vertex_start, vertex_edges, ax, ay, az, bx, by, bz, length, radius, margin, out, count
):
    """Candidate between exposed corner k and the nearest point of the axis."""
    i = CORNER + 3 * k
    px, py, pz = row[i], row[i + 1], row[i + 2]
    s = 0.0
    dx, dy, dz = bx - ax, by - ay, bz - az
    if length > 0.0:
        s = ((px - ax) * dx + (py - ay) * dy + (pz - az) * dz) / (length * length)
        s = min(max(s, 0.0), 1.0)
    x, y, z = ax + s * dx, ay + s * dy, az + s * dz
    ux, uy, uz = x - px, y - py, z - pz
    distance = math.sqrt(ux * ux + uy * uy + uz * uz)
    if distance - radius >= margin or distance < 1e-9:
        return count
    ux, uy, uz = ux / distance, uy / distance, uz / distance
    for i in range(vertex_start[vertex], vertex_start[vertex + 1]):
        if ux * vertex_edges[i, 0] + uy * vertex_edges[i, 1] + uz * vertex_edges[i, 2] > 1e-9:
            return count
    return _add(out, count, distance - radius, x, y, z, radius, ux, uy, uz, s * length, 1.0, 0.0)


@kernel
def _reduce(out, count):
    """Drop what another candidate explains, and keep the deepest MAX_CONTACTS in order of discovery."""
    dropped = 0
    for i in range(count):
        for j in range(count):
            if i == j or out[j, IS_FACE] == 0.0 or abs(out[i, AT] - out[j, AT]) >= SAME:
                continue
            if out[i, IS_FACE] > 0.0:
                # an end behind several faces leaves through the nearest
                nearer = out[i, HEIGHT] < out[j, HEIGHT] or (out[i, HEIGHT] == out[j, HEIGHT] and j < i)
                if out[i, HEIGHT] < 0.0 and nearer and out[j, HEIGHT] < SIDE_TOLERANCE:
                    dropped |= 1 << i
            else:
                # an edge or corner in the plane of a face that carries the same point of the axis: a seam
                height = 0.0
                for k in range(3):
                    surface_i = out[i, POSITION + k] - 0.5 * out[i, DISTANCE] * out[i, NORMAL + k]
                    surface_j = out[j, POSITION + k] - 0.5 * out[j, DISTANCE] * out[j, NORMAL + k]
                    height += (surface_i - surface_j) * out[j, NORMAL + k]
                if abs(height) < SAME:
                    dropped |= 1 << i
    kept = 0
    for i in range(count):
        if not dropped & (1 << i):
            if kept != i:
                for k in range(CANDIDATE):
                    out[kept, k] = out[i, k]
            kept += 1
    while kept > MAX_CONTACTS:
        worst = 0
        for i in range(1, kept):
            if out[i, DISTANCE] >= out[worst, DISTANCE]:
                worst = i
        kept -= 1
        for i in range(worst, kept):
            for k in range(CANDIDATE):
                out[i, k] = out[i + 1, k]
    return kept


@kernel
def capsule_contacts(
    rows, flags, vertex_start, vertex_edges, cell_start, cell_triangles, cell_range, grid, shape,
    ax, ay, az, bx, by, bz, radius, margin, out,
):  # fmt: skip
    """Contacts of the capsule with axis a-b (a sphere if a == b) and `radius`; returns how many.

    out: (MAX_CANDIDATES, CANDIDATE) float64, filled with them. Only contacts with a distance below
    `margin` are listed. All in the ground's own frame.
    """
    reach = radius + margin
    pad = max(reach, DEPTH_CAP)  # a face pushes back from its depth limit behind it
    low_z, high_z = min(az, bz) - reach, max(az, bz) + pad
    low_x, high_x = min(ax, bx) - pad, max(ax, bx) + pad
    low_y, high_y = min(ay, by) - pad, max(ay, by) + pad
    fx0, fx1 = (low_x - grid[WEST]) * grid[PER_METRE], (high_x - grid[WEST]) * grid[PER_METRE]
    fy0, fy1 = (low_y - grid[SOUTH]) * grid[PER_METRE], (high_y - grid[SOUTH]) * grid[PER_METRE]
    # not (a > b) rather than a <= b: a NaN position is off the level too
    if not (fx1 >= 0.0 and fy1 >= 0.0 and fx0 < shape[0] and fy0 < shape[1] and low_z < high_z):
        return 0
    x0, y0 = int(max(fx0, 0.0)), int(max(fy0, 0.0))
    x1, y1 = int(min(fx1, shape[0] - 1.0)), int(min(fy1, shape[1] - 1.0))
    dx, dy, dz = bx - ax, by - ay, bz - az
    length = math.sqrt(dx * dx + dy * dy + dz * dz)
    count = 0
    for ix in range(x0, x1 + 1):
        for iy in range(y0, y1 + 1):
            cell = ix * shape[1] + iy
            if cell_range[cell, 0] > high_z or cell_range[cell, 1] < low_z:
                continue
            for i in range(cell_start[cell], cell_start[cell + 1]):
                t = cell_triangles[i]
                row = rows[t]
                if row[LOW_Z] > high_z or row[HIGH_Z] < low_z:
                    continue
                if row[LOW_X] > high_x or row[HIGH_X] < low_x:
                    continue
                if row[LOW_Y] > high_y or row[HIGH_Y] < low_y:
                    continue
                # listed in several cells: only the first of them counts
                if ix != max(x0, flags[t, FIRST_X]) or iy != max(y0, flags[t, FIRST_Y]):
                    continue
                ha = row[NX] * ax + row[NY] * ay + row[NZ] * az - row[OFFSET]
                hb = row[NX] * bx + row[NY] * by + row[NZ] * bz - row[OFFSET]
                if min(ha, hb) > reach or max(ha, hb) < -pad:
                    continue
                count = _face(
                    rows, flags, cell_start, cell_triangles, grid, shape, t, ax, ay, az, radius, margin, 0.0,
                    out, count,
                )  # fmt: skip
                if length > 0.0:
                    count = _face(
                        rows, flags, cell_start, cell_triangles, grid, shape, t, bx, by, bz, radius, margin,
                        length, out, count,
                    )  # fmt: skip
                flag = flags[t, EXPOSED]
                if flag == 0:
                    continue
                for k in range(3):
                    if flag & (1 << k):
                        count = _edge(row, k, ax, ay, az, bx, by, bz, length, radius, margin, out, count)
                    if flag & (8 << k):
                        count = _corner(
                            row, k, flags[t, VERTEX + k], vertex_start, vertex_edges,
                            ax, ay, az, bx, by, bz, length, radius, margin, out, count,
                        )  # fmt: skip
    if count > 1:
        count = _reduce(out, count)
    return count
