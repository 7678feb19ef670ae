"""An obstacle on a recorded person's way, from when it has been told to go over it until it has."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navmesh.graph.node_graph import NodeGraph
from navmesh.routes.route import LinkUse

__all__ = ["Crossing", "crossing_of"]

_SAME = 0.01  # [m] by which a link may be another and the same


@dataclass(frozen=True)
class Crossing:
    """An obstacle that a person is to cross, and where it goes then.

    Attributes:
        affordance: of the obstacle. size, depth: [m] its size, as of `Links.height`, and how thick it is.
        start, edge, end: (3,) of the link [m].
        goals, speed, facing: as of `Walker.go_to`, from the end on. beyond: [m] from the start to the last.
        begun: [s] of the person's time at which the run-up begins; inf before.
        origin: where that was: x, y, z [m], and its speed there [m/s].
        last: [m] behind the edge where it goes on in its gait at the latest.
        waited: [s] that it has waited for others before it.
    """

    affordance: str
    size: float
    depth: float
    start: tuple[float, float, float]
    edge: tuple[float, float, float]
    end: tuple[float, float, float]
    goals: tuple[tuple[float, float, float], ...]
    speed: float
    facing: float | None
    beyond: float
    begun: float = math.inf
    origin: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    last: float = math.inf
    waited: float = 0.0

    @property
    def way(self) -> NDArray[np.float64]:
        """(2,) unit vector over it."""
        apart = np.subtract(self.end, self.start)[:2]
        return apart / np.linalg.norm(apart)

    @property
    def heading(self) -> float:
        """[rad] of the way."""
        x, y = self.way.tolist()
        return math.atan2(y, x)

    def is_there(self, graph: NodeGraph) -> bool:
        """Whether ``graph`` has that link."""
        links = graph.links
        alike = (links.affordance == self.affordance) & (np.abs(links.height - self.size) <= _SAME)
        for known, mine in ((links.start, self.start), (links.end, self.end)):
            alike &= (np.abs(known - np.array(mine)) <= _SAME).all(axis=1)
        return bool(alike.any())

    @property
    def under_way(self) -> bool:
        """Whether the run-up has begun."""
        return math.isfinite(self.begun)


def crossing_of(
    graph: NodeGraph,
    use: LinkUse,
    goals: tuple[tuple[float, float, float], ...],
    speed: float,
    facing: float | None,
    beyond: float,
) -> Crossing:
    """What is to be crossed on a route over a link of ``graph``; the others as of `Crossing`."""
    links, number = graph.links, use.link
    start, edge, end = (
        (float(x), float(y), float(z))
        for x, y, z in (links.start[number], links.edge[number], links.end[number])
    )
    return Crossing(
        str(links.affordance[number]), float(links.height[number]),
        float(graph.obstacles.depth[use.obstacle]), start, edge, end, goals, speed, facing, beyond,
    )  # fmt: skip
