"""States in which some of those who learn begin."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Starts"]


@dataclass(frozen=True)
class Starts:
    """States from which people may begin, as in `Environment`: (k, ...) each."""

    memory: NDArray[np.float64]
    physics: NDArray[np.float64]
    sensed: NDArray[np.float64]
