"""A skill learned at several heights: parameters over the height, on disk and in between."""

import math
import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.interpolate import RBFInterpolator

from locomotion.body.learned_file import RELEARN, SkillHeader, learned_numbers, read_skill
from locomotion.body.person import person_digest
from locomotion.errors import LocomotionError
from surefoot.files.archive import write_archive
from surefoot.files.schema import Rising, Schema

__all__ = ["SkillFamily", "family_file", "load_family", "smoothest"]

_VERSION = 1


@dataclass(frozen=True)
class SkillFamily:
    """A family of control laws over the height of the obstacle.

    Attributes:
        kind: what the file says it is, such as "drop-roll skill".
        heights: (k,) float64, increasing heights [m] at which parameters were learned.
        table: (k, p) float64, their parameters.
        references: (k, bins, sensors) float64, expected sensors.
        stride: (a, lag, b) of the steps of the run-up, see
            `locomotion.skills.interface.ClearingSkill.stride`.
        run: digest of the running skill that it was learned on.
        meta: what made it.
    """

    kind: str
    heights: np.ndarray
    table: np.ndarray
    references: np.ndarray
    stride: tuple[float, float, float]
    run: str
    meta: dict[str, Any] = field(default_factory=dict)

    @property
    def range(self) -> tuple[float, float]:
        """Least and greatest height [m]."""
        return float(self.heights[0]), float(self.heights[-1])

    def at(self, height: float) -> tuple[np.ndarray, np.ndarray]:
        """Parameters (p,) and expected sensors (bins, sensors) at ``height`` [m]; `LocomotionError` outside
        of `range` (2 cm are let pass)."""
        low, high = self.range
        if not (math.isfinite(height) and low - 0.02 <= height <= high + 0.02):
            raise LocomotionError(
                f"{self.kind}: {height} m was not learned; heights from {low:g} to {high:g} m are"
            )
        at = min(max(height, low), high)
        return smoothest(self.heights, self.table, at), smoothest(self.heights, self.references, at)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the family for the present person; the file appears whole or not at all."""
        header = {"person": person_digest(), "run": self.run, "stride": list(self.stride), "meta": self.meta}
        arrays = {"heights": self.heights, "table": self.table, "references": self.references}
        write_archive(path, self.kind, _VERSION, header, arrays)


def smoothest(heights: np.ndarray, values: np.ndarray, height: float) -> np.ndarray:
    """``values`` (k, ...) at ``height``: biharmonic spline r plus a linear term (equation 7 of "Terrain
    Runner"), which in one dimension is piecewise linear."""
    if len(heights) == 1:
        return values[0].copy()
    spline = RBFInterpolator(heights[:, None], values.reshape(len(heights), -1), kernel="linear", degree=1)
    return spline([[height]])[0].reshape(values.shape[1:])


class _FamilyHeader(SkillHeader):
    run: str = ""
    stride: tuple[float, float, float]


def family_file(kind: str, width: int, sensed: tuple[int, int]) -> Schema[_FamilyHeader]:
    """What a file holds with a family of ``width`` parameters and references of the shape ``sensed``."""
    arrays = {
        "heights": Rising("heights", low=0.0, high=10.0),
        "table": learned_numbers("heights", width),
        "references": learned_numbers("heights", *sensed),
    }
    return Schema(kind, _VERSION, _FamilyHeader, arrays, RELEARN)


def load_family(path: str | os.PathLike[str], kind: str, width: int, sensed: tuple[int, int]) -> SkillFamily:
    """Read a family, see `family_file`; `LocomotionError` if it is missing, cut off, of another version or of
    another person."""
    header, arrays = read_skill(path, family_file(kind, width, sensed))
    return SkillFamily(kind, **arrays, stride=header.stride, run=header.run, meta=header.meta)
