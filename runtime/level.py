"""The level of a world, as all that live in it see it: its graph and its ground, which change together."""

from dataclasses import dataclass

import navmesh
from locomotion import Ground

__all__ = ["Level"]


@dataclass
class Level:
    """``graph``: where one can go. ``ground``: the same surface, to stand on."""

    graph: navmesh.NodeGraph
    ground: Ground

    @classmethod
    def of(cls, graph: navmesh.NodeGraph) -> "Level":
        """The level that a graph was built for. Raises `locomotion.LocomotionError` for one without a
        triangle that has an area."""
        terrain, rules = graph.terrain, graph.rules
        ground = Ground.from_arrays(
            terrain.vertices, terrain.faces, max_slope=rules.max_slope, max_step=rules.max_step
        )
        return cls(graph, ground)
