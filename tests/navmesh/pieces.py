"""A level of pieces, each of which is a chunk, and whether two graphs of it are the same."""

import numpy as np

from navmesh import NodeGraph, Terrain
from tests.navmesh.shapes import Mesh, box, join, plane, quad, terrain

SKILLS = {"jump": (0.3, 0.7), "vault": (0.6, 1.0), "drop": (0.9, 2.0), "gap": (0.4, 2.5)}
TILE = 4.0


def ramp(x: float, y: float) -> Mesh:
    return quad((x, y, 0), (x + TILE, y, 1.2), (x + TILE, y + TILE, 1.2), (x, y + TILE, 0))


def stairs(x: float, y: float) -> Mesh:
    return join(*(box(x + 0.5 * k, x + 0.5 * (k + 1), y, y + TILE, 0, 0.15 * (k + 1)) for k in range(4)))


PIECES = {
    "floor": lambda x, y: plane(x, x + TILE, y, y + TILE),
    "platform": lambda x, y: join(
        plane(x, x + TILE, y, y + TILE), box(x + 1, x + 3.4, y + 1, y + 3.4, 0, 0.5)
    ),
    "wall": lambda x, y: join(plane(x, x + TILE, y, y + TILE), box(x + 1.9, x + 2.1, y - 0.5, y + 3, 0, 2.5)),
    "fence": lambda x, y: join(plane(x, x + TILE, y, y + TILE), box(x + 1.9, x + 2.1, y, y + TILE, 0, 0.8)),
    "storeys": lambda x, y: join(
        plane(x, x + TILE, y, y + TILE), plane(x, x + TILE, y, y + TILE, 2.6), plane(x, x + 3, y, y + 3, 4.0)
    ),
    "ramp": ramp,
    "stairs": stairs,
    "gap": lambda x, y: plane(x, x + 2.5, y, y + TILE),
}
SPOTS = [(i, j) for i in range(3) for j in range(3)]


def piece(kind: str, spot: tuple[int, int]) -> Terrain:
    return terrain(PIECES[kind](TILE * spot[0], TILE * spot[1]))


def assert_same(graph: NodeGraph, built: NodeGraph) -> None:
    """Bit for bit."""
    for name in ("positions", "radii", "node_cell", "label", "edge_start", "edge_target", "edge_width"):
        np.testing.assert_array_equal(getattr(graph, name), getattr(built, name), name)
    for name in ("edge_gate", "edge_cells"):
        np.testing.assert_array_equal(getattr(graph, name), getattr(built, name), name)
    for name in ("origin", "column_start", "height", "gradient", "link", "clearance", "nearest"):
        np.testing.assert_array_equal(getattr(graph.surface, name), getattr(built.surface, name), name)
    for part in ("obstacles", "links"):
        expected = getattr(built, part).arrays()
        for name, array in getattr(graph, part).arrays().items():
            np.testing.assert_array_equal(array, expected[name], f"{part}.{name}")
    assert graph.terrain.digest == built.terrain.digest


def rebuilt(graph: NodeGraph) -> NodeGraph:
    return NodeGraph.build(graph.terrain, graph.rules, graph.obstacle_rules, graph.tags, extent=graph.extent)
