"""Walkers: cheap bodies of any radius that follow their routes and keep out of each other's way."""

from collections import deque
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

import navmesh
from locomotion import LocomotionError, ObstacleAhead
from locomotion.body_events import Event
from locomotion.crowd import Crowd, NoRoute, Walker, WalkerState
from locomotion.crowd.saved_state_check import check_walker
from navmesh.routes.route import Route
from navmesh.routes.route_validity import line_holds
from navmesh.routes.surface_projection import project_to_surface
from runtime.bodies.figure import Figure, Shapes
from runtime.bodies.populations import Populations
from runtime.bodies.pose import between
from runtime.bodies.protocol import PLANS_KEPT, Driver, Population, recall, saved_parts
from runtime.errors import RuntimeInputError
from runtime.planning.level import Level
from runtime.planning.planning import NoWay, Plan, why_not

__all__ = ["WalkerDriver", "Walkers", "walker_figure"]

_SPACING = 0.5  # [m] of the points of a plan
_COLOUR = (0.86, 0.56, 0.20)


def walker_figure(radius: float) -> Figure:
    """A capsule as wide as the body and as high as a person, with a nose; the root is on the ground."""
    height = max(min(1.7, 5.7 * radius), 2.2 * radius)
    shapes = (
        ((0.0, 0.0, 0.5 * height), (radius, 0.5 * height - radius, 0.0)),
        ((0.95 * radius, 0.0, height - radius), (0.35 * radius, 0.25 * radius, 0.25 * radius)),
    )
    return Figure(
        bodies=("root",),
        parents=np.array([-1], dtype=np.int32),
        owner=np.zeros(2, dtype=np.int32),
        shapes=Shapes(
            place=np.array([[*place, 1.0, 0.0, 0.0, 0.0] for place, _ in shapes]),
            size=np.array([size for _, size in shapes]),
            round=np.array([False, True]),
            colour=np.array([_COLOUR, [0.6 * c for c in _COLOUR]]),
        ),
    )


class Walkers(Population):
    """All walkers of a world, in one crowd. They avoid all others of its ``populations``, which are advanced
    before them."""

    def __init__(self, level: Level, populations: Populations) -> None:
        self._level, self.crowd, self._populations = level, Crowd(level.graph), populations
        self.before = np.zeros((0, 7))

    def spawn(self, body: str, place: np.ndarray, facing: float, radius: float) -> Driver:
        return WalkerDriver(self, self.crowd.add(place, radius, facing))

    def revive(self, body: str, state: Any) -> Driver:
        driver = WalkerDriver(self, self.crowd.adopt(self.checked(state)[0]))
        driver.restore(state)
        return driver

    def checked(self, state: Any) -> tuple[WalkerState, tuple[Plan, ...]]:
        """What `WalkerDriver.save` gave. Raises `RuntimeInputError` and `LocomotionError` for what it cannot
        have given on this level."""
        body, plans = saved_parts(state, WalkerState)
        check_walker(body, self._level.graph)
        return body, plans

    def remove(self, driver: Driver) -> None:
        assert isinstance(driver, WalkerDriver)
        self.crowd.remove(driver.walker.index)
        self.forget()

    def in_the_way(self) -> np.ndarray:
        return self.crowd.discs()

    def remember(self) -> None:
        if len(self.crowd):
            self.before = self.transforms()

    def forget(self) -> None:
        """Draw all where they are now."""
        self.before = np.zeros((0, 7))

    def transforms(self) -> np.ndarray:
        """(n, 7): where all are, position [m] and quaternion (w, x, y, z)."""
        half = 0.5 * self.crowd.yaws
        zero = np.zeros_like(half)
        return np.column_stack([self.crowd.positions, np.cos(half), zero, zero, np.sin(half)])

    def foresee(self, graph: navmesh.NodeGraph) -> None:
        self.crowd.foresee(graph)

    def change_level(self) -> None:
        self.crowd.change_graph(self._level.graph)

    def change_zones(self) -> None:
        self.change_level()

    def tick(self) -> None:
        if len(self.crowd):
            self.crowd.lead(self._populations.discs_around(self))
            self.crowd.tick()


