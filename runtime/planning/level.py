"""The level of a world, as all that live in it see it: its graph and its ground, which change together."""

from dataclasses import dataclass
from weakref import WeakKeyDictionary

import navmesh
from locomotion import Ground

__all__ = ["Level"]

_grounds: WeakKeyDictionary[navmesh.NodeGraph, Ground] = WeakKeyDictionary()
"""Made once for all worlds on a graph, with zones or without: it never changes."""


_sized: WeakKeyDictionary[Ground, dict[float, Ground]] = WeakKeyDictionary()


@dataclass
class Level:
    """``graph``: where one can go. ``ground``: the same surface, to stand on."""

    graph: navmesh.NodeGraph
    ground: Ground

    @classmethod
    def of(cls, graph: navmesh.NodeGraph) -> "Level":
        """The level that a graph was built for. Raises `locomotion.LocomotionError` for one without a
        triangle that has an area."""
        ground = _grounds.get(graph.undivided)
        if ground is None:
            terrain, rules = graph.terrain, graph.rules
            ground = _grounds[graph.undivided] = Ground.from_arrays(
                terrain.vertices, terrain.faces, max_slope=rules.max_slope, max_step=rules.max_step
            )
        return cls(graph, ground)

    def ground_for(self, size: float) -> Ground:
        """The ground in the measure of a person of another ``size`` (`locomotion.human.measure`): made with
        the first that asks for it, for all worlds."""
        if size == 1.0:
            return self.ground
        sized = _sized.setdefault(self.ground, {})
        if size not in sized:
            sized[size] = self.ground.scaled(1.0 / size)
        return sized[size]
