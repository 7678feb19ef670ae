"""What an agent asks of its body, whatever kind that is, and the kinds there are.

A `Population` makes and advances all bodies of its kinds in a world: people one by one, animals in one call.
A `Driver` is one body of it.
"""

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np

import navmesh
from locomotion import PERSON_RULES, Ground, Human, HumanState, LocomotionError
from locomotion.clearing import HEIGHT_TOLERANCE
from locomotion.events import Event
from locomotion.quadruped import BODY_NAMES, Animal, AnimalMemory, Body, Herd, Place, check_places, load_body
from locomotion.quadruped.footprint import at_place
from runtime.animal_figure import animal_figure
from runtime.errors import RuntimeInputError
from runtime.figure import Figure
from runtime.planning import Plan, make_plan

__all__ = ["BODIES", "AnimalDriver", "Driver", "HumanDriver", "Pack", "People", "Population", "radius_of"]

BODIES = ("human", *BODY_NAMES)
"""What `World.spawn` can make."""


def radius_of(body: str) -> float:
    """[m] that the graph's queries keep free around a body of `BODIES`."""
    return PERSON_RULES["radius"] if body == "human" else load_body(body).radius


class Driver(Protocol):
    """One body. ``events`` is what happened to it, in order; ``plans`` the paths it was given or made."""

    figure: Figure
    events: list[Event]
    plans: list[Plan]

    @property
    def time(self) -> float: ...
    @property
    def status(self) -> str: ...
    @property
    def position(self) -> np.ndarray: ...
    @property
    def facing(self) -> float: ...
    @property
    def progress(self) -> float:
        """Share of its path that is behind it, 0 to 1."""
        ...

    @property
    def skills(self) -> Mapping[str, tuple[float, float]]: ...
    def transforms(self) -> np.ndarray: ...
    def plan(self, goals: np.ndarray) -> Plan:
        """The way through ``goals`` (k, 3), not taken. Raises `runtime.planning.NoWay`."""
        ...

    def go_to(self, goals: np.ndarray, speed: float, facing: float | None) -> Plan:
        """Take the way through ``goals``. Raises `runtime.planning.NoWay`."""
        ...

    def save(self) -> Any: ...
    def restore(self, state: Any) -> None: ...
    def state_hash(self) -> str: ...


class Population(Protocol):
    """All bodies of some kinds in a world."""

    bodies: tuple[str, ...]

    def spawn(self, body: str, place: np.ndarray, facing: float) -> Driver: ...
    def tick(self) -> None:
        """Advance all by 10 ms."""
        ...


class People:
    """Simulated persons."""

    bodies: tuple[str, ...] = ("human",)

    def __init__(self, graph: navmesh.NodeGraph, ground: Ground) -> None:
        self._graph, self._ground = graph, ground
        self._humans: list[Human] = []

    def spawn(self, body: str, place: np.ndarray, facing: float) -> Driver:
        human = Human(self._ground)
        human.reset(place, facing)
        self._humans.append(human)
        return HumanDriver(self._graph, human)

    def tick(self) -> None:
        for human in self._humans:
            human.tick()


class HumanDriver:
    """A person."""

    def __init__(self, graph: navmesh.NodeGraph, human: Human) -> None:
        self._graph, self.human = graph, human
        self.figure = Figure.from_model(human.model)
        self.events = human.events
        self.plans: list[Plan] = []

    @property
    def time(self) -> float:
        return self.human.time

    @property
    def status(self) -> str:
        return self.human.status

    @property
    def position(self) -> np.ndarray:
        return self.human.position

    @property
    def facing(self) -> float:
        return self.human.yaw

    @property
    def progress(self) -> float:
        length = self.plans[-1].length if self.plans else 0.0
        return self.human.arc_length / length if length > 0.0 else 1.0

    @property
    def skills(self) -> Mapping[str, tuple[float, float]]:
        return {
            skill.affordance: (skill.heights[0] - HEIGHT_TOLERANCE, skill.heights[1] + HEIGHT_TOLERANCE)
            for skill in self.human.clearing
        }

    def transforms(self) -> np.ndarray:
        return self.human.body_transforms()[1:]

    def plan(self, goals: np.ndarray) -> Plan:
        velocity = self.human.velocity[:2]
        moving = velocity if np.linalg.norm(velocity) > 0.5 else None
        radius = PERSON_RULES["radius"]
        return make_plan(self._graph, self.position, list(goals), radius, self.skills, moving)

    def go_to(self, goals: np.ndarray, speed: float, facing: float | None) -> Plan:
        if facing is not None:
            raise RuntimeInputError("a human cannot turn to a facing at its goal yet; leave it out")
        if self.human.status == "fallen":
            raise RuntimeInputError("it has fallen and cannot go anywhere")
        plan = self.plan(goals)
        self.human.follow(plan.points, speed, plan.obstacles)
        self.plans.append(plan)
        return plan

    def save(self) -> tuple[HumanState, tuple[Plan, ...]]:
        return self.human.save_state(), tuple(self.plans)

    def restore(self, state: tuple[HumanState, tuple[Plan, ...]]) -> None:
        self.human.restore_state(state[0])
        self.plans[:] = state[1]

    def state_hash(self) -> str:
        return self.human.state_hash()


