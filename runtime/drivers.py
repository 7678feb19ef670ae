"""What an agent asks of its body, whatever kind that is, and the kinds there are.

A `Population` makes and advances all bodies of its kinds in a world: people one by one, animals in one call.
A `Driver` is one body of it.
"""

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Protocol

import mujoco
import numpy as np

from locomotion import PERSON_RULES, Human, HumanState, LocomotionError
from locomotion.clearing import HEIGHT_TOLERANCE
from locomotion.events import Event
from locomotion.giving_way import Course
from locomotion.quadruped import BODY_NAMES, Animal, AnimalMemory, Body, Herd, Place, check_places, load_body
from locomotion.quadruped import layout as at
from locomotion.quadruped.footprint import at_place
from runtime.animal_figure import animal_figure
from runtime.errors import RuntimeInputError
from runtime.figure import Figure
from runtime.level import Level
from runtime.planning import Plan, make_plan, way_holds
from runtime.pose import between

__all__ = [
    "BODIES",
    "PLANS_KEPT",
    "AnimalDriver",
    "Driver",
    "HumanDriver",
    "Pack",
    "People",
    "Population",
    "radius_of",
    "recall",
]

BODIES = ("human", "walker", *BODY_NAMES)
"""What `World.spawn` can make."""
PLANS_KEPT = 256
"""Plans that an agent remembers; a pursuer makes many."""


def radius_of(body: str) -> float:
    """[m] that the graph's queries keep free around a body of `BODIES`; of a walker, by default."""
    return PERSON_RULES["radius"] if body in ("human", "walker") else load_body(body).radius


class Driver(Protocol):
    """One body. ``events`` is what happened to it, in order, until its agent takes them; ``plans`` the last
    paths it was given or made."""

    figure: Figure
    radius: float
    events: list[Event]
    plans: deque[Plan]

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
    def transforms_between(self, share: float) -> np.ndarray:
        """A ``share`` (0 to 1) of the way from where it was when `Population.remember` was called last."""
        ...

    def plan(self, goals: np.ndarray) -> Plan:
        """The way through ``goals`` (k, 3), not taken. Raises `runtime.planning.NoWay`."""
        ...

    def go_to(self, goals: np.ndarray, speed: float, facing: float | None) -> Plan:
        """Take the way through ``goals``. Raises `runtime.planning.NoWay`."""
        ...

    @property
    def goals_left(self) -> int:
        """How many of the goals of `go_to` are still before it, at least one while it is on its way."""
        ...

    def way_holds(self) -> bool:
        """Of one on its way: whether the rest of it can be gone on the level as it is now. True for one that
        has lost its footing: another way is no help."""
        ...

    def stop(self) -> None:
        """Give up its way and come to a stand."""
        ...

    def save(self) -> Any: ...
    def restore(self, state: Any) -> None: ...
    def state_hash(self) -> str: ...


class Follower(Protocol):
    """A body that follows a path and gives way to others."""

    @property
    def pace(self) -> float:
        """Share of its speed at which it goes at present."""
        ...

    def course(self) -> Course | None:
        """What it is about to do, None where that cannot be changed."""
        ...

    def give_way(self, pace: float, shift: np.ndarray | None) -> None:
        """Go at another pace; with ``shift`` (k, 2) [m] change its path by it, as its course tells it."""
        ...


class Population(Protocol):
    """All bodies of some kinds in a world."""

    bodies: tuple[str, ...]

    def spawn(self, body: str, place: np.ndarray, facing: float, radius: float) -> Driver:
        """``radius`` [m] is `radius_of` the body, or what was asked for a walker."""
        ...

    def revive(self, body: str, state: Any) -> Driver:
        """A body where and as it was when its driver was saved."""
        ...

    def remove(self, driver: Driver) -> None: ...
    def in_the_way(self) -> np.ndarray:
        """Discs (k, 6) that cover them on the ground, as `locomotion.crowd.Crowd.lead` takes them; as many
        for each."""
        ...

    def followers(self) -> Sequence[Follower]:
        """All of them, if they follow paths; nobody otherwise."""
        ...

    def remember(self) -> None:
        """Keep where all are, for `Driver.transforms_between`."""
        ...

    def change_level(self) -> None:
        """Go on on the level as it is now, where all are."""
        ...

    def tick(self) -> None:
        """Advance all by 10 ms."""
        ...


