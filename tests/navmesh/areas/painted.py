"""Levels with areas, and whether two routes are the same."""

import numpy as np

from navmesh import NodeGraph, Terrain
from tests.navmesh.shapes import join, plane

FIELD_ERROR = 0.002
"""[m] by which the clearance field may read too wide, see docs/how-it-works/navmesh.md."""


def painted(*pieces) -> Terrain:
    """A terrain of (mesh, material) pairs."""
    meshes = [mesh for mesh, _ in pieces]
    materials = np.repeat([name for _, name in pieces], [len(mesh[1]) for mesh in meshes])
    return Terrain.from_arrays(*join(*meshes), materials=materials)


def strips(*names: str, side: float = 4.0) -> Terrain:
    """Strips of 12 m along y, ``side`` [m] wide."""
    return painted(*((plane(k * side, (k + 1) * side, 0, 12), name) for k, name in enumerate(names)))


def built(level: Terrain) -> NodeGraph:
    return NodeGraph.build(level, obstacle_rules=None)


def same(route, other) -> bool:
    return (
        route.status == other.status
        and np.array_equal(route.waypoints, other.waypoints)
        and np.array_equal(route.nodes, other.nodes)
        and route.length == other.length
        and route.links == other.links
    )