class Pack:
    """Dogs, cats and horses, in one herd."""

    bodies: tuple[str, ...] = BODY_NAMES

    def __init__(self, graph: navmesh.NodeGraph, ground: Ground) -> None:
        self._graph = graph
        self._herd = Herd(ground)
        self._drivers: list[AnimalDriver] = []

    def spawn(self, body: str, place: np.ndarray, facing: float) -> Driver:
        kind = load_body(body)
        stands = check_places(
            at_place(Place(float(place[0]), float(place[1]), float(place[2]), facing)),
            kind,
            self._herd.ground,
        )
        if not stands.free:
            what = "finds no ground" if stands.part == "ground" else f"has no room for its {stands.part}"
            raise RuntimeInputError(f"at {place.round(2).tolist()} facing {facing:.2f} a {body} {what}")
        driver = AnimalDriver(self._graph, self._herd, self._herd.add(kind, place, facing))
        self._drivers.append(driver)
        return driver

    def tick(self) -> None:
        self._herd.tick()
        for driver in self._drivers:
            driver.tick()


class _Ways:
    """`locomotion.quadruped.Planner` on a graph."""

    def __init__(self, graph: navmesh.NodeGraph, body: Body) -> None:
        self._graph, self._body = graph, body

    def through(self, start: np.ndarray, goals: np.ndarray, direction: np.ndarray | None = None) -> Plan:
        return make_plan(
            self._graph, start, list(goals), self._body.radius, {}, direction, self._body.smoothing
        )

    def way(self, start: np.ndarray, goal: np.ndarray, direction: np.ndarray) -> Plan:
        return self.through(start, goal[None], direction)

    def room_to_turn(self, points: np.ndarray, length: float) -> np.ndarray:
        return self._graph.room_to_turn(points, length)


class AnimalDriver:
    """One animal of a herd."""

    def __init__(self, graph: navmesh.NodeGraph, herd: Herd, index: int) -> None:
        self._ways = _Ways(graph, herd.bodies[index])
        self.animal = Animal(herd, index, self._ways)
        self.figure = animal_figure(self.animal.body)
        self.events = self.animal.events
        self.plans: list[Plan] = []
        self._followed = self.animal.trail

    @property
    def time(self) -> float:
        return self.animal.time

    @property
    def status(self) -> str:
        return self.animal.status

    @property
    def position(self) -> np.ndarray:
        return self.animal.front

    @property
    def facing(self) -> float:
        return self.animal.yaw

    @property
    def progress(self) -> float:
        return self.animal.progress

    @property
    def skills(self) -> Mapping[str, tuple[float, float]]:
        return {}

    def transforms(self) -> np.ndarray:
        return self.animal.herd.pose(self.animal.index)

    def plan(self, goals: np.ndarray) -> Plan:
        return self._ways.through(self.animal.position, goals)

    def go_to(self, goals: np.ndarray, speed: float, facing: float | None) -> Plan:
        plan = self.plan(goals)
        try:
            self.animal.go_to(goals, speed, facing)
        except LocomotionError as error:
            raise RuntimeInputError(str(error)) from None
        self._take_note()
        return plan

    def tick(self) -> None:
        """After the herd's."""
        self.animal.tick()
        self._take_note()

    def _take_note(self) -> None:
        """Keep the plan of a trail that has just been taken."""
        trail = self.animal.trail
        if trail is not None and trail is not self._followed:
            self._followed = trail
            plans = [way for way in self.animal.ways if isinstance(way, Plan)]
            raw, pulled = (np.concatenate([getattr(p, name) for p in plans]) for name in ("raw", "pulled"))
            self.plans.append(Plan(raw, pulled, trail.points, ()))

    def save(self) -> tuple[AnimalMemory, tuple[Plan, ...]]:
        return self.animal.save(), tuple(self.plans)

    def restore(self, state: tuple[AnimalMemory, tuple[Plan, ...]]) -> None:
        self.animal.restore(state[0])
        self.plans[:] = state[1]
        self._followed = self.animal.trail

    def state_hash(self) -> str:
        return self.animal.state_hash()
