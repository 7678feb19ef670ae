"""Rims: the mesh's own edges at which a floor, or the top of a wall, ends with a fall beyond it.

Found from triangles alone, before any sampling of the surface, so a rim is as exact as the mesh. There are
two kinds: the rim of a floor (a walkable face on one side of the edge and none on the other), and the ridge
of something that has no floor on top (a fence without thickness, a pointed wall).
"""

import math
from dataclasses import dataclass

import numpy as np

__all__ = ["Rims", "find_rims"]

_WELD = 5e-4  # [m] vertices closer than this are one
_LEVEL = math.tan(math.radians(20.0))  # steepest edge that counts as a rim, rise over horizontal length
_SHORTEST = 0.02  # [m] shorter edges (horizontally) are left out
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
    """The rims of a mesh: ``vertices`` (v, 3) float64 [m], ``faces`` (f, 3) int, ``max_slope`` [rad].

    Both directions of a ridge are returned. Coincident rims (double faces) are returned once.
    Candidates only: whether there is a fall and how deep is for the caller to measure, since floors that
    meet without sharing vertices look like rims here.
    """
    index, count = _weld(vertices)
    welded = index[faces]
    corner = vertices[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    size = np.linalg.norm(normal, axis=1)
    sound = (size > 1e-12) & (welded[:, 0] != welded[:, 1])
    sound &= (welded[:, 1] != welded[:, 2]) & (welded[:, 2] != welded[:, 0])
    welded, corner, normal, size = welded[sound], corner[sound], normal[sound], size[sound]
    upward = normal[:, 2] / size
    steepest = math.cos(max_slope) - 1e-9
    floor = upward >= steepest
    steep = np.abs(upward) < steepest

    # Three half-edges per face; the key of an edge is the same from both of its faces.
    near = welded.T.reshape(-1)
    far = np.roll(welded, -1, axis=1).T.reshape(-1)
    near_at = corner.transpose(1, 0, 2).reshape(-1, 3)
    far_at = np.roll(corner, -1, axis=1).transpose(1, 0, 2).reshape(-1, 3)
    third_at = np.roll(corner, -2, axis=1).transpose(1, 0, 2).reshape(-1, 3)
    along = far_at - near_at
    length = np.hypot(along[:, 0], along[:, 1])
    usable = (length >= _SHORTEST) & (np.abs(along[:, 2]) <= _LEVEL * length)
    face = np.tile(np.arange(len(welded)), 3)[usable]
    near, far, along, length = near[usable], far[usable], along[usable], length[usable]
    near_at, far_at, third_at = near_at[usable], far_at[usable], third_at[usable]
    flipped = near > far
    key = np.where(flipped, far, near) * np.int64(count) + np.where(flipped, near, far)

    # What lies at each half-edge: a floor to the left or right, a steep face that rises or hangs.
    to_third = third_at - near_at
    side = along[:, 0] * to_third[:, 1] - along[:, 1] * to_third[:, 0]
    part = np.clip((to_third[:, :2] * along[:, :2]).sum(axis=1) / length**2, 0.0, 1.0)
    rise = to_third[:, 2] - part * along[:, 2]
    is_floor, is_steep = floor[face], steep[face]
    left = (side > 0) != flipped
    flags = (
        (is_floor & left) * 1
        | (is_floor & ~left) * 2
        | (is_steep & (rise > _FLAT)) * 4
        | (is_steep & (rise < -_FLAT)) * 8
    ).astype(np.int8)
    if not len(key):
        return _in_order(np.empty((0, 3)), np.empty((0, 3)))
    order = np.argsort(key, kind="stable")
    key = key[order]
    first = np.flatnonzero(np.concatenate(([True], key[1:] != key[:-1])))
    found = np.bitwise_or.reduceat(flags[order], first)

    one = order[first]
    start = np.where(flipped[one, None], far_at[one], near_at[one])
    end = np.where(flipped[one, None], near_at[one], far_at[one])
    rises = (found & 4) != 0
    ridge = (found & 15) == 8
    falls_right = (~rises & ((found & 3) == 1)) | ridge
    falls_left = (~rises & ((found & 3) == 2)) | ridge
    return _in_order(
        np.concatenate((start[falls_right], end[falls_left])),
        np.concatenate((end[falls_right], start[falls_left])),
    )


def _weld(vertices: np.ndarray) -> tuple[np.ndarray, int]:
    """The number of each vertex's place (v,) int64, and how many places there are."""
    grid = np.rint((vertices - vertices.min(axis=0)) / _WELD).astype(np.int64)
    span = grid.max(axis=0) + 1
    if float(span[0]) * float(span[1]) * float(span[2]) < 2.0**62:
        _, index = np.unique((grid[:, 0] * span[1] + grid[:, 1]) * span[2] + grid[:, 2], return_inverse=True)
    else:
        _, index = np.unique(grid, axis=0, return_inverse=True)
    return index.reshape(-1).astype(np.int64), int(index.max()) + 1


def _in_order(start: np.ndarray, end: np.ndarray) -> Rims:
    """Sort by place and drop repetitions, so that the order of the triangles does not show."""
    if not len(start):
        return Rims(np.empty((0, 3)), np.empty((0, 3)), np.empty((0, 2)))
    place = np.rint(np.column_stack((start, end)) / _WELD)
    order = np.lexsort(place.T[::-1])
    fresh = np.concatenate(([True], (np.diff(place[order], axis=0) != 0).any(axis=1)))
    order = order[fresh]
    start, end = start[order], end[order]
    along = end[:, :2] - start[:, :2]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    return Rims(start, end, np.column_stack((along[:, 1], -along[:, 0])))