class People:
    """Simulated persons."""

    bodies: tuple[str, ...] = ("human",)

    def __init__(self, level: Level) -> None:
        self._level = level
        self._drivers: list[HumanDriver] = []

    def spawn(self, body: str, place: np.ndarray, facing: float, radius: float) -> Driver:
        human = Human(self._level.ground)
        human.reset(place, facing)
        return self._add(human)

    def revive(self, body: str, state: Any) -> Driver:
        driver = self._add(Human(self._level.ground))
        driver.restore(state)
        return driver

    def _add(self, human: Human) -> "HumanDriver":
        self._drivers.append(HumanDriver(self._level, human))
        return self._drivers[-1]

    def remove(self, driver: Driver) -> None:
        self._drivers = [each for each in self._drivers if each is not driver]

    def in_the_way(self) -> np.ndarray:
        humans = [driver.human for driver in self._drivers]
        rows = [[*each.position, *each.velocity[:2], PERSON_RULES["radius"]] for each in humans]
        return np.array(rows).reshape(-1, 6)

    def followers(self) -> Sequence[Follower]:
        return self._drivers

    def remember(self) -> None:
        for driver in self._drivers:
            driver.before = driver.human.qpos

    def change_level(self) -> None:
        for driver in self._drivers:
            driver.human.change_ground(self._level.ground)

    def tick(self) -> None:
        for driver in self._drivers:
            driver.human.tick()


class HumanDriver:
    """A person. ``before``: (46,) its joints as they were when `People.remember` was called, or None."""

    def __init__(self, level: Level, human: Human) -> None:
        self._level, self.human = level, human
        self.radius = radius_of("human")
        self.figure = Figure.from_model(human.model)
        self.events = human.events
        self.plans: deque[Plan] = deque(maxlen=PLANS_KEPT)
        self.before: np.ndarray | None = None

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
        return self.human.body_transforms()[1 : 1 + len(self.figure.bodies)]

    def transforms_between(self, share: float) -> np.ndarray:
        if self.before is None:
            return self.transforms()
        model, joints = self.human.model, self.human.data.qpos
        now, change = joints.copy(), np.empty(model.nv)
        mujoco.mj_differentiatePos(model, change, 1.0, self.before, now)
        joints[:] = self.before
        mujoco.mj_integratePos(model, joints, change, share)
        transforms = self.transforms()
        joints[:] = now
        return transforms

    def plan(self, goals: np.ndarray) -> Plan:
        velocity = self.human.velocity[:2]
        moving = velocity if np.linalg.norm(velocity) > 0.5 else None
        radius = PERSON_RULES["radius"]
        return make_plan(self._level.graph, self.position, list(goals), radius, self.skills, moving)

    def go_to(self, goals: np.ndarray, speed: float, facing: float | None) -> Plan:
        if facing is not None:
            raise RuntimeInputError("a human cannot turn to a facing at its goal yet; leave it out")
        if self.human.status == "fallen":
            raise RuntimeInputError("it has fallen and cannot go anywhere")
        plan = self.plan(goals)
        self.human.follow(plan.points, speed, plan.obstacles)
        self.plans.append(plan)
        return plan

    @property
    def goals_left(self) -> int:
        return max(sum(end > self.human.arc_length for end in self.plans[-1].ends), 1)

    def way_holds(self) -> bool:
        return way_holds(self._level.graph, self.plans[-1], self.radius, self.human.arc_length)

    def stop(self) -> None:
        self.human.stop()

    @property
    def pace(self) -> float:
        return self.human.pace

    def course(self) -> Course | None:
        return self.human.course()

    def give_way(self, pace: float, shift: np.ndarray | None) -> None:
        self.human.give_way(pace, shift)
        if shift is not None:
            self.plans[-1] = replace(self.plans[-1], points=self.human.path)

    def save(self) -> tuple[HumanState, tuple[Plan, ...]]:
        return self.human.save_state(), tuple(self.plans)[-1:]

    def restore(self, state: tuple[HumanState, tuple[Plan, ...]]) -> None:
        self.human.restore_state(state[0])
        recall(self.plans, state[1])
        self.before = None

    def state_hash(self) -> str:
        return self.human.state_hash()


class Pack:
    """Dogs, cats and horses, in one herd."""

    bodies: tuple[str, ...] = BODY_NAMES

    def __init__(self, level: Level) -> None:
        self._level = level
        self._herd = Herd(level.ground)
        self._drivers: list[AnimalDriver] = []
        self._before = _Remembered()

    def spawn(self, body: str, place: np.ndarray, facing: float, radius: float) -> Driver:
        kind = load_body(body)
        stands = check_places(
            at_place(Place(float(place[0]), float(place[1]), float(place[2]), facing)),
            kind,
            self._herd.ground,
        )
        if not stands.free:
            what = "finds no ground" if stands.part == "ground" else f"has no room for its {stands.part}"
            raise RuntimeInputError(f"at {place.round(2).tolist()} facing {facing:.2f} a {body} {what}")
        return self._add(self._herd.add(kind, place, facing))

    def revive(self, body: str, state: Any) -> Driver:
        driver = self._add(self._herd.adopt(load_body(body), state[0].herd))
        driver.restore(state)
        return driver

    def _add(self, index: int) -> "AnimalDriver":
        self._drivers.append(AnimalDriver(self._level, self._herd, index, self._before))
        return self._drivers[-1]

    def remove(self, driver: Driver) -> None:
        index = self._drivers.index(driver)  # type: ignore[arg-type]
        del self._drivers[index]
        self._herd.remove(index)
        for later in self._drivers[index:]:
            later.animal.index -= 1
        self._before.forget()

    def in_the_way(self) -> np.ndarray:
        return self._herd.discs()

    def followers(self) -> Sequence[Follower]:
        return self._drivers

    def remember(self) -> None:
        self._before.poses = self._herd.poses.copy()

    def change_level(self) -> None:
        self._herd.change_ground(self._level.ground)

    def tick(self) -> None:
        self._herd.tick()
        for driver in self._drivers:
            driver.animal.tick()


