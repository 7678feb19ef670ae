"""All populations of a world."""

import numpy as np

from runtime.bodies.populations import Populations
from runtime.bodies.protocol import Driver, Population


class Walks(Population):
    """One body that goes 1 m in a tick, and notes where all others are. ``asked``: how often where it is."""

    def __init__(self, all_of_them: Populations, at: float) -> None:
        self._all, self.at, self.asked = all_of_them, at, 0
        self.saw: list[float] = []

    def in_the_way(self) -> np.ndarray:
        self.asked += 1
        return np.full((1, 6), self.at)

    def tick(self) -> None:
        self.saw = self._all.discs_around(self)[:, 0].tolist()
        self.at += 1.0

    def spawn(self, body: str, place: np.ndarray, facing: float, radius: float) -> Driver:
        raise NotImplementedError

    def revive(self, body: str, state: object) -> Driver:
        raise NotImplementedError

    def remove(self, driver: Driver) -> None:
        raise NotImplementedError

    def change_level(self) -> None:
        raise NotImplementedError


def test_each_sees_where_all_others_are_by_now():
    them = Populations()
    them.extend(Walks(them, at) for at in (10.0, 20.0, 30.0, 40.0))
    for ticks in range(3):
        them.tick()
        for number, one in enumerate(them):
            assert isinstance(one, Walks)
            expected = [10.0 * (k + 1) + ticks + (k < number) for k in range(4) if k != number]
            assert one.saw == expected
    before = [one.asked for one in them if isinstance(one, Walks)]
    them.tick()
    asked = [one.asked - count for one, count in zip(them, before, strict=True) if isinstance(one, Walks)]
    assert asked == [1, 2, 2, 1]  # those in the middle before and after they have moved


def test_who_has_been_moved_between_ticks_is_seen_there():
    them = Populations()
    first, second = Walks(them, 1.0), Walks(them, 5.0)
    them.extend([first, second])
    them.tick()
    second.at = 9.0
    them.tick()
    assert first.saw == [9.0]


def test_one_alone_sees_nobody():
    them = Populations()
    them.append(Walks(them, 1.0))
    assert them.discs_around(them[0]).shape == (0, 6)
