"""Heights at which to cut a level so that no part of a storey hides another from above."""

import numpy as np
from scipy.spatial import KDTree

from runtime.traces.trace import LevelTrace

__all__ = ["cut_heights"]

_CELLS = 160  # cells along the longer side of the level, each sampled at its centre
_ROOM = 1.5  # [m] least distance of two floors of which one hides the other
_BELOW = 0.25  # [m] of the cut below the upper floor
_WALKED = 0.7  # least z of the normal of a floor
_NEAR = 8  # discs checked for standing room at a sample


def cut_heights(level: LevelTrace) -> list[float]:
    """Increasing heights [m], as few as possible: of two floors above each other on which a body can stand,
    one is above such a height and one below. Empty for a level of one storey.

    Floors are sampled in cells of 1/160 of the level's longer side; narrower ones can be missed.
    """
    spans = _spans(level)
    cuts: list[float] = []
    for low, high in spans[np.argsort(spans[:, 1])]:
        # the pair that ends lowest is cut as high as possible, which cuts the most other pairs
        if not cuts or cuts[-1] <= low:
            cuts.append(float(high - _BELOW))
    return cuts


def _spans(level: LevelTrace) -> np.ndarray:
    """(n, 2) [m]: heights of pairs of floors above each other."""
    cells, heights = _samples(level)
    if not len(cells):
        return np.empty((0, 2))
    order = np.lexsort((heights, cells))
    cells, heights = cells[order], heights[order]
    over = (cells[1:] == cells[:-1]) & (np.diff(heights) > _ROOM)
    spans = np.column_stack([heights[:-1][over], heights[1:][over]])
    return np.unique(spans.round(2), axis=0)


def _samples(level: LevelTrace) -> tuple[np.ndarray, np.ndarray]:
    """Cells (n,) and heights (n,) [m] of floors at the cells' centres, within a disc of the graph."""
    corners = level.vertices[level.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    upward = normal[:, 2] > _WALKED * np.linalg.norm(normal, axis=1).clip(min=1e-12)
    low = level.vertices[:, :2].min(axis=0)
    size = max(float(np.ptp(level.vertices[:, :2], axis=0).max()), 1e-6) / _CELLS
    cells, points = [np.empty(0, np.int64)], [np.empty((0, 3))]
    for triangle, n in zip(corners[upward], normal[upward], strict=True):
        first = np.ceil((triangle[:, :2].min(axis=0) - low) / size - 0.5).astype(int)
        last = np.floor((triangle[:, :2].max(axis=0) - low) / size - 0.5).astype(int)
        column, row = np.meshgrid(np.arange(first[0], last[0] + 1), np.arange(first[1], last[1] + 1))
        place = low + (np.column_stack([column.ravel(), row.ravel()]) + 0.5) * size
        inside = np.ones(len(place), dtype=bool)
        for a, b in zip(triangle, np.roll(triangle, -1, axis=0), strict=True):
            inside &= (b[0] - a[0]) * (place[:, 1] - a[1]) >= (b[1] - a[1]) * (place[:, 0] - a[0])
        place = place[inside]
        z = triangle[0, 2] - (place - triangle[0, :2]) @ n[:2] / n[2]
        cells.append((column.ravel() * (_CELLS + 2) + row.ravel())[inside])
        points.append(np.column_stack([place, z]))
    stood = _can_stand(level, np.concatenate(points))
    return np.concatenate(cells)[stood], np.concatenate(points)[stood, 2]


def _can_stand(level: LevelTrace, points: np.ndarray) -> np.ndarray:
    """(n,) bool: whether a disc of the graph reaches each of ``points`` (n, 3)."""
    if not len(points) or not len(level.positions):
        return np.zeros(len(points), dtype=bool)
    away, disc = KDTree(level.positions).query(points, k=min(_NEAR, len(level.positions)))
    return (away <= level.radii[disc]).reshape(len(points), -1).any(axis=1)
