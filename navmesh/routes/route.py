"""What a query for a path answers: one route, or a batch of them."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.routes.corridor import Corridor, corridor_of
from navmesh.routes.route_validity import route_holds
from navmesh.routes.surface_projection import project_to_surface
from surefoot.words import several

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["STATUSES", "Leg", "LinkUse", "Route", "Routes", "gathered", "leg_of", "link_uses"]

STATUSES = ("complete", "partial", "no_path", "off_graph")
"""What a route's status can be.

complete: it leads to the goal. partial: the goal cannot be reached, and the route leads to the place nearest
to it that can be (docs/how-it-works/navmesh.md); or the search was ended early, and it leads to the portal
nearest to the goal that was seen. no_path: the goal cannot be reached, and nothing that can be is nearer to
it than the start. off_graph: the start or the goal has no place near it where the body fits. Routes of the
last two have no waypoints.
"""


@dataclass(frozen=True, slots=True)
class LinkUse:
    """One typed link on a route: waypoints[first] to waypoints[last] is the straight line over it."""

    link: int
    """Index into the graph's links."""
    obstacle: int
    """Index into the graph's obstacles."""
    first: int
    """Index of the waypoint at the run-up point."""
    last: int
    """Index of the waypoint at the landing point."""


@dataclass(frozen=True, slots=True, eq=False)
class Leg:
    """A part of a route that is walked: all of it, or what lies between two links."""

    waypoints: np.ndarray
    """(k, 3) float64 [m], world coordinates."""
    centers: np.ndarray
    """(m, 3) float64 [m]: centres of the corridor's discs, in path order."""
    radii: np.ndarray
    """(m,) float64 [m]: their radii, shrunk by the body's radius."""


@dataclass(slots=True, eq=False)
class Route:
    """The answer to one query."""

    status: str
    """One of `STATUSES`."""
    radius: float
    """[m], of the body that the route was found for."""
    nodes: np.ndarray
    """(n,) int32: the nodes that A* went through, in order; empty when there is no route."""
    waypoints: np.ndarray
    """(k, 3) float64 [m], world coordinates: the pulled path's corners, on the surface."""
    length: float
    """[m]: sum of the straight lines between the waypoints, links included."""
    links: list[LinkUse]
    """The typed links on the way, in order."""
    expanded: int
    """Nodes that the search expanded."""
    graph: "NodeGraph" = field(repr=False)
    """Where the route was found."""
    _cost: float | None = field(default=None, repr=False)
    _legs: list[Leg] | None = field(default=None, repr=False)

    def __repr__(self) -> str:
        over = "".join(f", over {self.graph.obstacles.tag[use.obstacle]}" for use in self.links)
        waypoints = several(len(self.waypoints), "waypoint")
        return f"<Route {self.status}: {self.length:.2f} m, {waypoints}{over}>"

    @property
    def cost(self) -> float:
        """[m]: the length, where every metre walked counts as much as its area costs, and a link as much as
        its `cost`; `length` where no ``costs`` were given."""
        return self.length if self._cost is None else self._cost

    def legs(self) -> list[Leg]:
        """The walked parts of the route, in order, each with its corridor; the links lie between them."""
        if self._legs is None:
            self._legs = [leg_of(self, walked) for walked in self.walked()]
        return self._legs

    def walked(self) -> list[np.ndarray]:
        """Waypoints (k, 3) float64 [m] of the walked parts of the route, in order."""
        if not len(self.waypoints):
            return []
        bounds = [0]
        for use in self.links:
            bounds += [use.first, use.last]
        bounds.append(len(self.waypoints) - 1)
        return [
            self.waypoints[first : last + 1] for first, last in zip(bounds[::2], bounds[1::2], strict=True)
        ]

    def on_surface(self, spacing: float = 0.25) -> np.ndarray:
        """Points (n, 3) float64 [m] along the walked parts, on the surface, at most ``spacing`` [m] apart.

        The waypoints are among them; links are jumped from end to end.
        """
        if not isinstance(spacing, Real) or not spacing > 0.0:
            raise NavmeshError(f"spacing = {spacing!r}: expected a distance [m] above 0")
        parts = [project_to_surface(self.graph, leg.waypoints, spacing) for leg in self.legs()]
        return np.concatenate(parts) if parts else np.empty((0, 3))

    def holds(self, graph: "NodeGraph") -> bool:
        """Whether its body can still go this way, waypoint by waypoint, on ``graph``: what `NodeGraph.update`
        gave after the level changed. False for a route without waypoints. A shorter way may be there as well.
        """
        return route_holds(self, graph)

    @property
    def corridor(self) -> Corridor:
        """The discs along the walked parts, in path order, shrunk by the body's radius."""
        legs = self.legs()
        if not legs:
            return Corridor(np.empty((0, 3)), np.empty(0))
        return Corridor(
            np.concatenate([leg.centers for leg in legs]), np.concatenate([leg.radii for leg in legs])
        )


