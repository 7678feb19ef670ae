"""Measures of a level's triangles that tests compare with figures found by hand."""

import numpy as np

from navmesh import Terrain


def area(terrain: Terrain) -> float:
    """[m²] of all triangles."""
    return float(np.linalg.norm(_crosses(terrain), axis=1).sum() / 2.0)


def upward_area(terrain: Terrain) -> float:
    """[m²] of the ground plan, counted with the sign of each triangle: turned over it counts against."""
    return float(_crosses(terrain)[:, 2].sum() / 2.0)


def volume(terrain: Terrain) -> float:
    """[m³] inside closed surfaces."""
    a, b, c = (terrain.vertices[terrain.faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)


def _crosses(terrain: Terrain) -> np.ndarray:
    a, b, c = (terrain.vertices[terrain.faces[:, k]] for k in range(3))
    return np.cross(b - a, c - a)
