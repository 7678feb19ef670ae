"""Slow, obvious version of the rules of `locomotion.ground.collider.contact`, for tests.

It uses neither the grid nor the kernel's ordered reductions: it tries every triangle, edge and vertex of a
mesh, and finds free directions from the faces around it instead of reading them from a table.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.ground.collider.build import FLAT_ANGLE, WELD
from locomotion.ground.collider.contact import BESIDE, MAX_CONTACTS, PARALLEL, SAME, SIDE_TOLERANCE

__all__ = ["Contact", "ReferenceMesh", "reference_contacts"]


@dataclass(frozen=True)
class Contact:
    """distance [m] (negative: depth), position and normal (3,), place on the axis [m], from a face or not."""

    distance: float
    position: NDArray[np.float64]
    normal: NDArray[np.float64]
    at: float
    is_face: bool
    height: float

    @property
    def surface(self) -> NDArray[np.float64]:
        """The contact's point on the ground."""
        return self.position - 0.5 * self.distance * self.normal


class ReferenceMesh:
    """A mesh of vertices (v, 3) and faces (f, 3) without degenerate triangles, and what its edges and corners
    leave free.

    depth_limits (f,): how far behind each face [m] a centre is still pushed out.
    """

    def __init__(
        self, vertices: NDArray[np.float64], faces: NDArray[np.int64], depth_limits: NDArray[np.float64]
    ) -> None:
        _, first, welded = np.unique(
            np.round(vertices / WELD), axis=0, return_index=True, return_inverse=True
        )
        self.points, self.corners = vertices[first], welded.reshape(-1)[faces]
        self.normals, self.depth_limits = _normals(self.points[self.corners]), depth_limits
        around: dict[tuple[int, int], list[int]] = {}
        for t, triangle in enumerate(self.corners):
            for k in range(3):
                a, b = int(triangle[k]), int(triangle[(k + 1) % 3])
                around.setdefault((min(a, b), max(a, b)), []).append(t)
        self.edges = []
        """(a, b, faces beside it, the directions out of them) of each edge that sticks out."""
        for (a, b), beside in around.items():
            outward = [_outward(self.points, self.corners[t], self.normals[t], a, b) for t in beside]
            if _edge_sticks_out(outward, [self.normals[t] for t in beside]):
                self.edges.append((a, b, beside, outward))
        self.tips = []
        """(v, the directions of its edges) of each corner that sticks out."""
        for v in range(len(self.points)):
            edges = [e for e in around if v in e]
            if edges and _corner_sticks_out(v, edges, around, self.points, self.corners, self.normals):
                along = [_unit(self.points[a + b - v] - self.points[v])[0] for a, b in edges]
                self.tips.append((v, along))


def reference_contacts(
    mesh: ReferenceMesh,
    start: NDArray[np.float64],
    end: NDArray[np.float64],
    radius: float,
    margin: float = 0.0,
) -> list[Contact]:
    """Contacts of a capsule, deepest first."""
    points, corners, normals, depth_limits = mesh.points, mesh.corners, mesh.normals, mesh.depth_limits
    length = float(np.linalg.norm(end - start))
    found: list[Contact] = []
    ends = [(start, 0.0)] + ([(end, length)] if length > 0 else [])

    for t, normal in enumerate(normals):
        for q, at in ends:
            height = float(normal @ (q - points[corners[t, 0]]))
            touches = height - radius < margin and height >= -depth_limits[t]
            touches = touches and _above(points[corners[t]], normal, q)
            if touches and not (height < 0 and _outside(points, corners, normals, t, q, q - height * normal)):
                found.append(_contact(q, at, normal, height - radius, radius, True, height))

    for a, b, beside, outward in mesh.edges:
        p, along = points[a], points[b] - points[a]
        for q, at in [*ends, *_nearest_inside(start, end, length, p, along)]:
            w = float((q - p) @ along / (along @ along))
            if 0.0 < w < 1.0:
                direction, distance = _unit(q - (p + w * along))
                free = all(direction @ m >= -1e-9 for m in outward)
                if len(beside) == 1:
                    free = free and direction @ normals[beside[0]] >= -1e-9
                if free and distance > 1e-9 and distance - radius < margin:
                    found.append(_contact(q, at, direction, distance - radius, radius, False, 1.0))
        if len(beside) == 2:
            # an axis that has come through the edge: its ends are outside, its nearest point is inside
            planes, limit = [normals[t] for t in beside], min(depth_limits[t] for t in beside)
            for q, at in _nearest_inside(start, end, length, p, along):
                w = float((q - p) @ along / (along @ along))
                direction, distance = _unit(p + w * along - q)
                back = all(direction @ n >= 0.0 for n in [*outward, *planes])
                outside = all(max(n @ (tip - p) for n in planes) > 0.0 for tip in (start, end))
                if back and outside and 1e-9 < distance <= limit:
                    found.append(_contact(q, at, direction, -distance - radius, radius, False, 1.0))

    for v, along in mesh.tips:
        s = float(np.clip((points[v] - start) @ (end - start) / length**2, 0, 1)) if length > 0 else 0.0
        q = start + s * (end - start)
        direction, distance = _unit(q - points[v])
        free = all(direction @ each <= 1e-9 for each in along)
        if free and distance > 1e-9 and distance - radius < margin:
            found.append(_contact(q, s * length, direction, distance - radius, radius, False, 1.0))
    return _reduced(found)


