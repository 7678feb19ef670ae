"""What skills that were learned over the height of the obstacle have in common as
`locomotion.clearing.ClearingSkill`s: their range, their run-up, and a law per height, made once."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from numpy.typing import NDArray

__all__ = ["LawTables", "LearnedSkill"]


@dataclass(frozen=True)
class LawTables:
    """A skill's law at one height, ready for the kernels.

    parameters: (p,) float64. entry: wanted entry speed [m/s]. mark: distance [m] from the stance foot to the
    edge at which the skill begins. rest: the arguments of the skill's tick between the parameters and
    ``memory``.
    """

    parameters: NDArray
    entry: float
    mark: float
    rest: tuple[NDArray, ...]


class _Family(Protocol):
    @property
    def range(self) -> tuple[float, float]: ...

    @property
    def stride(self) -> tuple[float, float, float]: ...


class LearnedSkill:
    """A family of laws over the height; a skill adds how it starts, ticks and falls."""

    def __init__(self, family: _Family, law: Callable[[float], LawTables]) -> None:
        """``law``: the kernels' arguments at a height [m] within the family's range."""
        self._family, self._law = family, law
        self._tables: dict[float, LawTables] = {}

    @property
    def heights(self) -> tuple[float, float]:
        """Least and greatest height [m] that it clears."""
        return self._family.range

    @property
    def stride(self) -> tuple[float, float, float]:
        """(a, lag, b) of the steps of the run-up; see `locomotion.clearing.ClearingSkill`."""
        return self._family.stride

    def tables(self, height: float) -> LawTables:
        """The kernels' arguments for an obstacle of ``height`` [m]; the nearest learned height beyond the
        ends."""
        low, high = self.heights
        height = min(max(float(height), low), high)
        if height not in self._tables:
            self._tables[height] = self._law(height)
        return self._tables[height]

    def approach(self, height: float) -> tuple[float, float]:
        """(entry speed [m/s], distance [m] from the stance foot's ankle to the edge at which the skill
        begins)."""
        tables = self.tables(height)
        return tables.entry, tables.mark
