"""What all skills share that were learned for a range of heights: the range, the run-up, and a control
law for each height, made when it is first asked for."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from locomotion.clips.clip import Clip
from locomotion.errors import LocomotionError
from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import RunSkill
from locomotion.saved_arrays import Slots
from locomotion.skills.kernel import FIRST_STEP, MIRROR, MIRROR_SIGN

__all__ = ["LawTables", "LearnedSkill", "tables_over_run"]


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


@lru_cache(maxsize=4)
def _clip_less_run(run: Clip, clip: Clip) -> tuple[np.ndarray, np.ndarray]:
    """A skill's clip less the run's over one cycle, (65, 39) [rad], and its rate per cycle."""
    shares = np.linspace(0.0, 1.0, 65)
    pose = clip.sample(shares) - run.sample(shares)
    rates = clip.rates(shares) * clip.duration - run.rates(shares) * run.duration
    return np.ascontiguousarray(pose), np.ascontiguousarray(rates)


def tables_over_run(
    parameters: NDArray[np.float64],
    part: dict[str, slice],
    reference: NDArray[np.float64],
    clip: Clip,
    run: RunSkill,
) -> LawTables:
    """The arguments of a skill's kernels on top of the run. part: where its blocks lie in ``parameters``;
    reference (steps, bins, sensors): expected sensors; clip: followed instead of the run's."""
    timing = np.ascontiguousarray(run.table[:, controller.parameter_slices()["timing"].start])
    pose, rates = _clip_less_run(run.clip, clip)
    rest = (np.ascontiguousarray(run.knots), timing, pose, rates, reference, MIRROR, MIRROR_SIGN)
    entry, mark = parameters[part["entry"].start], parameters[part["marks"].start]
    return LawTables(parameters, float(entry), float(mark), rest)


class _Family(Protocol):
    @property
    def range(self) -> tuple[float, float]: ...

    @property
    def stride(self) -> tuple[float, float, float]: ...


class LearnedSkill:
    """A family of laws over the height; a skill adds how it starts, ticks and falls.

    slots: what its memory may hold. over_run: whether it works on top of the run, whose step it began with is
    in its memory.
    """

    slots: Slots
    over_run = True

    def __init__(self, family: _Family, law: Callable[[float], LawTables]) -> None:
        """``law``: the kernels' arguments at a height [m] within the family's range."""
        self._family, self._law = family, law
        self._tables: dict[float, LawTables] = {}

    @property
    def heights(self) -> tuple[float, float]:
        """Least and greatest height (gap: width) [m] that it clears."""
        return self._family.range

    @property
    def stride(self) -> tuple[float, float, float]:
        """(a, lag, b) of the steps of the run-up; see `locomotion.skills.interface.ClearingSkill`."""
        return self._family.stride

    def tables(self, size: float) -> LawTables:
        """The kernels' arguments for an obstacle of ``size`` [m]; those of the nearest learned size beyond
        the ends."""
        low, high = self.heights
        size = min(max(float(size), low), high)
        if size not in self._tables:
            self._tables[size] = self._law(size)
        return self._tables[size]

    def check(self, memory: NDArray[np.float64], steps: float) -> None:
        """Raises `LocomotionError` for a ``memory`` that it cannot have after so many steps of the run."""
        self.slots.check(memory)
        if self.over_run and memory[FIRST_STEP] > steps:
            raise LocomotionError("a person clears an obstacle with a step that is still to come")

    def approach(self, size: float, depth: float = 0.0) -> tuple[float, float]:
        """(entry speed [m/s], distance [m] from the stance foot's ankle to the edge at which the skill
        begins), the same for every ``depth``."""
        tables = self.tables(size)
        return tables.entry, tables.mark
