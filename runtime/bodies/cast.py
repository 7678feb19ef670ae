"""Bodies of one population that are drawn together, frame after frame."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

__all__ = ["Cast"]


class _Drawn(Protocol):
    def transforms(self) -> np.ndarray: ...


class Cast:
    """Some bodies of a population, in order. It holds until one of the population is removed or gets another
    driver: what is the same for every frame is looked up once."""

    def __init__(self, drivers: Sequence[_Drawn]) -> None:
        self._drivers = drivers

    def transforms(self, since: np.ndarray | None, now: float) -> tuple[Sequence[int], Sequence[np.ndarray]]:
        """Which of them are due, by their place in the order, and `runtime.bodies.protocol.Driver.transforms`
        of each: all of them, or those whose turn to be drawn anew has come after the time ``since`` of each
        (n,), until ``now`` [s]; -inf for those that are due in any case."""
        return range(len(self._drivers)), [driver.transforms() for driver in self._drivers]
