"""Rims: the mesh's own edges at which a floor, or the top of a wall, ends with a fall beyond it.

Found from triangles alone, before any sampling of the surface, so a rim is as exact as the mesh. There are
two kinds: the rim of a floor (a walkable face on one side of the edge and none on the other), and the ridge
of something that has no floor on top (a fence without thickness, a pointed wall).
"""

import math
from dataclasses import dataclass

import numpy as np

from navmesh.level.welding import WELD, weld
from surefoot.kernels import allocating_kernel

__all__ = ["Rims", "find_rims", "order_of"]

_LEVEL = math.tan(math.radians(20.0))  # steepest edge that counts as a rim, rise over horizontal length
_SHORTEST = 0.02  # [m] shorter edges (horizontally) are left out
_LEFT, _RIGHT, _RISES, _HANGS = 1, 2, 4, 8  # what lies at an edge
_FLAT = 1e-4  # [m] a face must reach this far above or below an edge to rise or hang from it


@dataclass(frozen=True, slots=True, eq=False)
class Rims:
    """Directed edges with the fall on their right-hand side, in an order that only geometry decides."""

    start: np.ndarray
    """(n, 3) float64 [m]."""
    end: np.ndarray
    """(n, 3) float64 [m]; seen from above, the fall is to the right of start → end."""
    outward: np.ndarray
    """(n, 2) float64: horizontal unit vector at right angles to the edge, over the fall."""

    def __len__(self) -> int:
        return len(self.start)


def find_rims(vertices: np.ndarray, faces: np.ndarray, max_slope: float) -> Rims:
    """The rims of a mesh: ``vertices`` (v, 3) float64 [m], ``faces`` (f, 3) int32, ``max_slope`` [rad].

    Both directions of a ridge are returned. Coincident rims (double faces) are returned once.
    Candidates only: whether there is a fall and how deep is for the caller to measure, since floors that
    meet without sharing vertices look like rims here.
    """
    if not len(faces):
        return _in_order(np.empty((0, 3)), np.empty((0, 3)))
    index, count = weld(vertices)
    kept, key, flags = _half_edges(vertices, faces, index, count, math.cos(max_slope) - 1e-9)
    if not len(key):
        return _in_order(np.empty((0, 3)), np.empty((0, 3)))
    order = np.argsort(key, kind="stable")
    key = key[order]
    first = np.flatnonzero(np.concatenate(([True], key[1:] != key[:-1])))
    found = np.bitwise_or.reduceat(flags[order], first)
    ends = kept[order[first]]
    rises = (found & _RISES) != 0
    ridge = found == _HANGS
    falls_right = (~rises & ((found & (_LEFT | _RIGHT)) == _LEFT)) | ridge
    falls_left = (~rises & ((found & (_LEFT | _RIGHT)) == _RIGHT)) | ridge
    start, end = vertices[ends[:, 0]], vertices[ends[:, 1]]
    return _in_order(
        np.concatenate((start[falls_right], end[falls_left])),
        np.concatenate((end[falls_right], start[falls_left])),
    )


@allocating_kernel
def _half_edges(vertices, faces, place, places, steepest):
    """The edges of every face that are level and long enough to be rims, and what lies at them.

    ``place`` (v,) numbers the places of the vertices, of which there are ``places``. Returns (``ends`` (h, 2)
    int64: vertices, the one with the lower place first; ``key`` (h,) int64: the same for the same edge;
    ``flags`` (h,) int8: whether the face is a floor left or right of the edge, or a steep face that
    rises or hangs from it).
    """
    ends = np.empty((3 * len(faces), 2), np.int64)
    key = np.empty(3 * len(faces), np.int64)
    flags = np.empty(3 * len(faces), np.int8)
    count = 0
    for f in range(len(faces)):
        a, b, c = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
        nx = (b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1])
        ny = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2])
        nz = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        size = math.sqrt(nx * nx + ny * ny + nz * nz)
        if size <= 1e-12 or nz <= -steepest * size:
            continue
        floor = nz >= steepest * size
        for k in range(3):
            i, j, third = faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
            if place[i] == place[j]:
                continue
            if place[i] > place[j]:
                i, j = j, i
            dx = vertices[j, 0] - vertices[i, 0]
            dy = vertices[j, 1] - vertices[i, 1]
            dz = vertices[j, 2] - vertices[i, 2]
            length = math.sqrt(dx * dx + dy * dy)
            if length < _SHORTEST or abs(dz) > _LEVEL * length:
                continue
            tx = vertices[third, 0] - vertices[i, 0]
            ty = vertices[third, 1] - vertices[i, 1]
            if floor:
                flag = _LEFT if dx * ty - dy * tx > 0.0 else _RIGHT
            else:
                part = min(max((tx * dx + ty * dy) / (length * length), 0.0), 1.0)
                rise = vertices[third, 2] - vertices[i, 2] - part * dz
                flag = _RISES if rise > _FLAT else _HANGS if rise < -_FLAT else 0
            ends[count, 0] = i
            ends[count, 1] = j
            key[count] = place[i] * places + place[j]
            flags[count] = flag
            count += 1
    return ends[:count], key[:count], flags[:count]


def order_of(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Indices of the edges ``start`` to ``end`` (n, 3) by place and without repetitions, so that the order of
    the triangles does not show."""
    if not len(start):
        return np.empty(0, np.int64)
    place = np.rint(np.column_stack((start, end)) / WELD)
    order = np.lexsort(place.T[::-1])
    return order[np.concatenate(([True], (np.diff(place[order], axis=0) != 0).any(axis=1)))]


def _in_order(start: np.ndarray, end: np.ndarray) -> Rims:
    if not len(start):
        return Rims(np.empty((0, 3)), np.empty((0, 3)), np.empty((0, 2)))
    order = order_of(start, end)
    start, end = start[order], end[order]
    along = end[:, :2] - start[:, :2]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    return Rims(start, end, np.column_stack((along[:, 1], -along[:, 0])))
