"""Where floor ends: pieces of its edges for bots to push at."""

import math

import numpy as np

from navmesh.surface.storeys import APART
from runtime.playtest.site import Site

__all__ = ["edges_of"]

_PIECE, _TILE = 1.0, 2.0  # [m] sides of a square with one piece for each direction; and for their order


def edges_of(site: Site, parts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pieces of the edges of ``parts`` (p,) bool, at walls, ledges and holes: places (e, 3) [m] on the floor
    beside them, and headings (e,) [rad] towards them. Neighbours follow each other, along a Z-order
    curve."""
    surface = site.graph.surface
    node_inside = np.append(parts, False)[site.node_part]
    mine = (site.graph.label >= 0) & node_inside[site.graph.label]
    at, way = np.nonzero(mine[:, None] & (surface.storey == APART))
    places = surface.centers(at)
    storey = np.round(places[:, 2] / site.graph.rules.headroom).astype(np.int64)
    squares = np.floor((places[:, :2] - surface.origin[:2]) / _PIECE)
    keys = np.column_stack([squares.astype(np.int64), storey, way])
    chosen = np.unique(keys, axis=0, return_index=True)[1]
    places, way, storey = places[chosen], way[chosen], storey[chosen]
    tiles = np.floor((places[:, :2] - surface.origin[:2]) / _TILE).astype(np.uint64)
    curve = _every_other_bit(tiles[:, 0]) | (_every_other_bit(tiles[:, 1]) << np.uint64(1))
    order = np.lexsort((way, curve, storey))
    return places[order], 0.5 * math.pi * way[order]


def _every_other_bit(values: np.ndarray) -> np.ndarray:
    """The lowest 32 bits of ``values`` (n,) uint64, with a 0 after each."""
    bits = np.arange(32, dtype=np.uint64)
    return (((values[:, None] >> bits) & np.uint64(1)) << (np.uint64(2) * bits)).sum(axis=1, dtype=np.uint64)
