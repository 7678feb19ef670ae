"""Cutting a level into chunks that can be loaded one by one."""

import numpy as np

from navmesh.level.chunks import chunks_by_square
from navmesh.level.terrain import Terrain

__all__ = ["cut_level"]


def cut_level(terrain: Terrain, side: float) -> dict[str, Terrain]:
    """``terrain`` in chunks by squares of ``side`` [m], called "ix,iy", as `navmesh.split_terrain` makes
    them; but a solid (`navmesh.level.solids`) that is not wider than a square stays whole, in the square of
    its middle. Wider ones are cut, and are solids no more."""
    corners = terrain.vertices[terrain.faces][..., :2]
    middle = corners.mean(axis=1)
    parts, part = np.unique(terrain.solid, return_inverse=True)
    least, most = np.full((len(parts), 2), np.inf), np.full((len(parts), 2), -np.inf)
    np.minimum.at(least, part, corners.min(axis=1))
    np.maximum.at(most, part, corners.max(axis=1))
    whole = (parts >= 0) & ((most - least) <= side).all(axis=1)
    kept = whole[part]
    middle[kept] = 0.5 * (least + most)[part[kept]]
    return chunks_by_square(terrain, np.floor(middle / side).astype(np.int64))