def _on_the_way(routes: Sequence[Route]) -> Iterator[ObstacleAhead]:
    """What ``routes``, one after the other, lead over."""
    begun = 0.0
    for route in routes:
        along = np.concatenate(
            [[0.0], np.cumsum(np.linalg.norm(np.diff(route.waypoints[:, :2], axis=0), axis=1))]
        )
        for use in route.links:
            links, of = route.graph.links, route.graph.obstacles
            way = (links.start[use.link] - links.end[use.link])[:2]
            normal = np.array([*(way / np.linalg.norm(way)), 0.0])
            yield ObstacleAhead(
                begun + float(along[use.first] + links.run_up[use.link]), str(links.affordance[use.link]),
                float(of.height[use.obstacle]), links.edge[use.link], normal, float(of.depth[use.obstacle]),
            )  # fmt: skip
        begun += float(along[-1])


class WalkerDriver(Driver):
    """A walker."""

    def __init__(self, population: Any, walker: Walker) -> None:
        self._population, self.walker = population, walker
        self.radius = walker.radius
        self.figure = walker_figure(walker.radius)
        self.events: list[Event] = walker.events
        self.plans: deque[Plan] = deque(maxlen=PLANS_KEPT)

    @property
    def simulated(self) -> Any:
        return self.walker

    @property
    def time(self) -> float:
        return self.walker.time

    @property
    def status(self) -> str:
        return self.walker.status

    @property
    def position(self) -> np.ndarray:
        return self.walker.position

    @property
    def facing(self) -> float:
        return self.walker.yaw

    @property
    def progress(self) -> float:
        length = self.plans[-1].length if self.plans else 0.0
        if self.walker.status != "walking" or length == 0.0:
            return 1.0 if self.walker.status == "arrived" else 0.0
        return float(np.clip(1.0 - self.walker.left / length, 0.0, 1.0))

    @property
    def left(self) -> float:
        return self.walker.left

    @property
    def hindrance(self) -> str:
        return "it waits for its turn" if self.walker.queues else "others are in its way"

    def transforms(self) -> np.ndarray:
        half = 0.5 * self.walker.yaw
        return np.array([[*self.walker.position, np.cos(half), 0.0, 0.0, np.sin(half)]])

    def transforms_between(self, share: float) -> np.ndarray:
        index = self.walker.index
        before = self._population.before[index : index + 1]
        return between(before, self.transforms(), share) if len(before) else self.transforms()

    def plan(self, goals: np.ndarray) -> Plan:
        try:
            return self._plan_of(self._find_routes(goals))
        except NoRoute as error:
            raise self._no_way(error, goals) from None

    def go_to(self, goals: np.ndarray, speed: float, facing: float | None) -> Plan:
        try:
            plan = self._plan_of(self.simulated.go_to(goals, speed, facing))
        except NoRoute as error:
            raise self._no_way(error, goals) from None
        except LocomotionError as error:
            raise RuntimeInputError(str(error)) from None
        self.plans.append(plan)
        return plan

    @property
    def goals_left(self) -> int:
        return len(self.walker.crowd.goals_left(self.walker.index))

    def way_holds(self) -> bool:
        crowd = self.walker.crowd
        return line_holds(crowd.graph, crowd.way_left(self.walker.index), self.radius)

    def stop(self) -> None:
        self.simulated.stop()

    def _find_routes(self, goals: np.ndarray) -> list[Route]:
        return self.walker.crowd.find_routes(self.walker.index, goals)

    def _plan_of(self, routes: list[Route]) -> Plan:
        graph = self.walker.crowd.graph
        nodes = np.concatenate([route.nodes for route in routes])
        pulled = np.concatenate([route.waypoints for route in routes])
        legs = [leg.waypoints for route in routes for leg in route.legs()]
        points = [project_to_surface(graph, leg, _SPACING) for leg in legs]
        return Plan(graph.positions[nodes], pulled, np.concatenate(points), tuple(_on_the_way(routes)))

    def _no_way(self, error: NoRoute, goals: np.ndarray) -> NoWay:
        graph, goal = self.walker.crowd.graph, goals[error.goal]
        reason = why_not(graph, error.route, error.start, goal, self.radius, self.skills)
        return NoWay(error.goal, reason)

    def save(self) -> tuple[WalkerState, tuple[Plan, ...]]:
        return self.walker.save(), tuple(self.plans)[-1:]

    def restore(self, state: Any) -> None:
        body, plans = self._population.checked(state)
        self.walker.restore(body)
        recall(self.plans, plans)
        self._population.forget()

    def state_hash(self) -> str:
        return self.walker.state_hash()
