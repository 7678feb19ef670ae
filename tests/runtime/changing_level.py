"""A level of several chunks, any of which may go or change."""

import navmesh
from runtime.planning.rules import person_walk_rules

FLOORS = {
    "west": (0.0, 0.0, 6.0, 8.0),
    "bridge": (6.0, 0.5, 9.0, 3.5),
    "detour": (6.0, 5.0, 9.0, 8.0),
    "east": (9.0, 0.0, 16.0, 8.0),
    "apart": (20.0, 0.0, 22.0, 2.0),
}
"""x0, y0, x1, y1 of each chunk: two floors, and two ways from one to the other."""
START = (2.0, 2.0, 0.0)


def quad(x0, y0, x1, y1, z=0.0):
    corners = [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]
    return navmesh.Terrain.from_arrays(corners, [(0, 1, 2), (0, 2, 3)])


def two_floors():
    """The graph of all chunks, for people."""
    chunks = {name: quad(*corners) for name, corners in FLOORS.items()}
    return navmesh.NodeGraph.build(navmesh.join_chunks(chunks), person_walk_rules())
