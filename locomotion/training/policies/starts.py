"""States in which some of those who learn begin."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Starts", "together"]


@dataclass(frozen=True)
class Starts:
    """States from which people may begin, as in `Environment`: (k, ...) each."""

    memory: NDArray[np.float64]
    physics: NDArray[np.float64]
    sensed: NDArray[np.float64]


def together(first: Starts, second: Starts | None) -> Starts:
    """As many states of one kind as of the other: some of the rarer ones more than once."""
    if second is None:
        return first
    longest = np.arange(max(len(first.memory), len(second.memory)))
    some = [
        {name: rows[longest % len(rows)] for name, rows in vars(each).items()} for each in (first, second)
    ]
    return Starts(**{name: np.concatenate([each[name] for each in some]) for name in some[0]})
