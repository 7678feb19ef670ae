"""Turn a triangle soup into the arrays that the collision kernel reads.

For every triangle: its plane, its three side planes, and which of its edges and corners stick out of
the surface, with the cone of directions in which a body can touch them. Edges inside a flat or concave
part of the surface are left out, so nothing can catch on a seam between triangles.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from locomotion.ground.collider.layout import (
    CONE,
    CONE_ROW,
    CORNER,
    DEPTH_LIMIT,
    EDGE_DEPTH_LIMIT,
    EXPOSED,
    FIRST_X,
    FIRST_Y,
    FLAGS,
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
    ROW,
    SIDE,
    SIDE_ROW,
    SIDES_END,
    SOUTH,
    VERTEX,
    WEST,
)
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["DEPTH_CAP", "TriangleArrays", "build_triangle_arrays", "scaled_arrays", "share_corner"]

#: [m] how far behind a face the centre of a body may be and still be pushed out through it.
DEPTH_CAP = 0.10
#: [m] the least depth limit, of walls thinner than twice this.
DEPTH_FLOOR = 0.01
#: [m] vertices closer than this count as one.
WELD = 1e-5
#: [rad] edges that stick out by less are seams of a flat surface.
FLAT_ANGLE = 2e-3


@dataclass(frozen=True)
class TriangleArrays:
    """What the kernel reads. Coordinates are relative to the ground's origin.

    rows (n, ROW) float64, flags (n, FLAGS) int32, grid (4,) float64: see
    `locomotion.ground.collider.layout`. vertex_start (v + 1,) int32 and
    vertex_edges (e, 3) float64: unit directions of the edges that leave each vertex. Grid: cell_start
    (nx * ny + 1,) int32, cell_triangles int32, cell_range (nx * ny, 2) float64 lowest and highest z.
    shape (2,) int32.
    """

    rows: NDArray[np.float64]
    flags: NDArray[np.int32]
    vertex_start: NDArray[np.int32]
    vertex_edges: NDArray[np.float64]
    cell_start: NDArray[np.int32]
    cell_triangles: NDArray[np.int32]
    cell_range: NDArray[np.float64]
    grid: NDArray[np.float64]
    shape: NDArray[np.int32]


def build_triangle_arrays(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> TriangleArrays:
    """vertices (v, 3) relative to the origin; faces (n, 3), corners counter-clockwise seen from outside.

    Degenerate triangles are left out. The result does not depend on anything but the input's order.
    """
    first, welded = _welded(np.round(vertices / WELD).astype(np.int64))
    points = vertices[first]
    corners = welded[faces]
    distinct = (
        (corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2]) & (corners[:, 2] != corners[:, 0])
    )
    corners = corners[distinct]
    triangle = points[corners]
    cross = np.cross(triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0])
    length = np.linalg.norm(cross, axis=1)
    longest = np.max(np.linalg.norm(np.roll(triangle, -1, axis=1) - triangle, axis=2), axis=1)
    solid = length > 1e-6 * longest * longest + 1e-12
    corners, triangle, cross, length = corners[solid], triangle[solid], cross[solid], length[solid]
    n = len(corners)

    rows = np.zeros((n, ROW))
    normal = cross / length[:, None]
    rows[:, NX:OFFSET] = normal
    rows[:, OFFSET] = np.einsum("ij,ij->i", normal, triangle[:, 0])
    for k in range(3):
        along = triangle[:, (k + 1) % 3] - triangle[:, k]
        outward = np.cross(along, normal)
        outward /= np.linalg.norm(outward, axis=1)[:, None]
        side = SIDE + SIDE_ROW * k
        rows[:, side : side + 3] = outward
        rows[:, side + 3] = np.einsum("ij,ij->i", outward, triangle[:, k])
    rows[:, CORNER : CORNER + 9] = triangle.reshape(n, 9)
    rows[:, LOW_X : LOW_Z + 1] = triangle.min(axis=1)
    rows[:, HIGH_X : HIGH_Z + 1] = triangle.max(axis=1)

    flags = np.zeros((n, FLAGS), np.int32)
    flags[:, VERTEX : VERTEX + 3] = corners
    edge_start, edge_sides = _edges(corners)
    bisectors = np.zeros((len(points), 3))
    _edge_cones(edge_start, edge_sides, rows, flags, bisectors)
    vertex_start, vertex_edges = _vertex_edges(corners, points)
    _exposed_corners(vertex_start, vertex_edges, bisectors, flags)
    cell_start, cell_triangles, cell_range, grid, shape = _grid(rows, flags)
    _depth_limits(rows, flags, cell_start, cell_triangles, grid, shape)
    _edge_depth_limits(edge_start, edge_sides, rows)
    return TriangleArrays(
        rows, flags, vertex_start, vertex_edges, cell_start, cell_triangles, cell_range, grid, shape
    )


_LENGTHS = [
    OFFSET, *range(SIDE + SIDE_ROW - 1, SIDES_END, SIDE_ROW), *range(CORNER, DEPTH_LIMIT + 1),
    *range(LOW_X, HIGH_Z + 1), *range(EDGE_DEPTH_LIMIT, ROW),
]  # fmt: skip
"""Columns of ``rows`` that are in metres."""


def scaled_arrays(arrays: TriangleArrays, factor: float) -> TriangleArrays:
    """The triangles ``factor`` > 0 times as large; what does not depend on that is shared."""
    rows, grid = arrays.rows.copy(), arrays.grid.copy()
    rows[:, _LENGTHS] *= factor
    grid[[WEST, SOUTH]] *= factor
    grid[PER_METRE] /= factor
    return replace(arrays, rows=rows, cell_range=factor * arrays.cell_range, grid=grid)


def _welded(keys: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The first of the ``keys`` (v, 3) of each kind, kinds in rising order, and the kind of each (v,). It
    does what `numpy.unique` of rows does, in a fifth of the time."""
    order = np.lexsort(keys.T[::-1])
    sorted_keys = keys[order]
    new = np.ones(len(keys), bool)
    new[1:] = (sorted_keys[1:] != sorted_keys[:-1]).any(axis=1)
    welded = np.empty(len(keys), np.int64)
    welded[order] = np.cumsum(new) - 1
    return order[new], welded


