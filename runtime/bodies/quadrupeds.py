"""Dogs, cats and horses in a world, all in one herd."""

from collections import deque
from collections.abc import Sequence
from typing import Any

import numpy as np

from locomotion import LocomotionError
from locomotion.avoidance.yielding import Course
from locomotion.quadruped import (
    Animal,
    AnimalMemory,
    Body,
    Herd,
    NoTrail,
    Place,
    check_places,
    load_body,
)
from locomotion.quadruped import layout as at
from locomotion.quadruped.course_for_others import head_length
from locomotion.quadruped.footprint import at_place
from locomotion.quadruped.manoeuvres import prepare_moves
from locomotion.quadruped.saved_state_check import check_animal
from runtime.bodies.animal_figure import animal_figure
from runtime.bodies.pose import between
from runtime.bodies.protocol import PLANS_KEPT, Driver, Follower, Population, recall, saved_parts
from runtime.errors import RuntimeInputError
from runtime.planning.level import Level
from runtime.planning.planning import (
    Beginning,
    NoWay,
    Plan,
    Way,
    find_way,
    make_plan,
    pulled_plan,
    way_holds,
)
from runtime.traffic.traffic import Traffic

__all__ = ["AnimalDriver", "Pack"]


class Pack(Population):
    """Dogs, cats and horses, in one herd, who let ``traffic`` tell them who is around. ``seed``: the world's,
    from which each has habits of its own."""

    def __init__(self, level: Level, traffic: Traffic, seed: int) -> None:
        self._level, self._traffic, self._seed = level, traffic, seed
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
        return self._add(self._herd.add(kind, place, facing, self._seed))

    def revive(self, body: str, state: Any) -> Driver:
        kind = load_body(body)
        driver = self._add(self._herd.adopt(kind, _checked(state, kind)[0].herd))
        driver.restore(state)
        return driver

    def _add(self, index: int) -> "AnimalDriver":
        prepare_moves(self._herd.bodies[index])
        self._drivers.append(AnimalDriver(self._level, self._herd, index, self._before, self._traffic))
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


def _checked(state: Any, body: Body) -> tuple[AnimalMemory, tuple[Plan, ...]]:
    """What `AnimalDriver.save` gave. Raises `RuntimeInputError` and `LocomotionError` for what it cannot have
    given."""
    memory, plans = saved_parts(state, AnimalMemory)
    if not all(isinstance(way, Plan) for way in memory.ways):
        raise RuntimeInputError("the ways of an animal are no plans")
    check_animal(memory, body)
    if memory.phase == "following" and not plans:
        raise RuntimeInputError("an animal follows a trail without a plan")
    return memory, plans


class _Ways:
    """`locomotion.quadruped.Planner` on a graph."""

    def __init__(self, level: Level, body: Body) -> None:
        self._level, self._body = level, body

    def through(self, start: np.ndarray, goals: np.ndarray, direction: np.ndarray | None = None) -> Plan:
        return make_plan(
            self._level.graph,
            Beginning(start, direction),
            list(goals),
            self._body.radius,
            {},
            self._body.smoothing,
        )

    def way(self, start: np.ndarray, goal: np.ndarray, direction: np.ndarray) -> Plan:
        return self.through(start, goal[None], direction)

    def leads(self, start: np.ndarray, goal: np.ndarray) -> bool:
        route = self._level.graph.find_path(start, goal, radius=self._body.radius)
        return route.status == "complete" and len(route.waypoints) > 1

    def routes(self, start: np.ndarray, goals: np.ndarray) -> Way:
        """What `through` smooths. Raises `NoWay` where that does."""
        return find_way(self._level.graph, Beginning(start), list(goals), self._body.radius, {})

    def room_to_turn(self, points: np.ndarray, length: float) -> np.ndarray:
        return self._level.graph.room_to_turn(points, length)


class _Remembered:
    """The herd's poses when `Pack.remember` was called; those of animals that came later are missing."""

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        self.poses = np.zeros((0, 7))


class AnimalDriver(Driver):
    """One animal of a herd."""

    def __init__(self, level: Level, herd: Herd, index: int, before: _Remembered, traffic: Traffic) -> None:
        self._before = before
        self._level = level
        self._ways = _Ways(level, herd.bodies[index])
        self.animal = Animal(herd, index, self._ways, lambda: traffic.around(self))
        self.radius = self.animal.body.radius
        self.figure = animal_figure(self.animal.body)
        self.events = self.animal.events
        self.plans: deque[Plan] = deque(maxlen=PLANS_KEPT)
        self._followed = self.animal.trail

    @property
    def simulated(self) -> Animal:
        return self.animal

    @property
    def follower(self) -> Follower:
        return self

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
    def left(self) -> float:
        length = self.plans[-1].length if self.plans else 0.0
        return (1.0 - self.progress) * length

    @property
    def hindrance(self) -> str:
        return "others are in its way" if self.animal.gives_way else "it makes no headway"

    def transforms(self) -> np.ndarray:
        return self.animal.herd.pose(self.animal.index)

    def transforms_between(self, share: float) -> np.ndarray:
        now, end = self.transforms(), self.animal.herd.pose_start[self.animal.index + 1]
        before = self._before.poses[end - len(now) : end]
        return between(before, now, share) if len(before) == len(now) else now

    def plan(self, goals: np.ndarray) -> Plan:
        return self._ways.through(self.animal.position, goals)

    def go_to(self, goals: np.ndarray, speed: float, facing: float | None) -> Plan:
        way, before = self._ways.routes(self.animal.position, goals), self._followed
        try:
            self.animal.go_to(goals, speed, facing)
        except NoTrail as error:
            raise NoWay(len(goals) - 1, str(error)) from None
        except LocomotionError as error:
            raise RuntimeInputError(str(error)) from None
        self.take_note()
        if len(goals) > 1 or self._followed is before:  # a trail leads to the first goal, or not there yet
            return pulled_plan(way)
        return self.plans[-1]

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

    @property
    def reach(self) -> float:
        body = self.animal.body
        return head_length(body) - body.spine.length

    def course(self) -> Course | None:
        return self.animal.course()

    def foretold(self) -> np.ndarray:
        return self.animal.foretold()

    def give_way(self, pace: float, shift: np.ndarray | None) -> None:
        self.animal.give_way(pace, shift)
        self.take_note()

    @property
    def waited(self) -> float | None:
        return self.animal.waited

    def way_back(self) -> np.ndarray | None:
        return self.animal.way_back()

    @property
    def backs(self) -> float:
        return self.animal.backs

    @property
    def length(self) -> float:
        return self.animal.body.spine.length

    def make_room(self, far: float) -> None:
        self.animal.make_room(far)

    def give_up(self, reason: str | None = None) -> None:
        self.animal.give_up()

    def end_in(self, ahead: float) -> None:
        self.animal.end_in(ahead)

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

    def restore(self, state: Any) -> None:
        memory, plans = _checked(state, self.animal.body)
        self.animal.restore(memory)
        recall(self.plans, plans)
        self._before.forget()
        self._followed = self.animal.trail

    def state_hash(self) -> str:
        return self.animal.state_hash()
