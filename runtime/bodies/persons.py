"""All persons of a world, whatever moves them: physics near who looks on, recorded motion farther off."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from locomotion.human.motion_start import moments
from locomotion.recorded.skeletons import LEVELS
from runtime.bodies.cast import Cast
from runtime.bodies.human_driver import HumanDriver
from runtime.bodies.people import People
from runtime.bodies.protocol import Driver, Population
from runtime.bodies.recorded import Recorded, RecordedDriver, is_recorded

__all__ = ["Persons"]


class Persons(Population):
    """``physical`` and ``recorded``: one population for each. Who goes over from one to the other gets
    another driver."""

    def __init__(self, physical: People, recorded: Recorded) -> None:
        self.physical, self.recorded = physical, recorded

    def spawn(self, body: str, place: np.ndarray, facing: float, radius: float) -> Driver:
        return self.physical.spawn(body, place, facing, radius)

    def spawn_recorded(
        self, body: str, place: np.ndarray, facing: float, radius: float, level: str
    ) -> RecordedDriver:
        """As `spawn`, played at a ``level`` of detail of recorded motion."""
        driver = self.recorded.spawn(body, place, facing, radius)
        driver.draw_at(level)
        return driver

    def revive(self, body: str, state: Any) -> Driver:
        return self._home(is_recorded(state)).revive(body, state)

    def remove(self, driver: Driver) -> None:
        self._home(isinstance(driver, RecordedDriver)).remove(driver)

    def _home(self, recorded: bool) -> Population:
        return self.recorded if recorded else self.physical

    def parts(self) -> Sequence[Population]:
        return self.physical, self.recorded

    def in_the_way(self) -> np.ndarray:
        return np.concatenate([part.in_the_way() for part in self.parts()])

    def change_level(self) -> None:
        for part in self.parts():
            part.change_level()

    def change_zones(self) -> None:
        for part in self.parts():
            part.change_zones()

    def tick(self) -> None:
        for part in self.parts():
            part.tick()

    def cast(self, drivers: Sequence[Driver]) -> Cast:
        return _CastOfPersons(drivers, self.recorded)

    def prepare_levels(self) -> None:
        moments()
        self.recorded.prepare_levels()

    def at_level(self, driver: Driver, level: str, at_once: bool = False) -> Driver | None:
        if isinstance(driver, RecordedDriver) and level in LEVELS:
            driver.draw_at(level)
            return driver
        if level == driver.detail:
            return driver
        self.prepare_levels()  # in this call: the change itself may come later, in a tick
        taken: Driver | None = None
        if isinstance(driver, HumanDriver):
            if not (at_once or driver.on_its_feet):
                return None
            taken = self.recorded.take_over(driver, level)
        elif isinstance(driver, RecordedDriver):
            taken = self.physical.take_over(driver.person)
        if taken is not None:
            taken.plans.extend(driver.plans)
            if isinstance(driver, HumanDriver):
                self.physical.retire(driver)
            else:
                self.recorded.remove(driver)
        return taken


class _CastOfPersons(Cast):
    """Those who play recorded motion are posed in one call."""

    def __init__(self, drivers: Sequence[Driver], recorded: Recorded) -> None:
        super().__init__(drivers)
        self._recorded = recorded
        played = [
            (k, each.person.index) for k, each in enumerate(drivers) if isinstance(each, RecordedDriver)
        ]
        self._played, self._rows = np.array(played, np.int64).reshape(-1, 2).T
        self._simulated = [k for k, each in enumerate(drivers) if not isinstance(each, RecordedDriver)]

    def transforms(self, since: np.ndarray | None, now: float) -> tuple[Sequence[int], Sequence[np.ndarray]]:
        which, places = self._simulated, [self._drivers[k].transforms() for k in self._simulated]
        if not len(self._played):
            return which, places
        people, played, rows = self._recorded.people, self._played, self._rows
        if since is not None:
            due = people.due(rows, since[played], now)
            played, rows = played[due], rows[due]
        return [*which, *played.tolist()], [*places, *people.transforms(rows)]
