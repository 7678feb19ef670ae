"""How many legs of routes cross a thin wall, for each radius.

    python -m benchmarks.thin_walls [--scenes 200] [--first 3000] [--pairs 300]

Each scene is a floor of 6 x 6 m with four upright cards on it, which have no thickness, at any angle. Every
leg of every route between random places is tested exactly against every card.
"""

import argparse
import sys
from collections.abc import Iterable

import numpy as np

from navmesh import NodeGraph, Terrain, WalkRules

__all__ = ["count_crossings", "crosses"]

_RADII = (0.1, 0.12, 0.15, 0.2, 0.3, 0.45)


def _sides(origin: np.ndarray, along: np.ndarray, point: np.ndarray) -> np.ndarray:
    d, off = along - origin, point - origin
    return d[..., 0] * off[..., 1] - d[..., 1] * off[..., 0]


def crosses(p: np.ndarray, q: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Whether the lines p-q (k, 2) cross the line a-b (2,): (k,) bool."""
    return (_sides(p, q, a) * _sides(p, q, b) < 0.0) & (_sides(a, b, p) * _sides(a, b, q) < 0.0)


def cards(rng: np.random.Generator) -> tuple[Terrain, list[tuple[np.ndarray, np.ndarray]]]:
    """A floor with four cards on it, and their ends seen from above."""
    walls = []
    vertices = [(0.0, 0.0, 0.0), (6.0, 0.0, 0.0), (6.0, 6.0, 0.0), (0.0, 6.0, 0.0)]
    faces = [(0, 1, 2), (0, 2, 3)]
    for _ in range(4):
        a, angle = rng.uniform(0.5, 5.5, 2), rng.uniform(0.0, 2.0 * np.pi)
        b = a + rng.uniform(0.5, 3.0) * np.array([np.cos(angle), np.sin(angle)])
        walls.append((a, b))
        n = len(vertices)
        vertices += [(*a, -0.2), (*b, -0.2), (*b, 2.2), (*a, 2.2)]
        faces += [(n, n + 1, n + 2), (n, n + 2, n + 3)]
    return Terrain.from_arrays(np.array(vertices), np.array(faces)), walls


def count_crossings(seeds: Iterable[int], radius: float, pairs: int) -> tuple[int, int]:
    """How many legs of routes go through a card, of how many, in one scene for each of ``seeds``."""
    through = legs = 0
    for seed in seeds:
        rng = np.random.default_rng(seed)
        terrain, walls = cards(rng)
        graph = NodeGraph.build(terrain, WalkRules(), obstacle_rules=None)
        starts, goals = (graph.random_points(rng, pairs, radius) for _ in range(2))
        for route in graph.find_paths(starts, goals, radius):
            way = route.waypoints[:, :2]
            legs += max(len(way) - 1, 0)
            through += sum(int(crosses(way[:-1], way[1:], a, b).sum()) for a, b in walls)
    return through, legs


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--first", type=int, default=3000, help="seed of the first scene")
    parser.add_argument("--pairs", type=int, default=300, help="of places in each scene")
    options = parser.parse_args()
    total = 0
    for radius in _RADII:
        through, legs = count_crossings(
            range(options.first, options.first + options.scenes), radius, options.pairs
        )
        print(f"radius {radius} m: {through} of {legs} legs go through a wall")
        total += through
    return int(total > 0)


if __name__ == "__main__":
    sys.exit(main())
