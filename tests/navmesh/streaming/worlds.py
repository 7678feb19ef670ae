"""Levels of several squares, small enough for tests, as open worlds."""

from functools import cache
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

from benchmarks.large_levels import large_level
from navmesh import NodeGraph, OpenWorld, Terrain, bake_open_world, join_chunks
from navmesh.streaming.cutting import cut_level
from tests.navmesh.pieces import PIECES
from tests.navmesh.shapes import terrain

__all__ = ["RADII", "SIDE", "SKILLS", "WORLDS", "level", "loaded_world", "open_world", "whole"]

RADII = (0.25, 0.6)
SIDE = 20.0
SKILLS = {"jump": (0.3, 0.7), "vault": (0.6, 1.0), "drop": (0.9, 2.0), "gap": (0.4, 2.5)}
WORLDS = ("city", "hills", "clutter", "pieces")
_SIZES = {"city": 3, "hills": 70, "clutter": 30}


def _pieces(seed: int) -> Terrain:
    """A checkerboard of floors, walls, fences, platforms, stairs and gaps, with squares missing."""
    rng = np.random.default_rng(seed)
    names = sorted(PIECES)
    spots = [(i, j) for i in range(14) for j in range(14) if rng.random() < 0.9]
    return terrain(*(PIECES[names[rng.integers(len(names))]](4.0 * i, 4.0 * j) for i, j in spots))


@cache
def level(kind: str, seed: int = 0) -> Terrain:
    """The mesh of a world."""
    return _pieces(seed) if kind == "pieces" else large_level(kind, _SIZES[kind], seed)


@cache
def whole(kind: str, seed: int = 0) -> NodeGraph:
    """The fine graph of all of it."""
    return NodeGraph.build(join_chunks(cut_level(level(kind, seed), SIDE)))


@cache
def _folder(kind: str, seed: int) -> Path:
    return bake_open_world(level(kind, seed), Path(mkdtemp()) / "world", RADII, SIDE)


def open_world(kind: str, seed: int = 0, radius: float = 15.0) -> OpenWorld:
    """The world with nothing loaded."""
    return OpenWorld(_folder(kind, seed), radius)


def loaded_world(kind: str, point: np.ndarray, seed: int = 0, radius: float = 15.0) -> OpenWorld:
    """The world with all loaded that is to be around ``point``."""
    world = open_world(kind, seed, radius)
    while world.keep_around(point, 4):
        pass
    return world