def _edges(corners: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Sides (3 * triangle + k) grouped by undirected edge: start (e + 1,), sides (3 n,)."""
    tail, head = corners.reshape(-1), np.roll(corners, -1, axis=1).reshape(-1)
    low, high = np.minimum(tail, head), np.maximum(tail, head)
    order = np.lexsort((np.arange(len(low)), high, low))
    new = np.ones(len(order), bool)
    new[1:] = (np.diff(low[order]) != 0) | (np.diff(high[order]) != 0)
    return np.append(np.flatnonzero(new), len(order)).astype(np.int64), order.astype(np.int64)


@allocating_kernel(nogil=True)
def _edge_cones(edge_start, edge_sides, rows, flags, bisectors):
    """Cone of free directions at each edge, from the side planes of its faces; marks the exposed ones."""
    for e in range(len(edge_start) - 1):
        owner = edge_sides[edge_start[e]]
        t, k = owner // 3, owner % 3
        side = SIDE + SIDE_ROW * k
        x = rows[t, side : side + 3]
        y = rows[t, NX:OFFSET]
        # angles in the plane across the edge, from the owner's outward direction towards its normal;
        # each face leaves the half circle around its own outward direction free
        low, high = -0.5 * np.pi, 0.5 * np.pi
        faces = edge_start[e + 1] - edge_start[e]
        for i in range(edge_start[e] + 1, edge_start[e + 1]):
            s, j = edge_sides[i] // 3, edge_sides[i] % 3
            side = SIDE + SIDE_ROW * j
            m = rows[s, side : side + 3]
            angle = np.arctan2(np.dot(m, y), np.dot(m, x))
            low, high = max(low, angle - 0.5 * np.pi), min(high, angle + 0.5 * np.pi)
        if faces == 1:
            low = 0.0  # one-sided: only the front of an open border
        if high - low < FLAT_ANGLE:
            continue
        middle = 0.5 * (low + high)
        direction = np.cos(middle) * x + np.sin(middle) * y
        front = True
        for i in range(edge_start[e], edge_start[e + 1]):
            if np.dot(direction, rows[edge_sides[i] // 3, NX:OFFSET]) < -1e-6:
                front = False
        if not front:
            continue
        flags[t, EXPOSED] |= 1 << k
        cone = CONE + CONE_ROW * k
        rows[t, cone : cone + 3] = -np.sin(low) * x + np.cos(low) * y
        rows[t, cone + 3 : cone + 6] = np.sin(high) * x - np.cos(high) * y
        for c in (k, (k + 1) % 3):
            bisectors[flags[t, VERTEX + c]] += direction


def _vertex_edges(
    corners: NDArray[np.int64], points: NDArray[np.float64]
) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
    """Unit directions of the edges that leave each vertex: start (v + 1,), directions (e, 3)."""
    tail, head = corners.reshape(-1), np.roll(corners, -1, axis=1).reshape(-1)
    count = len(points)
    leaves, arrives = np.divmod(np.unique(np.append(tail * count + head, head * count + tail)), count)
    along = points[arrives] - points[leaves]
    along /= np.linalg.norm(along, axis=1)[:, None]
    start = np.zeros(count + 1, np.int32)
    np.cumsum(np.bincount(leaves, minlength=count), out=start[1:])
    return start, np.ascontiguousarray(along)


@allocating_kernel(nogil=True)
def _exposed_corners(vertex_start, vertex_edges, bisectors, flags):
    """Mark each vertex that sticks out, once, at its first triangle."""
    seen = np.zeros(len(vertex_start) - 1, np.bool_)
    for t in range(len(flags)):
        for k in range(3):
            v = flags[t, VERTEX + k]
            if seen[v]:
                continue
            seen[v] = True
            length = np.sqrt(np.sum(bisectors[v] ** 2))
            exposed = length > 1e-9
            for i in range(vertex_start[v], vertex_start[v + 1]):
                if np.dot(vertex_edges[i], bisectors[v]) >= -FLAT_ANGLE * length:
                    exposed = False
            if exposed:
                flags[t, EXPOSED] |= 8 << k


def _grid(rows: NDArray[np.float64], flags: NDArray[np.int32]):
    """Uniform grid over x and y; a triangle is listed in every cell that its bounds touch."""
    if len(rows):
        low, high = rows[:, LOW_X : LOW_Y + 1].min(axis=0), rows[:, HIGH_X : HIGH_Y + 1].max(axis=0)
    else:
        low, high = np.zeros(2), np.zeros(2)
    extent = np.maximum(high - low, 1e-3)
    cell = float(np.clip(np.sqrt(extent[0] * extent[1] / max(len(rows), 1)), 0.25, 2.0))
    cell = max(cell, float(np.sqrt(extent[0] * extent[1] / 4e6)))
    shape = np.maximum(np.ceil(extent / cell), 1).astype(np.int32)
    first = np.clip(((rows[:, LOW_X : LOW_Y + 1] - low) / cell).astype(np.int64), 0, shape - 1)
    last = np.clip(((rows[:, HIGH_X : HIGH_Y + 1] - low) / cell).astype(np.int64), 0, shape - 1)
    flags[:, FIRST_X : FIRST_Y + 1] = first
    start, triangles, span = _fill_grid(first, last, rows, int(shape[0]), int(shape[1]))
    return start, triangles, span, np.array([low[0], low[1], 1.0 / cell, 0.0]), shape


@allocating_kernel(nogil=True)
def _fill_grid(first, last, rows, nx, ny):
    start = np.zeros(nx * ny + 1, np.int32)
    span = np.empty((nx * ny, 2))
    span[:, 0], span[:, 1] = np.inf, -np.inf
    for t in range(len(first)):
        for ix in range(first[t, 0], last[t, 0] + 1):
            for iy in range(first[t, 1], last[t, 1] + 1):
                c = ix * ny + iy
                start[c + 1] += 1
                span[c, 0] = min(span[c, 0], rows[t, LOW_Z])
                span[c, 1] = max(span[c, 1], rows[t, HIGH_Z])
    start = np.cumsum(start).astype(np.int32)
    fill = start[:-1].copy()
    triangles = np.empty(start[-1], np.int32)
    for t in range(len(first)):
        for ix in range(first[t, 0], last[t, 0] + 1):
            for iy in range(first[t, 1], last[t, 1] + 1):
                c = ix * ny + iy
                triangles[fill[c]] = t
                fill[c] += 1
    return start, triangles, span


@kernel
def share_corner(flags, s, t):
    """Whether two faces have a corner in common."""
    for a in range(1, 4):
        for b in range(1, 4):
            if flags[s, a] == flags[t, b]:
                return True
    return False


@kernel(nogil=True)
def _depth_limits(rows, flags, cell_start, cell_triangles, grid, shape):
    """How deep a body may be behind each face: at most half the thickness of the wall there.

    The thickness is exact: every face that looks the other way is clipped to the prism behind this one.
    """
    reach = 2.0 * DEPTH_CAP
    for t in range(len(rows)):
        thickness = reach
        x0 = max(int((rows[t, LOW_X] - reach - grid[WEST]) * grid[PER_METRE]), 0)
        x1 = min(int((rows[t, HIGH_X] + reach - grid[WEST]) * grid[PER_METRE]), shape[0] - 1)
        y0 = max(int((rows[t, LOW_Y] - reach - grid[SOUTH]) * grid[PER_METRE]), 0)
        y1 = min(int((rows[t, HIGH_Y] + reach - grid[SOUTH]) * grid[PER_METRE]), shape[1] - 1)
        for ix in range(x0, x1 + 1):
            for iy in range(y0, y1 + 1):
                c = ix * shape[1] + iy
                for i in range(cell_start[c], cell_start[c + 1]):
                    s = cell_triangles[i]
                    if ix != max(flags[s, FIRST_X], x0) or iy != max(flags[s, FIRST_Y], y0):
                        continue  # it has been looked at in another cell
                    if rows[s, LOW_Z] > rows[t, HIGH_Z] or rows[s, HIGH_Z] < rows[t, LOW_Z] - reach:
                        continue
                    facing = rows[t, NX] * rows[s, NX] + rows[t, NY] * rows[s, NY] + rows[t, NZ] * rows[s, NZ]
                    if facing > -0.1 or share_corner(flags, s, t):
                        continue
                    thickness = min(thickness, _depth_behind(rows[t], rows[s], thickness))
        rows[t, DEPTH_LIMIT] = max(0.5 * thickness, DEPTH_FLOOR)


@kernel(nogil=True)
def _edge_depth_limits(edge_start, edge_sides, rows):
    """How deep an axis may be behind each edge: as behind the thinner of its two faces. At the border of a
    sheet there is no inside, and where more faces meet none is told."""
    for e in range(len(edge_start) - 1):
        i = edge_start[e]
        if edge_start[e + 1] - i == 2:
            t, k = edge_sides[i] // 3, edge_sides[i] % 3
            rows[t, EDGE_DEPTH_LIMIT + k] = min(
                rows[t, DEPTH_LIMIT], rows[edge_sides[i + 1] // 3, DEPTH_LIMIT]
            )


@allocating_kernel
def _depth_behind(front, back, limit):
    """Least depth [m] of triangle row `back` within the prism behind triangle row `front`, or `limit`."""
    polygon = np.zeros((8, 3))
    clipped = np.zeros((8, 3))
    polygon[:3] = back[CORNER : CORNER + 9].copy().reshape(3, 3)
    count = 3
    plane = np.empty(4)
    for k in range(4):
        if k < 3:
            side = SIDE + SIDE_ROW * k
            plane[:] = front[side : side + SIDE_ROW]
        else:
            plane[:] = front[NX : OFFSET + 1]
        kept = 0
        for i in range(count):
            p, q = polygon[i], polygon[(i + 1) % count]
            a, b = np.dot(plane[:3], p) - plane[3] + 1e-9, np.dot(plane[:3], q) - plane[3] + 1e-9
            if a < 0.0:
                clipped[kept] = p
                kept += 1
            if (a < 0.0) != (b < 0.0):
                clipped[kept] = p + (q - p) * (a / (a - b))
                kept += 1
        count = kept
        polygon[:count] = clipped[:count]
        if count == 0:
            return limit
    for i in range(count):
        limit = min(limit, front[OFFSET] - np.dot(front[NX:OFFSET], polygon[i]))
    return max(limit, 0.0)
