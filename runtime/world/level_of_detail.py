"""Who is simulated, and in how much detail the others are drawn: by who looks from where.

Granieri, Crabtree and Badler (1995), "Production and playback of human figure motion for visual simulation",
section 4.1, choose by distance alone. Here what is outside of a viewer's field of view counts as farther off,
and each level is for so many at most. All of it depends on the world's state and its viewers only, so that
the same input gives the same run.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from runtime.errors import RuntimeInputError
from runtime.world.arguments import checked_number, checked_points, checked_whole

__all__ = ["AUTO", "EVERY", "LEVELS", "PHYSICS", "Budget", "Viewer", "checked_detail", "levels_for"]

AUTO = "auto"
"""The detail of an agent whose level is chosen by who looks on."""
PHYSICS = "physics"
"""The level of those that are simulated."""
LEVELS = (PHYSICS, "full", "medium", "low")
EVERY = 10
"""Ticks between two choices."""
_UNSEEN = 2.5  # times as far off counts what nobody has in view
_BEHIND = 5.0  # [m] added to that
_NEARLY = math.radians(10.0)  # outside of a field of view that still counts as in view: heads turn
_KEEP = 0.8  # of its distance counts what has the level already: nobody changes back and forth at a border
_TALL = 1.8  # [m]
_PER_PERSON = (0.55, 0.03, 0.02, 0.015)
"""[ms] of a 60 Hz frame for each person at each of `LEVELS` (docs/guides/postures.md)."""


@dataclass(frozen=True)
class Viewer:
    """Somebody who looks on: a camera or a player.

    ``position`` (3,) [m]; ``direction`` (3,) in which it looks, of any length above 0; ``field_of_view``
    [rad], above 0 to 2π, from one edge of the picture to the other. Raises `RuntimeInputError` for anything
    else.
    """

    position: tuple[float, float, float]
    direction: tuple[float, float, float] = (1.0, 0.0, 0.0)
    field_of_view: float = math.radians(90.0)

    def __post_init__(self) -> None:
        for name in ("position", "direction"):
            object.__setattr__(self, name, _triple(getattr(self, name), f"the {name} of a viewer"))
        if math.hypot(*self.direction) <= 0.0:
            raise RuntimeInputError("the direction of a viewer has no length")
        angle = checked_number(self.field_of_view, "the field_of_view of a viewer", "rad")
        if not 0.0 < angle <= 2.0 * math.pi:
            raise RuntimeInputError(
                f"the field_of_view of a viewer must be above 0 and at most 2π, not {angle:g}"
            )
        object.__setattr__(self, "field_of_view", angle)


def _triple(value: ArrayLike, what: str) -> tuple[float, float, float]:
    points = checked_points(value, what)
    if points.shape != (1, 3) or np.ndim(value) != 1:
        raise RuntimeInputError(f"{what} must be one point (3,), not {value!r}")
    x, y, z = points[0].tolist()
    return x, y, z


@dataclass(frozen=True)
class Budget:
    """How many people there may be at each level at most, and how far off [m]: ``physics`` people within
    ``physics_within``, ``full`` ones within ``full_within``, ``medium`` ones within ``medium_within``; all
    others are low. People of fixed detail count, too. Raises `RuntimeInputError` for a number below 0."""

    physics: int = 10
    full: int = 90
    medium: int = 300
    physics_within: float = 25.0
    full_within: float = 50.0
    medium_within: float = 120.0

    def __post_init__(self) -> None:
        for name in LEVELS[:-1]:
            checked_whole(getattr(self, name), name)
            checked_number(getattr(self, f"{name}_within"), f"{name}_within", "m", 0.0)

    @property
    def limits(self) -> list[tuple[int, float]]:
        """Of each level but the last how many there may be, and how far off [m]."""
        return [(getattr(self, name), getattr(self, f"{name}_within")) for name in LEVELS[:-1]]

    @classmethod
    def for_milliseconds(cls, milliseconds: float, people: int) -> "Budget":
        """A budget for ``people`` that takes about so many ``milliseconds`` a frame of 1/60 s on a usual
        core: a guide only, since counts are what a run depends on. Of what is left when all are drawn low,
        half goes to people under physics."""
        total, count = (
            checked_number(milliseconds, "milliseconds", "ms", 0.0),
            checked_whole(people, "people"),
        )
        physics, full, medium, low = _PER_PERSON
        spare = max(total - count * low, 0.0)
        simulated = int(0.5 * spare / (physics - low))
        spare -= simulated * (physics - low)
        drawn = int(0.5 * spare / (full - low))
        return cls(simulated, drawn, int((spare - drawn * (full - low)) / (medium - low)))


def levels_for(
    places: NDArray[np.float64],
    now: NDArray[np.int64],
    fixed: NDArray[np.bool_],
    viewers: Sequence[Viewer],
    budget: Budget,
) -> NDArray[np.int64]:
    """The levels, (n,) numbers in `LEVELS`, of people at ``places`` (n, 3) [m] that are at levels ``now``
    (n,); those that are ``fixed`` (n,) keep theirs."""
    wanted = np.where(fixed, now, len(LEVELS) - 1)
    if not viewers:
        return wanted
    far = np.min([_distances(places, viewer) for viewer in viewers], axis=0)
    for level, (most, within) in enumerate(budget.limits):
        left = most - int((wanted == level).sum())
        away = np.where(now <= level, _KEEP * far, far)
        able = np.flatnonzero(~fixed & (wanted == len(LEVELS) - 1) & (away <= within))
        if left > 0 and len(able):
            wanted[able[np.argsort(away[able], kind="stable")[:left]]] = level
    return wanted


def _distances(places: NDArray[np.float64], viewer: Viewer) -> NDArray[np.float64]:
    """How far off (n,) [m] ``places`` count for a viewer."""
    there = places - np.array(viewer.position)
    there[:, 2] = np.minimum(np.maximum(there[:, 2], 0.0), there[:, 2] + _TALL)  # of the nearest part of it
    far = np.linalg.norm(there, axis=1)
    ahead = np.array(viewer.direction) / math.hypot(*viewer.direction)
    cosine = (there @ ahead) / np.maximum(far, 1e-9)
    seen = np.arccos(np.clip(cosine, -1.0, 1.0)) <= 0.5 * viewer.field_of_view + _NEARLY
    return np.where(seen, far, _UNSEEN * far + _BEHIND)


def checked_detail(detail: Any, levels: Sequence[str], body: str) -> str:
    """``detail`` if a ``body`` with these ``levels`` can have it. Raises `RuntimeInputError`."""
    valid = (AUTO, *levels) if len(levels) > 1 else tuple(levels)
    if not isinstance(detail, str) or detail not in valid:
        raise RuntimeInputError(f"detail {detail!r} of a {body}: valid: {', '.join(valid)}")
    return detail
