"""Legs: analytic inverse kinematics of two bones and a foot bone, from the upper joint to the toe.

Everything happens in the leg's plane, which contains the trunk's direction and the toe: x forwards, z up,
from the upper joint. Angles of bones are counted from straight down, forwards positive.
"""

from __future__ import annotations

import math

from numba import njit

__all__ = ["solve_leg", "two_bones"]

_EASY, _REACH = 0.93, 0.99
"""Shares of the two bones' length: stretched to the first, a leg begins to give way; to the second, it never
gets."""


@njit(cache=True, inline="always")
def two_bones(x, z, upper, lower, side):
    """Angles [rad] of two bones of lengths ``upper`` and ``lower`` [m] that end at (x, z); the joint between
    them points forwards (side 1) or backwards (-1). Places out of reach get the straight or folded leg.
    """
    far = math.sqrt(x * x + z * z)
    d = min(max(far, abs(upper - lower) + 1e-6), upper + lower - 1e-6)
    if far > 1e-9:
        x, z = x * d / far, z * d / far
    inner = (upper * upper + d * d - lower * lower) / (2.0 * upper * d)
    first = math.atan2(x, -z) + side * math.acos(min(max(inner, -1.0), 1.0))
    kx, kz = upper * math.sin(first), -upper * math.cos(first)
    return first, math.atan2(x - kx, kz - z)


@njit(cache=True)
def solve_leg(x, z, upper, lower, foot, lean, side, give):
    """(upper, lower, foot) angles [rad] of a leg whose toe is at (x, z) [m].

    ``lean`` [rad] is how far the foot bone's upper end is behind the vertical over the toe. Where the two
    other bones do not reach it, the foot bone gives way by the share ``give``: 1 for a standing foot, whose
    toe must stay; with less, a swinging toe stays behind where the leg is too short.
    """
    hx, hz = x - foot * math.sin(lean), z + foot * math.cos(lean)
    d = math.sqrt(hx * hx + hz * hz)
    easy, reach = _EASY * (upper + lower), _REACH * (upper + lower)
    if d > easy and give > 0.0:
        # never quite straight: the last part of the way is taken ever more slowly
        d = easy + (reach - easy) * (1.0 - math.exp(-(d - easy) / (reach - easy)))
        far = math.sqrt(x * x + z * z)
        # the foot bone's upper end moves on its circle around the toe, on the rear side, to be in reach
        cosine = (far * far + foot * foot - d * d) / (2.0 * far * foot)
        bent = math.atan2(x, -z) + math.acos(min(max(cosine, -1.0), 1.0))
        lean += give * (bent - lean)
        hx, hz = x - foot * math.sin(lean), z + foot * math.cos(lean)
        d = math.sqrt(hx * hx + hz * hz)
    if d > reach - 1e-9 or (d > easy and give < 1.0):
        shorter = (easy + (reach - easy) * (1.0 - math.exp(-(d - easy) / (reach - easy)))) / d
        shorter += give * (min(reach / d, 1.0) - shorter)
        hx, hz = hx * shorter, hz * shorter
    first, second = two_bones(hx, hz, upper, lower, side)
    # where the leg is too short the toe comes off its place: measured by whoever asks, not hidden
    return first, second, lean if give < 1.0 else math.atan2(x - hx, hz - z)
