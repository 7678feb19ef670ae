"""Several bodies with the same goal: late ones stop beside those already there.

A body at rest within a metre of a goal occupies it; for later ones, so do bodies at rest next to it, and
those next to them. A late body continues along its path until it would touch one of them. So bodies sent to
one place end up as a group around it, or as a queue if they arrive one behind the other.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from locomotion.avoidance.yielding import SPACING, Course

__all__ = ["AT_REST", "ROOM", "STOREY", "free_points", "is_before", "who_stands_at"]

ROOM = 0.08
"""[m] Extra distance between bodies."""
STOREY = 1.5
"""[m] height difference from which bodies are on different storeys."""
AT_REST = 0.05
"""[m/s]"""
_NEAR = 1.0  # [m] from a goal to the rim of a body that occupies it
_NEXT = 0.3, 3.0  # [m] between the rims of two in a group, plus so many radii, since heads reach farther
_BEFORE = 0.2  # [m] a body this near to the group at its goal need not set out
_FARTHEST = 12.0  # [m] farthest that a group reaches from its goal


def who_stands_at(
    goal: NDArray[np.float64], radius: float, discs: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The bodies of ``discs`` (k, 6) that a body of ``radius`` [m] on its way to ``goal`` (3,) must stop at,
    as they stand there or in the group around it; discs as in `Herd.discs`."""
    still = np.abs(discs[:, 3:5]).max(axis=1, initial=0.0) < AT_REST
    still &= np.abs(discs[:, 2] - goal[2]) < STOREY
    away = np.linalg.norm(discs[:, :2] - goal[:2], axis=1)
    there = still & (away < discs[:, 5] + max(radius + ROOM, _NEAR))
    if not there.any():
        return discs[:0]
    group = discs[still & (away < _FARTHEST)]
    inside = there[still & (away < _FARTHEST)]
    gaps = np.linalg.norm(group[:, None, :2] - group[None, :, :2], axis=2) - group[:, 5] - group[:, None, 5]
    near = gaps < _NEXT[0] + _NEXT[1] * np.minimum(group[:, 5], group[:, None, 5])
    while True:
        grown = near[inside].any(axis=0)
        if np.array_equal(grown, inside):
            return group[inside]
        inside = grown


def is_before(body: NDArray[np.float64], reach: float, group: NDArray[np.float64]) -> bool:
    """Whether a body of discs ``body`` (k, 6), whose head reaches ``reach`` [m] farther, is as near to
    ``group`` (m, 6) as it should get."""
    away = np.linalg.norm(body[:, None, :2] - group[None, :, :2], axis=2)
    return bool((away < body[:, None, 5] + group[None, :, 5] + ROOM + _BEFORE + reach).any())


def free_points(course: Course, group: NDArray[np.float64]) -> int:
    """Number of points on a course before the body's front would touch one of ``group`` (m, 6) while
    approaching it; all of them if it touches none."""
    first = min(int(np.ceil(course.length / SPACING)), len(course.points) - 1)
    front = course.points[first:, :2]
    away = np.linalg.norm(front[:, None] - group[None, :, :2], axis=2)
    nearer = np.diff(away, axis=0, append=away[-1:]) < 0.0
    nearer[1:] |= np.diff(away, axis=0) < 0.0
    touches = (nearer & (away < group[:, 5] + course.radius + ROOM)).any(axis=1)
    return first + int(np.argmax(touches)) if touches.any() else len(course.points)