class _Ways:
    """`locomotion.quadruped.Planner` on a graph."""

    def __init__(self, level: Level, body: Body) -> None:
        self._level, self._body = level, body

    def through(self, start: np.ndarray, goals: np.ndarray, direction: np.ndarray | None = None) -> Plan:
        return make_plan(
            self._level.graph, start, list(goals), self._body.radius, {}, direction, self._body.smoothing
        )

    def way(self, start: np.ndarray, goal: np.ndarray, direction: np.ndarray) -> Plan:
        return self.through(start, goal[None], direction)

    def room_to_turn(self, points: np.ndarray, length: float) -> np.ndarray:
        return self._level.graph.room_to_turn(points, length)


class _Remembered:
    """The herd's poses when `Pack.remember` was called; those of animals that came later are missing."""

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        self.poses = np.zeros((0, 7))


class AnimalDriver:
    """One animal of a herd."""

    def __init__(self, level: Level, herd: Herd, index: int, before: _Remembered) -> None:
        self._before = before
        self._level = level
        self._ways = _Ways(level, herd.bodies[index])
        self.animal = Animal(herd, index, self._ways)
        self.radius = self.animal.body.radius
        self.figure = animal_figure(self.animal.body)
        self.events = self.animal.events
        self.plans: deque[Plan] = deque(maxlen=PLANS_KEPT)
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

    def transforms_between(self, share: float) -> np.ndarray:
        now, end = self.transforms(), self.animal.herd.pose_start[self.animal.index + 1]
        before = self._before.poses[end - len(now) : end]
        return between(before, now, share) if len(before) == len(now) else now

    def plan(self, goals: np.ndarray) -> Plan:
        return self._ways.through(self.animal.position, goals)

    def go_to(self, goals: np.ndarray, speed: float, facing: float | None) -> Plan:
        plan = self.plan(goals)
        try:
            self.animal.go_to(goals, speed, facing)
        except LocomotionError as error:
            raise RuntimeInputError(str(error)) from None
        self.take_note()
        return plan

    @property
    def goals_left(self) -> int:
        return self.animal.goals_left

    def way_holds(self) -> bool:
        animal = self.animal
        if not animal.herd.stands_on_ground(animal.index) or not animal.following:
            return True
        st = animal.herd.state[animal.index]
        return st[at.NO_GROUND] == 0.0 and way_holds(
            self._level.graph, self.plans[-1], self.radius, st[at.FRONT_ARC]
        )

    def stop(self) -> None:
        self.animal.stop()

    @property
    def pace(self) -> float:
        return float(self.animal.herd.state[self.animal.index, at.PACE])

    def course(self) -> Course | None:
        return self.animal.course()

    def give_way(self, pace: float, shift: np.ndarray | None) -> None:
        self.animal.give_way(pace, shift)
        self.take_note()

    def take_note(self) -> None:
        """Keep the plan of a trail that has just been taken, if there is one; an event says that it has."""
        trail = self.animal.trail
        if trail is not None and trail is not self._followed:
            self._followed = trail
            plans = [way for way in self.animal.ways if isinstance(way, Plan)]
            raw, pulled = (np.concatenate([getattr(p, name) for p in plans]) for name in ("raw", "pulled"))
            self.plans.append(Plan(raw, pulled, trail.points, ()))

    def save(self) -> tuple[AnimalMemory, tuple[Plan, ...]]:
        return self.animal.save(), tuple(self.plans)[-1:]

    def restore(self, state: tuple[AnimalMemory, tuple[Plan, ...]]) -> None:
        self.animal.restore(state[0])
        recall(self.plans, state[1])
        self._before.forget()
        self._followed = self.animal.trail

    def state_hash(self) -> str:
        return self.animal.state_hash()


def recall(plans: deque[Plan], saved: tuple[Plan, ...]) -> None:
    """Make ``plans`` those that were saved."""
    plans.clear()
    plans.extend(saved)
