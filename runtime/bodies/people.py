"""Simulated persons in a world, each with a simulation of its own."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import navmesh
from locomotion import PERSON_RULES
from locomotion.body.models import person_on
from locomotion.body.traits import SIZE, TRAITS, by_chance, chance_at
from locomotion.human.motion_start import moment_like, set_in_motion
from locomotion.human.sized_human import SizedHuman, movements_of
from locomotion.postures.step_order import AT_REST
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.person import RecordedPerson
from locomotion.rehearsal.choices import REHEARSALS
from locomotion.rehearsal.sharing import REHEARSAL_TICKS, allot
from runtime.bodies.human_driver import HumanDriver, simulated_size
from runtime.bodies.human_pool import HumanPool
from runtime.bodies.protocol import Driver, Follower, Population
from runtime.planning.level import Level
from surefoot.pausing import pause
from surefoot.workers.threads import Threads

__all__ = ["People"]

_ASKEW = 0.4  # [rad] that a body which physics takes over may face off its way
_SPOTS, _BESIDE = np.array([-0.4, 0.0, 0.4, 0.8, 1.2]), 0.15  # [m] along its way and beside it,
_UNEVEN = 0.02  # where the ground is no more than this [m] higher or lower
_HESITATES = 0.4  # [s] at most, from a stand: less than half a step


class People(Population):
    """Simulated persons. ``skills``: descriptions of those of one's own that they have besides the
    package's; ``rehearsals``: as of `Human`; ``seed`` decides how long each of them hesitates; ``walk``: one
    of `runtime.bodies.kinds.kind.WALKS`; ``rehearsal_ticks``, ``threads``: as of `runtime.World`."""

    def __init__(
        self,
        level: Level,
        skills: Sequence[Path] = (),
        rehearsals: int = REHEARSALS,
        seed: int = 0,
        walk: str = "learned",
        rehearsal_ticks: int | None = REHEARSAL_TICKS,
        threads: int = 1,
    ) -> None:
        self._level, self._seed, self._rehearsal_ticks = level, seed, rehearsal_ticks
        rehearsals = 0 if rehearsal_ticks == 0 else rehearsals
        self._pool = HumanPool(level, skills, walk, rehearsals, rehearsal_ticks is None)
        self._threads = Threads(threads)
        self._drivers: list[HumanDriver] = []

    def spawn(self, body: str, place: np.ndarray, facing: float, radius: float) -> Driver:
        driver = self._make(1.0)
        driver.body.reset(place, facing)
        chance = chance_at(place, self._seed)
        driver.hesitates = round(float(chance.uniform(0.0, _HESITATES)), 2)
        driver.human.habit = float(chance.random())
        own = by_chance(int(chance.integers(2**31)))
        driver.set_style({name: float(own[k]) for k, name in enumerate(TRAITS) if k != SIZE})
        self._drivers.append(driver)
        return driver

    def revive(self, body: str, state: Any) -> Driver:
        driver = self._make(1.0)
        driver.restore(state)  # if this raises, nobody has been added
        self._drivers.append(driver)
        return driver

    def take_over(self, person: RecordedPerson) -> HumanDriver | None:
        """Let physics go on from where recorded motion is; None while it cannot: with something in the hands,
        on uneven ground, or in a motion that the controllers do not know."""
        walker = person.walker
        speed, place = float(np.hypot(*walker.velocity)), person.position
        size = simulated_size(float(person.row[at.TRAITS][SIZE]))
        root = math.sqrt(size)
        if not person.has_free_hands or walker.status == "stuck":
            return None
        pose, pose_rates = person.qpos, person.qpos_rates
        if speed <= AT_REST:
            if walker.status == "walking":
                return None  # it waits for others
            driver = self._make(size)
            driver.body.reset(place, walker.yaw)
        else:
            moment = moment_like(person.status == "running", speed / root, pose, root * pose_rates[6:])
            heading = math.atan2(walker.velocity[1], walker.velocity[0])
            off = abs(math.remainder(heading - walker.yaw, 2.0 * math.pi))
            if (
                moment is None
                or walker.status != "walking"
                or off > _ASKEW
                or not self._level_at(place, heading)
            ):
                return None
            driver = self._make(size)
            set_in_motion(driver.human, moment, pose[:2] / size, float(place[2]) / size, heading)
        driver.human.habit = float(chance_at(place, self._seed).random())
        driver.look.fade(pose, pose_rates)
        self._drivers.append(driver)
        return driver

    def _level_at(self, place: np.ndarray, heading: float) -> bool:
        """Whether the ground is level around ``place`` (3,) and on the first steps towards ``heading``."""
        ahead = np.array([math.cos(heading), math.sin(heading)])
        spots = place + np.zeros((_SPOTS.size * 3, 3))
        across = np.array([-ahead[1], ahead[0]])
        spots[:, :2] += (
            _SPOTS[:, None, None] * ahead + np.array([-_BESIDE, 0.0, _BESIDE])[:, None] * across
        ).reshape(-1, 2)
        spots[:, 2] += 0.5
        heights = self._level.ground.surface_below(spots)[0]
        return bool((np.abs(heights - place[2]) <= _UNEVEN).all())

    def _make(self, size: float) -> HumanDriver:
        return HumanDriver(self._pool, self._level, SizedHuman(self._pool.take(size), size))

    def retire(self, driver: Driver) -> None:
        """Have one less, whose body nobody holds any more: the next one gets it, as good as new."""
        assert isinstance(driver, HumanDriver)
        self.remove(driver)
        self._pool.put_back(driver.human, driver.body.size)

    def remove(self, driver: Driver) -> None:
        self._drivers = [each for each in self._drivers if each is not driver]

    def in_the_way(self) -> np.ndarray:
        bodies = [driver.body for driver in self._drivers]
        rows = np.empty((len(bodies), 6))
        rows[:, :3], velocities = movements_of(bodies)
        rows[:, 3:5] = velocities[:, :2]
        rows[[body.human.held for body in bodies], 3:5] = 0.0
        rows[:, 5] = PERSON_RULES["radius"]
        return rows

    def followers(self) -> Sequence[Follower]:
        return self._drivers

    def remember(self) -> None:
        for driver in self._drivers:
            driver.look.remember()

    def foresee(self, graph: navmesh.NodeGraph) -> None:
        level = Level.of(graph)
        for size in {driver.body.size for driver in tuple(self._drivers)}:
            person_on(level.ground_for(size))

    def change_level(self) -> None:
        self._pool.forget()
        for driver in self._drivers:
            driver.human.change_ground(self._level.ground_for(driver.body.size))
            driver.plan_again()

    def change_zones(self) -> None:
        for driver in self._drivers:
            driver.plan_again()

    def tick(self) -> None:
        for driver in self._drivers:
            driver.go_on_planning()
        bodies = [driver.body for driver in self._drivers]
        humans = [body.human for body in bodies]
        allotted = None if self._rehearsal_ticks is None else allot(humans, self._rehearsal_ticks)

        def go_on(number: int) -> None:
            bodies[number].tick(since_foresees=allotted is not None)
            if allotted is not None and allotted[number]:
                humans[number].look_ahead(allotted[number])
            pause()

        self._threads.each(go_on, len(humans))
