"""Persons in a world who play recorded motion: they move as walkers do, and have postures."""

from collections.abc import Mapping
from typing import Any

import numpy as np

import navmesh
from locomotion import PERSON_RULES, Ground, LocomotionError
from locomotion.body.traits import SIZE, TRAITS, by_hand, chance_at
from locomotion.crowd.saved_state_check import check_walker
from locomotion.human.composition import checked_bravery
from locomotion.preconditions.precondition import load_preconditions
from locomotion.recorded.skeletons import LEVELS, level_number
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.nodes import can_hold, checked_node
from locomotion.recorded_people.people import RecordedPeople
from locomotion.recorded_people.person import RecordedPerson
from locomotion.recorded_people.person_state import PersonState
from locomotion.recorded_people.saved_state_check import check_recorded
from navmesh.routes.route import Route
from runtime.bodies.figure import Joints
from runtime.bodies.human_driver import HumanDriver
from runtime.bodies.joints import person_figure, person_joints
from runtime.bodies.populations import Populations
from runtime.bodies.protocol import Driver, Population, recall, saved_parts
from runtime.bodies.walkers import WalkerDriver
from runtime.errors import RuntimeInputError
from runtime.planning.level import Level
from runtime.planning.planning import Plan

__all__ = ["Recorded", "RecordedDriver", "is_recorded"]


class Recorded(Population):
    """All of them, in one crowd that avoids all others of ``populations``. ``seed``: the world's, from which
    they get what is each one's own."""

    def __init__(self, level: Level, populations: Populations, seed: int) -> None:
        self.level, self._populations, self._seed = level, populations, seed
        self._people: RecordedPeople | None = None

    @property
    def people(self) -> RecordedPeople:
        """Made with the first: worlds without any need no motions."""
        self.prepare_levels()
        assert self._people is not None
        return self._people

    def prepare_levels(self) -> None:
        if self._people is None:
            self._people = RecordedPeople(self.level.graph, ground=self.level.ground)
            self._people.crowd.expect(PERSON_RULES["radius"])  # lest a tick has to

    def spawn(self, body: str, place: np.ndarray, facing: float, radius: float) -> "RecordedDriver":
        return RecordedDriver(self, self.people.add(place, facing, 0, chance_at(place, self._seed)))

    def take_over(self, driver: HumanDriver, level: str) -> "RecordedDriver":
        """Let recorded motion go on from where a simulated person is, at a ``level`` of detail."""
        place, velocity = driver.position, driver.body.velocity[:2]
        person = self.people.add(place, driver.facing, level_number(level), chance_at(place, self._seed))
        person.set_traits(by_hand(person.row[at.TRAITS], **driver.style))
        pose, pose_rates = driver.look.drawn()
        person.go_on_from(pose, pose_rates, place, velocity)
        return RecordedDriver(self, person)

    def revive(self, body: str, state: Any) -> "RecordedDriver":
        saved = self.checked(state)[0]
        driver = RecordedDriver(self, self.people.adopt(self.people.crowd.adopt(saved.body), saved.row))
        driver.restore(state)
        return driver

    def checked(self, state: Any) -> tuple[PersonState, tuple[Plan, ...]]:
        """What `RecordedDriver.save` gave. Raises `RuntimeInputError` and `LocomotionError` for what it
        cannot have given on this level."""
        saved, plans = saved_parts(state, PersonState)
        check_walker(saved.body, self.level.graph)
        check_recorded(saved, self.people.graph, len(self.people.gaits), self.people.skills)
        return saved, plans

    def remove(self, driver: Driver) -> None:
        assert isinstance(driver, RecordedDriver)
        self.people.remove(driver.person)

    def in_the_way(self) -> np.ndarray:
        if not self._people:
            return np.empty((0, 6))
        return self._people.discs()

    def foresee(self, graph: navmesh.NodeGraph) -> None:
        if self._people is not None:
            self._people.crowd.foresee(graph)

    def change_level(self) -> None:
        if self._people is not None:
            self._people.change_level(self.level.graph, self.level.ground)

    def change_zones(self) -> None:
        self.change_level()

    def tick(self) -> None:
        if self._people:
            self._people.crowd.lead(self._populations.discs_around(self))
            self._people.tick()


