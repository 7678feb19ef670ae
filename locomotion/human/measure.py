"""The measure of a person of another size, by dynamic similarity.

Two bodies of one shape and density move alike under the same gravity if lengths are s times as long and times
√s times as long; angles and accelerations are the same (R. McN. Alexander and A. S. Jayes, "A dynamic
similarity hypothesis for the gaits of quadrupedal mammals", Journal of Zoology 201, 1983). So a person of
another size is simulated as the usual one. Lengths of the world are divided by its size before it is told of
them, and times by √s. Nothing has to be learned for it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from locomotion.avoidance.yielding import SPACING, Course
from locomotion.body_events import Event
from locomotion.gaits.limits import PERSON_RULES
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.paths.table import TrackingLimits

__all__ = ["Measure", "resized"]

_LENGTHS = frozenset(
    {"position", "goal", "length", "distance", "arc_length", "height", "takeoff_error", "size"}
)
_TIMES_AND_SPEEDS = frozenset({"time", "seconds", "speed", "speed_error"})


@dataclass(frozen=True)
class Measure:
    """Of a person of a ``size``; 1 is the usual one, 1.76 m tall. Its methods turn what is its own into what
    it is in the world."""

    size: float

    @property
    def root(self) -> float:
        """By how much its times are longer and its speeds higher."""
        return math.sqrt(self.size)

    def event(self, event: Event) -> Event:
        """What has happened to it."""
        lengths, others = _measured(type(event))
        told: dict[str, Any] = {name: _times(self.size, getattr(event, name)) for name in lengths}
        return replace(event, **told, **{name: self.root * getattr(event, name) for name in others})

    def limits(self, limits: TrackingLimits) -> TrackingLimits:
        """What it can follow."""
        size, root = self.size, self.root
        low, high = limits.speeds
        speed, rate = limits.tight
        return replace(
            limits,
            speeds=(root * low, root * high),
            uphill=root * limits.uphill,
            downhill=root * limits.downhill,
            sharpest=limits.sharpest / size,
            rest=size * limits.rest,
            foresight=size * limits.foresight,
            usual=root * limits.usual,
            tight=(root * speed, rate / root),
        )

    def course(self, course: Course) -> Course:
        """What it is about to do. It needs as much room as anybody."""
        size, root = self.size, self.root
        if size == 1.0:
            return course
        return replace(
            course,
            points=self.evenly(size * course.points),
            speeds=self.evenly(root * course.speeds[:, None])[:, 0],
            speed=root * course.speed,
            length=size * course.length,
            reach=size * course.reach,
            radius=PERSON_RULES["radius"],
            eagerness=course.eagerness / root,
            slowest=root * course.slowest,
            sharpest=course.sharpest / size,
            begins=size * course.begins,
            stops=size * course.stops,
            turns=root * course.turns,
            nose=size * course.nose,
        )

    def evenly(self, rows: NDArray[np.float64]) -> NDArray[np.float64]:
        """``rows`` (k, c) that are given every `SPACING` of its own way, every `SPACING` of that in the world
        (n, c): the first and the last are the same."""
        if self.size == 1.0:
            return rows
        arcs = self.size * SPACING * np.arange(len(rows))
        at = np.linspace(0.0, arcs[-1], max(round(float(arcs[-1]) / SPACING) + 1, min(len(rows), 2)))
        return np.column_stack([np.interp(at, arcs, column) for column in rows.T])

    def shift(self, shift: NDArray[np.float64]) -> NDArray[np.float64]:
        """The other way round: a ``shift`` (k, 2) [m] of its course in the world, in its own measure."""
        return Measure(1.0 / self.size).evenly(shift / self.size)


def resized(obstacle: ObstacleAhead, factor: float) -> ObstacleAhead:
    """An obstacle ``factor`` times as large, and as far away."""
    return replace(
        obstacle,
        arc_length=factor * obstacle.arc_length,
        height=factor * obstacle.height,
        position=factor * obstacle.position,
        depth=factor * obstacle.depth,
    )


def _times(factor: float, length: float | tuple[float, ...]) -> float | tuple[float, ...]:
    return tuple(factor * each for each in length) if isinstance(length, tuple) else factor * length


@cache
def _measured(kind: type[Event]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The fields of a kind of event that are lengths, and those that are times and speeds."""
    names = [field.name for field in fields(kind)]
    return tuple(name for name in names if name in _LENGTHS), tuple(
        name for name in names if name in _TIMES_AND_SPEEDS
    )
