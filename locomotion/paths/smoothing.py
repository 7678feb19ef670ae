"""From a route through the graph to a smooth path with the obstacles on it.

Each walked leg is smoothed inside its corridor; straight lines over the obstacles join the legs. The path
meets obstacles at right angles, straight from as far as the run-up needs (`locomotion.paths.approach_legs`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

import pathsmooth
from locomotion.errors import LocomotionError
from locomotion.ground.ground import FRICTION
from locomotion.paths.approach_legs import set_legs
from locomotion.paths.gait_plan import LANDED, SET_OFF, braking_length
from locomotion.paths.room import with_room
from navmesh.obstacles.kinds import kind_of
from navmesh.routes.route import Leg, Route
from navmesh.routes.surface_projection import project_curve_to_surface
from surefoot.slices import Slices, finish

__all__ = [
    "RUNNING", "ObstacleAhead", "SmoothPath", "Smoothing", "pulled_path", "smooth_route", "smoothing_route",
]  # fmt: skip

_LEG = 10_000  # work of setting a leg's ends and finding its corridor, in iterations times waypoints
_ITERATIONS = 450  # per bound on curvature, a millisecond; an exhaustive search takes seconds


@dataclass(frozen=True)
class Smoothing:
    """Requirements of a kind of body on its path.

    Attributes:
        curvatures: [1/m] bounds to try in turn, widest first, until one is not reached within a few
            milliseconds; a leg that reaches none is smoothed without.
        spacing: [m] between waypoints, at most.
        roundness: [m^3] smoothness of the path; corners are rounded over about its cube root.
        run_up, landing: [m] straight before an obstacle's edge and behind it, where there is room; 0: only
            as far as the link over it is straight.
        room: [m] kept from where walking ends, on top of the body's radius, where there is room.
    """

    curvatures: tuple[float, ...]
    spacing: float
    roundness: float
    run_up: float = 0.0
    landing: float = 0.0
    room: float = 0.0


RUNNING = Smoothing((0.12, 0.18, 0.3, 0.5, 0.8), 0.25, 2.0, SET_OFF, LANDED + braking_length(3.5), 0.15)
"""For a running person: corners are rounded over about 1.3 m. The run-up is what a walking person needs to
gain speed; the landing what is run at 3.5 m/s before it stops. It sways, and its arms swing beyond its
radius: a hand that is caught at a corner stops it."""


@dataclass(frozen=True)
class ObstacleAhead:
    """An obstacle that the path crosses.

    Attributes:
        arc_length: [m] horizontal length of the path up to the obstacle's edge.
        affordance: kind of the obstacle.
        height: [m] as in `NodeGraph.obstacles`.
        position: (3,) float64 [m], where the path crosses the edge, at its top.
        normal: (3,) float64, horizontal unit vector at right angles to the edge, towards the run-up side.
        depth: [m] as in `NodeGraph.obstacles`: thickness of what is vaulted, width of a gap, length of
            what is jumped onto.
        friction: coefficient of friction of the ground, filled in by the body that takes off.
    """

    arc_length: float
    affordance: str
    height: float
    position: NDArray[np.float64]
    normal: NDArray[np.float64]
    depth: float = 0.0
    friction: float = FRICTION

    @property
    def size(self) -> float:
        """What a skill's range is compared with [m]: the height, or the width of a gap."""
        return kind_of(self.affordance).size(self.height, self.depth)

    @property
    def far_side(self) -> float:
        """Arc length [m] at which the body is on the ground again behind it."""
        return self.arc_length + (self.depth if kind_of(self.affordance).has_depth else 0.0)


@dataclass(frozen=True)
class SmoothPath:
    """A smooth path.

    points: (n, 3) float64 [m] on the surface. obstacles: in order. bounded: whether the curvature of every
    leg is within one of the bounds (a narrow corner may not allow it).
    """

    points: NDArray[np.float64]
    obstacles: tuple[ObstacleAhead, ...]
    bounded: bool

    def __repr__(self) -> str:
        over = "".join(f", over a {each.affordance}" for each in self.obstacles)
        return f"<SmoothPath: {len(self.points)} points{over}>"


def smooth_route(
    route: Route, smoothing: Smoothing = RUNNING, start_direction: ArrayLike | None = None
) -> SmoothPath:
    """Smooth a route of status "complete" or "partial".

    start_direction: (2,) or (3,) direction in which the body is moving, or None.
    Raises `LocomotionError` for a route without waypoints.
    """
    return finish(smoothing_route(route, smoothing, start_direction))


