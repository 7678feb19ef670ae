"""Small levels for the tests of crowds, and what is measured there."""

from functools import cache

import numpy as np

import navmesh
from locomotion.crowd import Crowd


def level_of(*plates: tuple[float, float, float, float, float]) -> navmesh.Terrain:
    """Plates (x0, y0, x1, y1, z)."""
    corners, faces = [], []
    for x0, y0, x1, y1, z in plates:
        faces += [[len(corners) + k for k in triangle] for triangle in ((0, 1, 2), (0, 2, 3))]
        corners += [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]
    return navmesh.Terrain.from_arrays(np.array(corners, dtype=float), np.array(faces))


def graph_of(*plates: tuple[float, float, float, float, float]) -> navmesh.NodeGraph:
    return navmesh.NodeGraph.build(level_of(*plates), navmesh.WalkRules(resolution=0.2), obstacle_rules=None)


@cache
def hall() -> navmesh.NodeGraph:
    return graph_of((0.0, 0.0, 20.0, 10.0, 0.0))


@cache
def corner() -> navmesh.NodeGraph:
    """Two halls joined by a corridor of 1 m."""
    return graph_of((0.0, 0.0, 6.0, 6.0, 0.0), (6.0, 2.0, 12.0, 3.0, 0.0), (12.0, 0.0, 18.0, 6.0, 0.0))


def deepest_overlap(crowd: Crowd) -> float:
    """The greatest overlap of two bodies, as a share of the smaller radius."""
    spots, radii = crowd.positions[:, :2], np.array([walker.radius for walker in crowd.walkers])
    away = np.linalg.norm(spots[:, None] - spots[None], axis=2)
    away[np.diag_indices(len(spots))] = np.inf
    return float(((radii[:, None] + radii - away) / np.minimum(radii[:, None], radii)).max())


def run(crowd: Crowd, seconds: float) -> float:
    """Run until nobody walks; returns the deepest overlap. All stay on the surface."""
    worst = -np.inf
    for _ in range(round(seconds / crowd.dt)):
        crowd.tick()
        worst = max(worst, deepest_overlap(crowd))
        if not any(walker.status == "walking" for walker in crowd.walkers):
            break
    radii = np.array([walker.radius for walker in crowd.walkers])
    assert (crowd.graph.clearance_at(crowd.positions) >= 0.99 * radii).all()
    return worst
