"""A level as one character meets it: walkable parts, and the ways over obstacles from part to part."""

from functools import cached_property

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

import navmesh
from navmesh.graph.open_to_body import parts_of, portals_of
from navmesh.level.mesh_queries import MeshGrid
from runtime.playtest.character import Character
from runtime.playtest.mesh import Mesh
from runtime.playtest.sides import Side

__all__ = ["Site"]


class Site:
    """A graph and a character. A *part* is what can be walked from one of its places to any other.

    ``node_part`` (m,) int: the part of each node, -1 where the body does not fit. ``areas`` (p,) float64
    [m²]: room for the body's middle in each part. ``open_world``: what the graph is the whole of, with
    nothing loaded; None for any other level. ``ways`` (k,) int: the typed links that the body can take;
    ``way_from`` and ``way_to`` (k,) int: the parts that they join.
    """

    def __init__(
        self,
        graph: navmesh.NodeGraph,
        character: Character,
        open_world: navmesh.OpenWorld | None = None,
    ) -> None:
        graph = self.graph = graph.without_zones()
        self.character, self.open_world = character, open_world
        radius = character.radius
        fits = graph.radii >= radius
        self.node_part = np.full(len(graph), -1)
        self.node_part[fits] = np.unique(parts_of(graph, radius)[0][fits], return_inverse=True)[1]
        part = self.node_part[graph.label]
        self.cell_part = np.where((graph.label >= 0) & (graph.surface.clearance >= radius), part, -1)
        inside = self.cell_part[self.cell_part >= 0]
        count = int(self.node_part.max(initial=-1)) + 1
        self.areas = np.bincount(inside, minlength=count) * graph.surface.resolution**2
        self.ways = self._usable()
        links = graph.links
        self.way_from = self.node_part[graph.label[links.start_cell[self.ways]]]
        self.way_to = self.node_part[graph.label[links.end_cell[self.ways]]]

    def _usable(self) -> np.ndarray:
        links, graph = self.graph.links, self.graph
        chosen = np.zeros(len(links), dtype=bool)
        for name, (low, high) in self.character.skills.items():
            chosen |= (links.affordance == name) & (links.height >= low) & (links.height <= high)
        chosen &= links.radius >= self.character.radius
        for cell in (links.start_cell, links.end_cell):
            chosen &= (graph.label[cell] >= 0) & (self.node_part[graph.label[cell]] >= 0)
        return np.flatnonzero(chosen)

    @cached_property
    def walks(self) -> csr_array:
        """(m, m) sparse: the distance [m] between the middles of nodes that the body walks between."""
        start, doors = portals_of(self.graph, self.character.radius)[:2]
        target = doors["target"]
        source = np.repeat(np.arange(len(self.graph)), np.diff(start))
        away = np.linalg.norm(self.graph.positions[target] - self.graph.positions[source], axis=1)
        return coo_array((away + 1e-6, (source, target)), shape=(len(self.graph),) * 2).tocsr()

    @cached_property
    def arcs(self) -> csr_array:
        """(p, p) sparse: 1 where a link leads from one part to another."""
        count = len(self.areas)
        across = self.way_from != self.way_to
        ends = (self.way_from[across], self.way_to[across])
        return coo_array((np.ones(len(ends[0])), ends), shape=(count, count)).tocsr()

    @cached_property
    def loops(self) -> np.ndarray:
        """(p,) int: parts with the same number can be reached from each other."""
        return connected_components(self.arcs, directed=True, connection="strong")[1]

    def reached(self, parts: np.ndarray) -> np.ndarray:
        """(p,) bool: which parts can be reached from any of ``parts`` (indices)."""
        return _reached(self.arcs, parts)

    def returning(self, parts: np.ndarray) -> np.ndarray:
        """(p,) bool: from which parts any of ``parts`` (indices) can be reached."""
        return _reached(self.arcs.T.tocsr(), parts)

    def part_at(self, points: np.ndarray) -> np.ndarray:
        """(k,) int: the part at or nearest to ``points`` (k, 3) where the body fits; -1 where there is
        none."""
        found = np.full(len(points), -1)
        for k, point in enumerate(points):
            here = self.graph.find_path(point, point, radius=self.character.radius)
            if here.status == "complete":
                found[k] = self.node_part[here.nodes[0]]
        return found

    def cells_of(self, *parts: int) -> np.ndarray:
        """(c,) int, rising: the cells where the body's middle can be, of ``parts``."""
        order, first = self._by_part
        each = [order[first[part] : first[part + 1]] for part in parts]
        return np.sort(np.concatenate([order[:0], *each]))

    def side(self, parts: np.ndarray) -> Side:
        """The cells of ``parts`` (p,) bool."""
        return Side(self.graph.surface, self.cells_of(*np.flatnonzero(parts).tolist()))

    @cached_property
    def everywhere(self) -> Side:
        """All cells where the body's middle can be."""
        return Side(self.graph.surface, np.flatnonzero(self.cell_part >= 0))

    @cached_property
    def _by_part(self) -> tuple[np.ndarray, np.ndarray]:
        """The cells in the order of their parts, and where those of each part begin (p + 1,)."""
        order = np.argsort(self.cell_part, kind="stable")
        return order, np.searchsorted(self.cell_part[order], np.arange(len(self.areas) + 1))

    def centre_of(self, part: int) -> np.ndarray:
        """(3,) float64 [m]: the roomiest place of ``part``."""
        nodes = np.flatnonzero(self.node_part == part)
        return self.graph.positions[nodes[np.argmax(self.graph.radii[nodes])]]

    @cached_property
    def mesh(self) -> Mesh:
        """The level's triangles."""
        terrain = self.graph.terrain
        return Mesh(terrain.vertices[terrain.faces].astype(np.float64))

    @cached_property
    def mesh_grid(self) -> MeshGrid:
        """The level's triangles, relative to the surface's origin."""
        terrain = self.graph.terrain
        return MeshGrid(
            terrain.vertices, terrain.faces, self.graph.surface.origin, self.graph.rules.max_slope
        )


def _reached(arcs: csr_array, parts: np.ndarray) -> np.ndarray:
    if len(parts) == 0:
        return np.zeros(len(arcs.indptr) - 1, dtype=bool)
    steps = np.asarray(dijkstra(arcs, indices=np.unique(parts), unweighted=True, min_only=True))
    return np.isfinite(steps)
