"""Sizes of people by chance."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from locomotion.body.traits import TRAITS, chance_at
from runtime.errors import RuntimeInputError
from surefoot.numeric import is_finite

__all__ = ["Sizes"]


@dataclass(frozen=True)
class Sizes:
    """From ``least`` to ``most``, all as likely, in a world of this ``seed``."""

    least: float
    most: float
    seed: int

    @classmethod
    def checked(cls, sizes: Any, seed: int) -> "Sizes":
        """Those of ``sizes``, the least and the greatest. Raises `RuntimeInputError` for what are none."""
        _, low, high = TRAITS["size"]
        pair = tuple(sizes) if isinstance(sizes, tuple | list) else ()
        if len(pair) != 2 or not all(map(is_finite, pair)) or not low <= pair[0] <= pair[1] <= high:
            raise RuntimeInputError(
                f"sizes must be the least and the greatest, from {low:g} to {high:g}, not {sizes!r}"
            )
        return cls(float(pair[0]), float(pair[1]), seed)

    @property
    def vary(self) -> bool:
        """Whether anybody gets another size than the usual one."""
        return (self.least, self.most) != (1.0, 1.0)

    def at(self, place: np.ndarray) -> float:
        """That of a person who appears at ``place`` (3,) [m]: in steps of 1 %, beside what else is by chance
        in that person."""
        chance = chance_at(place, self.seed).spawn(1)[0]
        return round(float(chance.uniform(self.least, self.most)), 2)
