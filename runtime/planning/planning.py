"""Plans: from where an agent is, through its goals in order, to one path that a body can follow.

The routes are found at once (`find_way`), which is fast and tells whether there is a way; they are smoothed
at once (`make_plan`), or in slices (`smoothing_way`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

import navmesh
from locomotion import LocomotionError, ObstacleAhead, Smoothing, SmoothPath
from locomotion.paths.aligned_obstacles import lined_up
from locomotion.paths.run_up_room import LEAST_RUN_UP, straight_before
from locomotion.paths.smoothing import RUNNING, pulled_path, smoothing_route
from navmesh.routes.route import Route
from navmesh.routes.route_validity import line_holds
from surefoot.pausing import pause
from surefoot.slices import Slices, finish

__all__ = [
    "Beginning", "NoWay", "NotLoaded", "Plan", "Way", "find_way", "make_plan", "pulled_plan",
    "smoothing_way", "way_holds", "why_not",
]  # fmt: skip

_SHORT = 0.05  # [m] by which a smoothed path may be nearer to a wall than its radius
_SAME = 0.01  # [m] by which a link's ends and height may differ


class NoWay(ValueError):
    """No plan: ``goal`` is the index of the first goal that cannot be reached, ``reason`` says why."""

    def __init__(self, goal: int, reason: str) -> None:
        self.goal, self.reason = goal, reason
        super().__init__(f"goal {goal}: {reason}")


class NotLoaded(NoWay):
    """There is a way, but what comes first of it is not loaded of the open world."""


@dataclass(frozen=True, eq=False)
class Plan:
    """A path through all goals, and how it came about; all points in the world [m].

    ``raw`` (a, 3) are the centres of the discs that A* chose, ``pulled`` (b, 3) the shortest line through
    them, ``points`` (n, 3) the smoothed path that a body follows. ``obstacles`` are what it crosses, in
    order; their arc lengths count from the beginning of ``points``. ``skills`` are their affordances.
    ``ends`` are the arc lengths at which it is at its goals, where that is known.
    """

    raw: np.ndarray
    pulled: np.ndarray
    points: np.ndarray
    obstacles: tuple[ObstacleAhead, ...]
    ends: tuple[float, ...] = ()

    def __repr__(self) -> str:
        over = "".join(f", over a {each}" for each in self.skills)
        return f"<Plan: {self.length:.2f} m, {len(self.points)} points{over}>"

    @property
    def length(self) -> float:
        """Horizontal length of the smoothed path [m]."""
        return _length(self.points)

    @property
    def skills(self) -> tuple[str, ...]:
        """Affordances of the obstacles on the way, in order."""
        return tuple(obstacle.affordance for obstacle in self.obstacles)


class Beginning(NamedTuple):
    """``start`` (3,) [m]: where the body is. ``direction`` (2,): where it is moving, None when it stands.
    ``lead`` (n, 3) [m]: how its path begins in any case, from ``start``."""

    start: np.ndarray
    direction: np.ndarray | None = None
    lead: np.ndarray | None = None


@dataclass(frozen=True, eq=False)
class Way:
    """How to go through all goals from where a body may ``begin``. ``routes``: to each goal from the one
    before; None where it is there already."""

    graph: navmesh.NodeGraph
    begin: Beginning
    routes: tuple[Route | None, ...]

    @property
    def found(self) -> tuple[Route, ...]:
        """The routes that lead anywhere."""
        return tuple(route for route in self.routes if route is not None)


def find_way(
    graph: navmesh.NodeGraph,
    begin: Beginning,
    goals: Sequence[np.ndarray],
    radius: float,
    skills: Mapping[str, tuple[float, float]],
    link_costs: np.ndarray | None = None,
) -> Way:
    """The routes of `make_plan`, which raises `NoWay` where this does. ``link_costs``: see
    `NodeGraph.find_path`."""
    start = begin.start if begin.lead is None else begin.lead[-1]
    routes: list[Route | None] = []
    for index, goal in enumerate(goals):
        pause()
        route = graph.find_path(start, goal, radius=radius, skills=skills, link_costs=link_costs)
        if route.status != "complete":
            raise NoWay(index, why_not(graph, route, start, goal, radius, skills, link_costs))
        if len(route.waypoints) < 2:
            routes.append(None)
            continue
        route = lined_up(route, skills, link_costs)
        routes.append(route)
        start = route.waypoints[-1]
    if begin.lead is None and all(route is None for route in routes):
        raise NoWay(len(goals) - 1, "it is where the body already is")
    return Way(graph, begin, tuple(routes))


def pulled_plan(way: Way) -> Plan:
    """The plan along the shortest line, with sharp corners, until `smoothing_way` has the smooth one."""
    return _joined(way, [pulled_path(route) for route in way.found])


def smoothing_way(way: Way, smoothing: Smoothing = RUNNING) -> Slices[Plan]:
    """The plan of `make_plan`, in slices, as `locomotion.paths.smoothing.smoothing_route` makes them. Raises
    `NoWay`."""
    direction, smoothed = way.begin.direction, []
    for index, route in enumerate(way.routes):
        pause()
        if route is None:
            continue
        if index > 0 and direction is not None and _turns_back(direction, route.waypoints):
            direction = None  # it stands at its goal and turns: a bend would lead past it
        try:
            path = yield from smoothing_route(route, smoothing, direction)
        except LocomotionError as error:
            raise NoWay(index, str(error)) from error
        smoothed.append(path)
        direction = _heading(path.points)
    return _joined(way, smoothed)


def make_plan(
    graph: navmesh.NodeGraph,
    begin: Beginning,
    goals: Sequence[np.ndarray],
    radius: float,
    skills: Mapping[str, tuple[float, float]],
    smoothing: Smoothing = RUNNING,
) -> Plan:
    """Plan from where it may ``begin`` through ``goals``, each (3,), for a body of ``radius`` [m] with
    ``skills``.

    ``smoothing`` is what it wants of its path. Raises `NoWay`.
    """
    return finish(smoothing_way(find_way(graph, begin, goals, radius, skills), smoothing))


def _joined(way: Way, paths: Sequence[SmoothPath]) -> Plan:
    """The plan along ``paths``, one for each route that was found."""
    lead = way.begin.lead
    points = [] if lead is None else [lead]
    begun = 0.0 if lead is None else _length(lead)
    obstacles: list[ObstacleAhead] = []
    ends: list[float] = []
    left = iter(paths)
    for route in way.routes:
        if route is not None:
            path = next(left)
            points.append(path.points)
            obstacles += [replace(each, arc_length=each.arc_length + begun) for each in path.obstacles]
            begun += _length(path.points)
        ends.append(begun)
    raw = [way.graph.positions[route.nodes] for route in way.found] or [points[0]]
    pulled = [route.waypoints for route in way.found] or [points[0]]
    return Plan(
        np.concatenate(raw), np.concatenate(pulled), np.concatenate(points), tuple(obstacles), tuple(ends)
    )


def way_holds(graph: navmesh.NodeGraph, plan: Plan, radius: float, arc: float) -> bool:
    """Whether a body of ``radius`` [m] that is ``arc`` [m] along ``plan`` can go the rest of it on ``graph``:
    as `navmesh.Route.holds`, but of the smoothed path, which may be a little short of the radius."""
    points = plan.points
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1))])
    first = max(int(np.searchsorted(along, arc, side="right")) - 1, 0)
    for obstacle in plan.obstacles:
        # the points just before and behind the edge lie between the ends of the link
        edge = int(np.argmin(np.abs(along - obstacle.arc_length)))
        before = edge if along[edge] <= obstacle.arc_length else edge - 1
        if obstacle.arc_length <= arc:
            first = max(first, before + 2)
            continue
        walked = points[min(first, before - 1) : before]
        if not line_holds(graph, walked, radius - _SHORT):
            return False
        if not _link_holds(graph, obstacle, points[before - 1], points[before + 2]):
            return False
        first = before + 2
    return line_holds(graph, points[first:], radius - _SHORT)


def _link_holds(
    graph: navmesh.NodeGraph, obstacle: ObstacleAhead, start: np.ndarray, end: np.ndarray
) -> bool:
    """Whether ``graph`` has a link over ``obstacle`` from ``start`` to ``end`` (3,)."""
    links = graph.links
    alike = (links.affordance == obstacle.affordance) & (np.abs(links.height - obstacle.size) <= _SAME)
    alike &= (np.abs(links.start - start) <= _SAME).all(axis=1)
    alike &= (np.abs(links.end - end) <= _SAME).all(axis=1)
    return bool(alike.any())


def why_not(
    graph: navmesh.NodeGraph,
    route: Route,
    start: np.ndarray,
    goal: np.ndarray,
    radius: float,
    skills: Mapping[str, tuple[float, float]],
    link_costs: np.ndarray | None = None,
) -> str:
    """Why ``route``, found from ``start`` to ``goal`` (3,) for a body of ``radius`` [m] with ``skills`` but
    and ``link_costs``, does not lead there: over what a way would lead is named."""
    if route.status == "off_graph":
        if graph.find_path(start, start, radius=radius).status == "off_graph":
            return "the way there begins at a place where the body does not fit"
        return "it is not near a place where the body fits"
    links = graph.links
    if link_costs is not None:
        shut = graph.find_path(start, goal, radius=radius, skills=skills)
        if shut.status == "complete":
            return "no way leads there without " + ", ".join(_cramped(graph, shut, radius, link_costs))
    every = dict.fromkeys(np.unique(links.affordance).tolist(), (0.0, float(links.height.max(initial=0.0))))
    over = graph.find_path(start, goal, radius=radius, skills=every)
    reason = "no way leads there on foot or with the skills at hand"
    if over.status != "complete":
        return reason
    kinds, sizes = graph.obstacles.affordance, graph.obstacles.size
    beyond = [
        f"{kinds[use.obstacle]} {sizes[use.obstacle]:.2f} m"
        for use in over.links
        if not _offered(skills, str(kinds[use.obstacle]), float(sizes[use.obstacle]))
    ]
    offer = ", ".join(f"{kind} {low:g} to {high:g} m" for kind, (low, high) in skills.items())
    return f"{reason}: a way would lead over {', '.join(beyond)}; there are {offer or 'no skills'}"


def _cramped(graph: navmesh.NodeGraph, route: Route, radius: float, link_costs: np.ndarray) -> list[str]:
    """What is wrong with each of the links on a route that ``link_costs`` close."""
    kinds, sizes = graph.obstacles.affordance, graph.obstacles.size
    straight = straight_before(graph, radius, LEAST_RUN_UP)
    return [
        f"the {kinds[use.obstacle]} of {sizes[use.obstacle]:.2f} m, which has {straight[use.link]:.1f} m for "
        f"a straight run-up (at least {LEAST_RUN_UP:g} m are needed)"
        for use in route.links
        if np.isinf(link_costs[use.link])
    ]


def _offered(skills: Mapping[str, tuple[float, float]], kind: str, height: float) -> bool:
    low, high = skills.get(kind, (np.inf, -np.inf))
    return low <= height <= high


def _heading(points: np.ndarray) -> np.ndarray | None:
    """(2,) where a path leads at its end; None for one that goes nowhere."""
    steps = np.diff(points[:, :2], axis=0)
    onward = np.flatnonzero(np.linalg.norm(steps, axis=1) > 1e-6)
    return steps[onward[-1]] if len(onward) else None


def _turns_back(direction: np.ndarray, waypoints: np.ndarray) -> bool:
    return float(direction @ (waypoints[1] - waypoints[0])[:2]) < 0.0


def _length(points: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1).sum())
