"""Cells of a level on one side of what keeps two of its parts apart, and which of them are near a place."""

from functools import cached_property

import numpy as np
from scipy.spatial import KDTree

from navmesh.surface.surface import Surface

__all__ = ["Side"]


class Side:
    """Some ``cells`` (k,) int, rising, of a ``surface``. What is asked of it takes time in proportion to what
    is near, not to the level."""

    def __init__(self, surface: Surface, cells: np.ndarray) -> None:
        self.cells = cells
        self._surface = surface

    @cached_property
    def places(self) -> np.ndarray:
        """(k, 3) float64 [m]: their centres."""
        return self._surface.centers(self.cells)

    @cached_property
    def tree(self) -> KDTree:
        """Of `places`."""
        return KDTree(self.places)

    def within(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """(n, 3) float64 [m]: those of `places` in the box from ``low`` to ``high`` (3,) [m], in order."""
        return self.places[self.rows_within(low, high)]

    def rows_within(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """(n,) int, rising: which of `places` are in the box from ``low`` to ``high`` (3,) [m]."""
        surface = self._surface
        corners = (np.array([low, high])[:, :2] - surface.origin[:2]) / surface.resolution
        (left, near), (right, far) = np.clip(np.floor(corners).astype(int), 0, np.array(surface.shape) - 1)
        columns = np.arange(left, right + 1) * surface.shape[1]
        begin = np.searchsorted(self.cells, surface.column_start[columns + near])
        end = np.searchsorted(self.cells, surface.column_start[columns + far + 1])
        rows = np.concatenate([np.arange(a, b) for a, b in zip(begin, end, strict=True)])
        found = self.places[rows]
        return rows[((found >= low) & (found <= high)).all(axis=1)]