def smoothing_route(
    route: Route, smoothing: Smoothing = RUNNING, start_direction: ArrayLike | None = None
) -> Slices[SmoothPath]:
    """What `smooth_route` does, in slices. Yields the work of each in iterations of the solver times
    waypoints."""
    if len(route.waypoints) < 2:
        raise LocomotionError(f"a route of status {route.status!r} has no path to smooth")
    heading = None if start_direction is None else np.asarray(start_direction, dtype=np.float64)
    pieces: list[NDArray[np.float64]] = []
    bounded = True
    legs = set_legs(route, smoothing.run_up, smoothing.landing, smoothing.spacing, heading)
    for i, leg in enumerate(legs):
        yield _LEG
        walked = with_room(route, leg.leg, smoothing.room) if smoothing.room > 0.0 else leg.leg
        points, held = yield from _smooth_leg(walked, smoothing, leg.before, leg.after)
        bounded = bounded and held
        pieces += [leg.behind, project_curve_to_surface(route.graph, points), leg.ahead]
        pieces += _over(route, i)
    points = np.concatenate(pieces)
    return SmoothPath(points, _obstacles(route, points), bounded)


def pulled_path(route: Route) -> SmoothPath:
    """The path along a "complete" or "partial" route that is not smoothed: its corners are sharp."""
    pieces: list[NDArray[np.float64]] = []
    for i, walked in enumerate(route.walked()):
        pieces += [walked, *_over(route, i)]
    points = np.concatenate(pieces)
    return SmoothPath(points, _obstacles(route, points), bounded=False)


def _smooth_leg(
    leg: Leg, smoothing: Smoothing, before: ArrayLike | None, after: ArrayLike | None
) -> Slices[tuple[NDArray[np.float64], bool]]:
    """Points of one leg, and whether they meet one of the bounds; end tangents are dropped first."""
    length = float(np.linalg.norm(np.diff(leg.waypoints[:, :2], axis=0), axis=1).sum())
    if length < 1e-3:
        return leg.waypoints, True
    for start, end in ((before, after), (None, after), (None, None)):
        problem = pathsmooth.Problem.from_corridor(
            leg.waypoints, leg.centers, leg.radii, spacing=smoothing.spacing, start_tangent=start,
            end_tangent=end, smoothness=smoothing.roundness,
        )  # fmt: skip
        if smoothing.room > 0.0:
            problem = problem.narrowed(smoothing.room)
        solution, held = yield from pathsmooth.tightening(problem, smoothing.curvatures, _ITERATIONS)
        if solution.status != "infeasible":
            return solution.points, held
    return leg.waypoints, False


def _edge_point(route: Route, index: int) -> NDArray[np.float64]:
    """Where the straight line over a link crosses its obstacle's edge, at the height of the edge."""
    use = route.links[index]
    start, end = route.waypoints[use.first], route.waypoints[use.last]
    obstacles = route.graph.obstacles
    position, normal = obstacles.position[use.obstacle], obstacles.normal[use.obstacle]
    along = float((end - start)[:2] @ normal[:2])
    share = float((position - start)[:2] @ normal[:2]) / along if abs(along) > 1e-9 else 0.5
    point = start + np.clip(share, 0.0, 1.0) * (end - start)
    return np.array([point[0], point[1], position[2]])


def _over(route: Route, index: int) -> list[NDArray[np.float64]]:
    """The line over the obstacle behind a leg, level up to the edge, then level with the landing; none behind
    the last leg."""
    if index == len(route.links):
        return []
    start, end = route.waypoints[route.links[index].first], route.waypoints[route.links[index].last]
    edge, direction = _edge_point(route, index), end - start
    direction = direction / max(float(np.linalg.norm(direction[:2])), 1e-9)
    before = np.array([edge[0] - 1e-3 * direction[0], edge[1] - 1e-3 * direction[1], start[2]])
    after = np.array([edge[0] + 1e-3 * direction[0], edge[1] + 1e-3 * direction[1], end[2]])
    return [np.stack([before, after])]


def _obstacles(route: Route, points: NDArray[np.float64]) -> tuple[ObstacleAhead, ...]:
    """The obstacles that the path ``points`` (n, 3) crosses, as the route does."""
    if not route.links:
        return ()
    steps = np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1)
    arc = np.concatenate([[0.0], np.cumsum(steps)])
    return tuple(
        _obstacle(route, points, arc, use.obstacle, _edge_point(route, i))
        for i, use in enumerate(route.links)
    )


def _obstacle(
    route: Route,
    points: NDArray[np.float64],
    arc: NDArray[np.float64],
    index: int,
    edge: NDArray[np.float64],
) -> ObstacleAhead:
    obstacles = route.graph.obstacles
    nearest = int(np.argmin(np.linalg.norm(points[:, :2] - edge[:2], axis=1)))
    normal = obstacles.normal[index]
    forward = float((edge - points[nearest])[:2] @ -normal[:2])
    return ObstacleAhead(
        float(arc[nearest]) + forward, str(obstacles.affordance[index]), float(obstacles.height[index]),
        edge, normal.copy(), float(obstacles.depth[index]),
    )  # fmt: skip
