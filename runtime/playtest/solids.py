"""Floor inside closed solids: a block that stands on a floor hides a piece of it that nobody gets into."""

import math

import numpy as np

from runtime.playtest.site import Site

__all__ = ["is_inside_solid"]

_AROUND = 7  # directions to the sides
_FIRST = 0.37  # [rad] the first of them: along no edge of what is built square


def is_inside_solid(site: Site, place: np.ndarray) -> bool:
    """Whether a body at ``place`` (3,) [m] would stand inside a solid: in every direction, up and to the
    sides, a line from its middle leaves the surface of the level more often than it enters it."""
    terrain = site.graph.terrain
    corners = terrain.vertices[terrain.faces]
    middle = place + np.array([0.0, 0.0, 0.5 * site.graph.rules.headroom])
    turns = _FIRST + 2.0 * math.pi * np.arange(_AROUND) / _AROUND
    ways = [(0.01, 0.017, 1.0), *((math.cos(turn), math.sin(turn), 0.013) for turn in turns)]
    return all(_leaves(corners, middle, np.array(way)) > 0 for way in ways)


def _leaves(corners: np.ndarray, start: np.ndarray, way: np.ndarray) -> int:
    """How many more of the triangles ``corners`` (t, 3, 3) a ray passes from behind than from before."""
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    across = np.cross(way, second)
    volume = np.einsum("ij,ij->i", first, across)  # below 0: the ray goes the way of the normal
    met = np.abs(volume) > 1e-12
    inverse = 1.0 / np.where(met, volume, 1.0)
    aside = start - corners[:, 0]
    turned = np.cross(aside, first)
    u, v = np.einsum("ij,ij->i", aside, across) * inverse, turned @ way * inverse
    far = np.einsum("ij,ij->i", second, turned) * inverse
    met &= (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (far > 0.0)
    return int(-np.sign(volume[met]).sum())