class RecordedDriver(WalkerDriver):
    """A recorded person."""

    def __init__(self, population: Recorded, person: RecordedPerson) -> None:
        super().__init__(population, person.walker)
        self._population: Recorded = population
        self.person = person
        self.figure = person_figure(self._size)

    @property
    def _size(self) -> float:
        return float(self._row[at.TRAITS][SIZE])

    @property
    def simulated(self) -> RecordedPerson:
        return self.person

    def heed(self, bravery: float | None) -> None:
        """Kept for when physics takes over: recorded people clear every obstacle of their sizes."""
        try:
            if bravery is not None:
                load_preconditions()  # here, lest the tick in which physics takes over has to
            checked_bravery(bravery)
        except LocomotionError as error:
            raise RuntimeInputError(str(error)) from None

    @property
    def _row(self) -> np.ndarray:
        return self.person.row

    @property
    def status(self) -> str:
        return self.person.status

    @property
    def time(self) -> float:
        return self.person.time

    @property
    def position(self) -> np.ndarray:
        return self.person.position

    @property
    def facing(self) -> float:
        return self.person.yaw

    @property
    def left(self) -> float:
        if self.person.errand is not None and self.plans:
            return self.plans[-1].length  # it gets up first
        of = self.person.crossing
        return self.walker.left + (0.0 if of is None else of.beyond)

    @property
    def progress(self) -> float:
        length = self.plans[-1].length if self.plans else 0.0
        return float(np.clip(1.0 - self.left / length, 0.0, 1.0)) if length > 0.0 else 1.0

    @property
    def goals_left(self) -> int:
        errand = self.person.errand
        if errand is not None:
            return len(errand.goals)
        of = self.person.crossing
        if of is None:
            return super().goals_left
        return len(of.goals) + (0 if of.under_way else super().goals_left - 1)

    def way_holds(self) -> bool:
        of = self.person.crossing
        if self.person.errand is not None or (of is not None and of.under_way):
            return True
        return super().way_holds() and (of is None or of.is_there(self.walker.crowd.graph))

    @property
    def skills(self) -> Mapping[str, tuple[float, float]]:
        return self._population.people.ranges

    def _find_routes(self, goals: np.ndarray) -> list[Route]:
        return self.walker.crowd.find_routes(self.walker.index, goals, self.skills)

    @property
    def hindrance(self) -> str:
        return "it changes its posture first" if self.person.errand is not None else super().hindrance

    @property
    def detail(self) -> str:
        return LEVELS[int(self._row[at.LEVEL])]

    def draw_at(self, level: str) -> None:
        """Be drawn at another level of detail, without a jump."""
        number = level_number(level)
        if number != self._row[at.LEVEL]:
            self.person.change(lambda: self._set_level(number))

    def _set_level(self, number: int) -> None:
        self._row[at.LEVEL] = number

    @property
    def posture(self) -> str:
        return self.person.posture

    @property
    def held(self) -> tuple[str, str]:
        return self.person.held

    def held_in(self, posture: str) -> tuple[str, str]:
        return can_hold(self._population.people.graph, posture, self.held)

    def check_posture(self, posture: str, held: str, state: str) -> None:
        try:
            checked_node(self._population.people.graph, posture, held, state)
        except LocomotionError as error:
            raise RuntimeInputError(str(error)) from None

    def take(self, posture: str, held: str, state: str) -> None:
        try:
            self.person.take(posture, held, state)
        except LocomotionError as error:
            raise RuntimeInputError(str(error)) from None

    def set_style(self, traits: Mapping[str, float]) -> None:
        try:
            row = by_hand(self._row[at.TRAITS], **traits)
        except LocomotionError as error:
            raise RuntimeInputError(str(error)) from None
        if (row != self._row[at.TRAITS]).any():
            self.person.change(lambda: self.person.set_traits(row))
            self.figure = person_figure(self._size)

    @property
    def traits(self) -> Mapping[str, float]:
        return dict(zip(TRAITS, self._row[at.TRAITS].tolist(), strict=True))

    @property
    def ground(self) -> Ground | None:
        return self._population.level.ground

    @property
    def joints(self) -> Joints:
        return person_joints(self._size)

    def joint_pose(self) -> np.ndarray:
        return self.person.qpos

    def transforms(self) -> np.ndarray:
        return self._population.people.transforms(np.array([self.person.index]))[0]

    def transforms_between(self, share: float) -> np.ndarray:
        back = (share - 1.0) * self._population.people.dt
        return self._population.people.transforms(np.array([self.person.index]), back)[0]

    def save(self) -> tuple[PersonState, tuple[Plan, ...]]:  # type: ignore[override]
        return self.person.save(), tuple(self.plans)[-1:]

    def fits(self, state: Any) -> bool:
        return is_recorded(state)

    def restore(self, state: Any) -> None:
        saved, plans = self._population.checked(state)
        self.person.restore(saved)
        self.figure = person_figure(self._size)
        recall(self.plans, plans)

    def state_hash(self) -> str:
        return self.person.state_hash()


def is_recorded(state: Any) -> bool:
    """Whether ``state`` is of a recorded person."""
    return isinstance(state, tuple) and any(isinstance(part, PersonState) for part in state)
