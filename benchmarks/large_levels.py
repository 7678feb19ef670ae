"""Levels of any size, to see how cost grows: cities, hills, and clutter as scans have it.

    python -m benchmarks.large_levels city 16 -o city16.obj [--seed 0]

Z is up, in metres. Sizes: ``city`` N: N x N blocks of 30 m with six buildings each. ``hills`` N: ground of N
x N squares of 1 m, half of it steeper than 40 degrees. ``clutter`` N: N thousand triangles of junk on three
storeys, with faces missing, turned over and doubled.
"""

import argparse
from collections.abc import Callable
from pathlib import Path

import numpy as np
import trimesh

from navmesh import Terrain

__all__ = ["LARGE_LEVELS", "large_level"]

_CUBE = trimesh.creation.box(extents=(1.0, 1.0, 1.0))
_STOREY = 3.2  # [m]


def large_level(kind: str, size: int, seed: int = 0) -> Terrain:
    """The level of a kind of `LARGE_LEVELS`; the same size and seed give the same level."""
    vertices, faces = LARGE_LEVELS[kind](size, np.random.default_rng(seed))
    return Terrain.from_arrays(vertices, faces, name=f"{kind} {size}")


def _boxes(low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Boxes (n, 3) from corner to corner, as one mesh."""
    corners = np.asarray(_CUBE.vertices) + 0.5
    vertices = low[:, None] + corners * (high - low)[:, None]
    faces = np.asarray(_CUBE.faces) + len(corners) * np.arange(len(low))[:, None, None]
    return vertices.reshape(-1, 3), faces.reshape(-1, 3)


def _squares(number: int) -> np.ndarray:
    """Corners (number², 2) of a square of squares of side 1."""
    return np.stack(np.meshgrid(*2 * [np.arange(number)], indexing="ij"), -1).reshape(-1, 2)


def _city(size: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    block, houses = 30.0, 6
    corner = _squares(size) * block
    ground_low = np.column_stack([corner, np.full(len(corner), -1.0)])
    ground_high = np.column_stack([corner + block, np.zeros(len(corner))])
    count = houses * len(corner)
    middle = np.repeat(corner, houses, axis=0) + rng.uniform(0.15, 0.85, (count, 2)) * block
    half = rng.uniform(1.0, 3.5, (count, 2))
    low = np.column_stack([middle - half, np.zeros(count)])
    high = np.column_stack([middle + half, rng.uniform(2.5, 8.0, count)])
    return _boxes(np.concatenate([ground_low, low]), np.concatenate([ground_high, high]))


def _hills(size: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    x, y = np.meshgrid(np.arange(size + 1.0), np.arange(size + 1.0), indexing="ij")
    z = np.zeros_like(x)
    for wavelength in 160.0 * 0.5 ** np.arange(6):
        for turn, phase in rng.uniform(0.0, 2.0 * np.pi, (4, 2)):
            along = np.cos(turn) * x + np.sin(turn) * y
            z += wavelength / 22.0 * np.sin(2.0 * np.pi * along / wavelength + phase)
    index = np.arange((size + 1) ** 2).reshape(size + 1, size + 1)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    faces = np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)], -2)
    return np.stack([x, y, z], -1).reshape(-1, 3), faces.reshape(-1, 3)


def _clutter(size: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    side, slab = 8.0 * np.sqrt(size), 4.0
    number = int(side / slab)
    place = (
        np.stack(np.meshgrid(np.arange(number), np.arange(number), indexing="ij"), -1).reshape(-1, 2) * slab
    )
    parts = []
    for storey in range(3):
        here = place[rng.random(len(place)) < (1.0 if storey == 0 else 0.7)]
        top = np.full(len(here), _STOREY * storey)
        parts.append(_boxes(np.column_stack([here, top - 0.2]), np.column_stack([here + slab, top])))
    finer = [_CUBE]
    for _ in range(2):
        finer.append(finer[-1].subdivide())
    have = sum(len(faces) for _, faces in parts)
    while have < 1000 * size:
        mesh = finer[rng.integers(len(finer))]
        turn = trimesh.transformations.random_rotation_matrix(rng.random(3))[:3, :3]
        shape = np.asarray(mesh.vertices) * rng.uniform(0.1, 1.8, 3)
        at = [*rng.uniform(0.0, side, 2), _STOREY * rng.integers(3) + rng.uniform(0.0, 0.6)]
        faces = np.asarray(mesh.faces)[rng.random(len(mesh.faces)) > 0.1]  # a tenth is missing
        over = rng.random(len(faces)) < 0.1
        faces[over] = faces[over, ::-1]
        faces = np.concatenate([faces, faces[rng.random(len(faces)) < 0.03]])
        if len(faces):
            parts.append(((shape + rng.normal(0.0, 0.01, shape.shape)) @ turn.T + at, faces))
            have += len(faces)
    first = np.cumsum([0, *(len(vertices) for vertices, _ in parts)])
    faces = np.concatenate([faces + start for (_, faces), start in zip(parts, first, strict=False)])
    return np.concatenate([vertices for vertices, _ in parts]), faces


LARGE_LEVELS: dict[str, Callable[[int, np.random.Generator], tuple[np.ndarray, np.ndarray]]] = {
    "city": _city,
    "hills": _hills,
    "clutter": _clutter,
}
"""What makes vertices (v, 3) and faces (f, 3) of a size."""


def main() -> None:
    parser = argparse.ArgumentParser(description="Write a large level.")
    parser.add_argument("kind", choices=LARGE_LEVELS)
    parser.add_argument("size", type=int)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("-o", "--out", type=Path, required=True, help="a mesh file: OBJ, GLB, PLY or STL")
    options = parser.parse_args()
    terrain = large_level(options.kind, options.size, options.seed)
    trimesh.Trimesh(terrain.vertices, terrain.faces, process=False).export(options.out)


if __name__ == "__main__":
    main()
