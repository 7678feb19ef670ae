"""Levels of boxes, and the links over their edges, for the tests of paths."""

import trimesh

import navmesh
from runtime.planning.rules import person_walk_rules

SKILLS = {"jump": (0.1, 0.7), "drop": (0.2, 2.0)}
"""What a person clears: least and greatest height [m]."""


def graph_of(*blocks):
    """Of boxes from their low to their high corners."""
    mesh = trimesh.util.concatenate([trimesh.creation.box(bounds=each) for each in blocks])
    terrain = navmesh.Terrain.from_arrays(mesh.vertices, mesh.faces)
    return navmesh.NodeGraph.build(terrain, person_walk_rules())
