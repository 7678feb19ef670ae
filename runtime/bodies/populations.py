"""All populations of a world, in the order in which they are advanced."""

import numpy as np

from runtime.bodies.protocol import Population
from surefoot.pausing import pause

__all__ = ["Populations"]


class Populations(list[Population]):
    """Those of a world. Several go by where all others are, who are asked once in each tick."""

    def __init__(self) -> None:
        super().__init__()
        self._discs: dict[Population, np.ndarray] = {}

    def tick(self) -> None:
        """Advance all by 10 ms."""
        self._discs.clear()
        for population in self:
            population.tick()
            self._discs.pop(population, None)
            pause()

    def discs_around(self, population: Population) -> np.ndarray:
        """(k, 6) the discs of all others than ``population``, which asks in its `Population.tick`; as of
        `Population.in_the_way`."""
        others = [each for each in self if each is not population]
        for each in others:
            if each not in self._discs:
                self._discs[each] = each.in_the_way()
        return np.concatenate([np.empty((0, 6)), *(self._discs[each] for each in others)])
