"""SpineFlex: equal turns of equal bones that bring the end of the spine into a wanted direction.

The n bones of a spine, each turned by the same angle θ against the one before (the first against the root),
form with the line from the root to their end a polygon of n + 1 corners, whose interior angles add up to
(n - 1) π. The corners between bones have π - θ each; by symmetry the two at the ends are equal. The first
bone leaves the root's direction by θ, the end is seen at the angle V, so each end corner has V - θ:

    2 (V - θ) + (n - 1) (π - θ) = (n - 1) π     ⇒     θ = 2 V / (n + 1)

The spine's end is then at the distance l sin(nθ/2) / sin(θ/2) from the root. (Carlsen, "Quadruped
locomotion", 2016, shows the pentagon of four bones; `brute_force_bend` solves the same by search.)
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from surefoot.kernels import allocating_kernel, kernel

__all__ = ["bend_for", "brute_force_bend", "chord", "spine_points"]


@kernel(forceinline=True)
def bend_for(angle, bones):
    """θ [rad] that brings the end of ``bones`` bones to ``angle`` [rad] from the root's direction."""
    return 2.0 * angle / (bones + 1.0)


@allocating_kernel(forceinline=True)
def chord(bend, bones, bone):
    """[m] from the root to the end of the spine: ``bones`` of length ``bone`` [m], turned by ``bend``."""
    half = 0.5 * bend
    if abs(half) < 1e-4:
        return bones * bone * (1.0 - (bones * bones - 1.0) * half * half / 6.0)
    return bone * math.sin(bones * half) / math.sin(half)


def spine_points(bend: float, bones: int, bone: float) -> NDArray[np.float64]:
    """(bones + 1, 2) [m]: root and joints one after the other; the root looks along x."""
    direction = bend * np.arange(1, bones + 1)
    steps = bone * np.stack([np.cos(direction), np.sin(direction)], axis=1)
    return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])


def brute_force_bend(angle: float, bones: int) -> float:
    """`bend_for` by laying bone to bone and halving the interval; the slow reference of the tests."""

    def seen_at(bend: float) -> float:
        x = sum(math.cos(bend * k) for k in range(1, bones + 1))
        y = sum(math.sin(bend * k) for k in range(1, bones + 1))
        return math.atan2(y, x)

    low, high = -2.0 * math.pi / (bones + 1) + 1e-9, 2.0 * math.pi / (bones + 1) - 1e-9
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if seen_at(middle) < angle else (low, middle)
    return 0.5 * (low + high)
