"""Vertices at one place: meshes that share no vertices still meet there."""

import numpy as np

__all__ = ["WELD", "weld"]

WELD = 5e-4
"""[m] Vertices closer than this are one."""


def weld(vertices: np.ndarray) -> tuple[np.ndarray, int]:
    """The number of the place of each of ``vertices`` (v, 3) [m] (v,) int64, and how many places there are:
    vertices closer than `WELD` are mostly one, those at the same place always."""
    grid = np.rint(vertices / WELD).astype(np.int64)
    grid -= grid.min(axis=0)
    span = grid.max(axis=0) + 1
    if float(span[0]) * float(span[1]) * float(span[2]) < 2.0**62:
        _, index = np.unique((grid[:, 0] * span[1] + grid[:, 1]) * span[2] + grid[:, 2], return_inverse=True)
    else:
        _, index = np.unique(grid, axis=0, return_inverse=True)
    return index.reshape(-1).astype(np.int64), int(index.max()) + 1