def _normals(triangles: NDArray[np.float64]) -> NDArray[np.float64]:
    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return cross / np.linalg.norm(cross, axis=1)[:, None]


def _unit(vector: NDArray) -> tuple[NDArray[np.float64], float]:
    length = float(np.linalg.norm(vector))
    return (vector / length if length > 0 else vector), length


def _above(triangle: NDArray[np.float64], normal: NDArray[np.float64], q: NDArray[np.float64]) -> bool:
    for k in range(3):
        outward, _ = _unit(np.cross(triangle[(k + 1) % 3] - triangle[k], normal))
        if outward @ (q - triangle[k]) > SIDE_TOLERANCE:
            return False
    return True


def _outside(points, corners, normals, t: int, q: NDArray, surface: NDArray) -> bool:
    """Whether a face that shares a corner with ``t`` lies across the way from q, in front of it, to its point
    on the surface of ``t``."""
    for s, normal in enumerate(normals):
        triangle = points[corners[s]]
        before, behind = normal @ (q - triangle[0]), normal @ (surface - triangle[0])
        if before > SIDE_TOLERANCE > behind and set(corners[s]) & set(corners[t]):
            p = q + before / (before - behind) * (surface - q)
            sides = [_unit(np.cross(triangle[(k + 1) % 3] - triangle[k], normal))[0] for k in range(3)]
            if all(side @ (p - triangle[k]) <= BESIDE for k, side in enumerate(sides)):
                return True
    return False


def _outward(points, triangle, normal, a: int, b: int) -> NDArray[np.float64]:
    """Direction in the triangle's plane that leads out of it across edge a-b."""
    opposite = next(int(c) for c in triangle if c not in (a, b))
    along, _ = _unit(points[b] - points[a])
    inward = points[opposite] - points[a]
    return -_unit(inward - (inward @ along) * along)[0]


def _edge_sticks_out(outward: list, normals: list) -> bool:
    """Whether the directions that all faces leave free at an edge are more than one, and on their fronts."""
    x, y = outward[0], normals[0]
    angles = [np.arctan2(m @ y, m @ x) for m in outward]
    low, high = max(angles) - np.pi / 2, min(angles) + np.pi / 2
    if len(outward) == 1:
        low = 0.0
    middle = np.cos((low + high) / 2) * x + np.sin((low + high) / 2) * y
    return high - low >= FLAT_ANGLE and all(middle @ n >= -1e-6 for n in normals)


def _bisector(outward: list, normals: list) -> NDArray[np.float64]:
    x, y = outward[0], normals[0]
    angles = [np.arctan2(m @ y, m @ x) for m in outward]
    low, high = max(angles) - np.pi / 2, min(angles) + np.pi / 2
    if len(outward) == 1:
        low = 0.0
    return np.cos((low + high) / 2) * x + np.sin((low + high) / 2) * y


def _corner_sticks_out(v, edges, around, points, corners, normals) -> bool:
    total = np.zeros(3)
    for a, b in edges:
        beside = around[(a, b)]
        outward = [_outward(points, corners[t], normals[t], a, b) for t in beside]
        if _edge_sticks_out(outward, [normals[t] for t in beside]):
            total += _bisector(outward, [normals[t] for t in beside])
    direction, length = _unit(total)
    return length > 1e-9 and all(
        _unit(points[a + b - v] - points[v])[0] @ direction < -FLAT_ANGLE for a, b in edges
    )


def _nearest_inside(start, end, length, p, along) -> list:
    """The point inside the axis nearest to the line of an edge, unless the two are parallel."""
    if length == 0:
        return []
    axis = end - start
    matrix = np.array([[axis @ axis, -(axis @ along)], [-(axis @ along), along @ along]])
    if np.linalg.det(matrix) <= 1e-6 * matrix[0, 0] * matrix[1, 1]:
        return []
    s, w = np.linalg.solve(matrix, [-(axis @ (start - p)), along @ (start - p)])
    return [(start + s * axis, s * length)] if 0 < s < 1 and 0 < w < 1 else []


def _contact(q, at, normal, distance, radius, is_face, height) -> Contact:
    return Contact(float(distance), q - (radius + distance / 2) * normal, normal, at, is_face, height)


def _reduced(found: list[Contact]) -> list[Contact]:
    """Repeated contacts once, without seams, and only the nearest way out, the deepest first."""
    distinct: list[Contact] = []
    for c in sorted(found, key=lambda c: c.distance):
        if not any(abs(c.at - d.at) < SAME and c.normal @ d.normal > PARALLEL for d in distinct):
            distinct.append(c)
    kept = []
    for c in distinct:
        others = [d for d in distinct if d is not c and d.is_face and abs(c.at - d.at) < SAME]
        if c.is_face and c.height < 0 and any(c.height < d.height < SIDE_TOLERANCE for d in others):
            continue
        if not c.is_face and any(abs((c.surface - d.surface) @ d.normal) < SAME for d in others):
            continue
        kept.append(c)
    return kept[:MAX_CONTACTS]
