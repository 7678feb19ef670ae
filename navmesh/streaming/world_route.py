"""Routes through an open world: fine over what is loaded, coarse beyond."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from navmesh.routes.route import Route
from surefoot.words import several

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["WorldRoute"]


class _Loaded(Protocol):
    """What is asked of an `OpenWorld`."""

    @property
    def graph(self) -> "NodeGraph | None": ...

    def is_loaded(self, points: Any) -> np.ndarray: ...


@dataclass(frozen=True, slots=True, eq=False)
class WorldRoute:
    """The answer to one query of `OpenWorld.route`."""

    status: str
    """One of `navmesh.routes.route.STATUSES`, of the whole way: "complete" says that the goal can be reached,
    whether or not what is on the way is loaded."""
    radius: float
    """[m], of the body that the route was found for."""
    fine: Route | None
    """The way over what is loaded, to be walked now; None where the start is not loaded, and where there is
    no route."""
    beyond: np.ndarray
    """(k, 3) float64 [m]: the coarse waypoints after it, the last of them the goal; begins with the start
    where there is no fine way; (0, 3) where the fine route leads to the end. The body fits at each. Between
    them nothing is promised but that there is a way."""
    beyond_length: float = 0.0
    """[m]: how long that is, measured on the fine graph when the world was baked; the first and the last
    piece (from the start, and to the goal) are taken as straight."""

    def __repr__(self) -> str:
        fine = 0.0 if self.fine is None else self.fine.length
        beyond = several(len(self.beyond), "coarse waypoint")
        return f"<WorldRoute {self.status}: {fine:.1f} m, then {self.beyond_length:.1f} m over {beyond}>"

    @property
    def length(self) -> float:
        """[m]: of both parts."""
        return self.beyond_length + (0.0 if self.fine is None else self.fine.length)

    @property
    def waypoints(self) -> np.ndarray:
        """(k, 3) float64 [m]: those of the fine route, then the coarse ones."""
        return self.beyond if self.fine is None else np.concatenate([self.fine.waypoints, self.beyond])

    def holds(self, world: "_Loaded") -> bool:
        """Whether its fine part can still be walked on what ``world`` has loaded now (`Route.holds`). The
        coarse rest always can."""
        if self.fine is None or self.fine.graph is world.graph:
            return True
        return world.graph is not None and self.fine.holds(world.graph)

    def could_be_finer(self, world: "_Loaded") -> bool:
        """Whether the next coarse waypoint is loaded now, so that `OpenWorld.route` would lead farther."""
        return bool(len(self.beyond)) and bool(world.is_loaded(self.beyond[:1])[0])