def leg_of(route: Route, walked: np.ndarray) -> Leg:
    """A walked part of a route, by its waypoints (k, 3) [m], with its corridor."""
    corridor = corridor_of(route.graph, walked, route.radius)
    return Leg(walked, corridor.centers, corridor.radii)


@dataclass(frozen=True, slots=True, eq=False)
class Routes:
    """The answers to a batch of queries, as flat arrays; ``routes[i]`` is one of them."""

    status: np.ndarray
    """(q,) str: one of `STATUSES` each."""
    length: np.ndarray
    """(q,) float64 [m]; 0 where there is no route."""
    cost: np.ndarray
    """(q,) float64 [m]: `Route.cost` of each."""
    radius: float
    """[m], of the body that the routes were found for."""
    expanded: np.ndarray
    """(q,) int64: nodes that each search expanded."""
    waypoints: np.ndarray
    """(w, 3) float64 [m]: all waypoints; those of query i are waypoints[waypoint_start[i]:waypoint_start[i +
    1]]."""
    waypoint_start: np.ndarray
    """(q + 1,) int64."""
    nodes: np.ndarray
    """(n,) int32: all nodes, grouped alike by node_start."""
    node_start: np.ndarray
    """(q + 1,) int64."""
    leaps: np.ndarray
    """(l, 2) int32: for all typed links used, the link and the waypoint at its run-up; grouped by
    leap_start."""
    leap_start: np.ndarray
    """(q + 1,) int64."""
    graph: "NodeGraph" = field(repr=False)

    def __len__(self) -> int:
        return len(self.length)

    def __repr__(self) -> str:
        found = [f"{int((self.status == each).sum())} {each}" for each in STATUSES if each in self.status]
        return f"<Routes: {', '.join(found) or 'none'}>"

    def __getitem__(self, index: int) -> Route:
        i = range(len(self))[index]
        return Route(
            status=str(self.status[i]),
            radius=self.radius,
            nodes=self.nodes[self.node_start[i] : self.node_start[i + 1]],
            waypoints=self.waypoints_of(i),
            length=float(self.length[i]),
            links=link_uses(self.graph, self.leaps[self.leap_start[i] : self.leap_start[i + 1]]),
            expanded=int(self.expanded[i]),
            graph=self.graph,
            _cost=float(self.cost[i]),
        )

    def __iter__(self) -> Iterator[Route]:
        return (self[i] for i in range(len(self)))

    def waypoints_of(self, index: int) -> np.ndarray:
        """(k, 3) float64 [m]: the waypoints of one query."""
        i = range(len(self))[index]
        return self.waypoints[self.waypoint_start[i] : self.waypoint_start[i + 1]]


def gathered(graph: "NodeGraph", radius: float, routes: list[Route]) -> Routes:
    """``routes`` for bodies of one ``radius`` as a batch."""

    def starts(sizes: list[int]) -> np.ndarray:
        return np.concatenate([[0], np.cumsum(sizes, dtype=np.int64)]).astype(np.int64)

    return Routes(
        status=np.array([route.status for route in routes], dtype=np.array(STATUSES).dtype),
        length=np.array([route.length for route in routes], dtype=np.float64),
        cost=np.array([route.cost for route in routes], dtype=np.float64),
        radius=radius,
        expanded=np.array([route.expanded for route in routes], dtype=np.int64),
        waypoints=np.concatenate([np.empty((0, 3)), *(route.waypoints for route in routes)]),
        waypoint_start=starts([len(route.waypoints) for route in routes]),
        nodes=np.concatenate([np.empty(0, np.int32), *(route.nodes for route in routes)]),
        node_start=starts([len(route.nodes) for route in routes]),
        leaps=np.array([(use.link, use.first) for route in routes for use in route.links], np.int32).reshape(
            -1, 2
        ),
        leap_start=starts([len(route.links) for route in routes]),
        graph=graph,
    )


def link_uses(graph: Any, leaps: np.ndarray) -> list[LinkUse]:
    """The rows (link, waypoint at the run-up) of ``leaps`` as `LinkUse`."""
    if len(leaps) == 0:
        return []
    obstacle = graph.links.obstacle
    return [LinkUse(link, int(obstacle[link]), at, at + 1) for link, at in leaps.tolist()]
