"""Legs: analytic inverse kinematics of two bones and a foot bone, from the upper joint to the toe.

Everything is in the leg's plane, which contains the trunk's direction and the toe: x forwards, z up, from the
upper joint. Bone angles are from straight down, forwards positive.
"""

from __future__ import annotations

import math

from surefoot.kernels import kernel

__all__ = ["solve_leg", "two_bones"]

_REACH = 0.97
"""Greatest share of the two bones' length to which they are stretched; beyond it the foot bone yields. A
nearly straight knee would have to turn ever faster for each centimetre."""
_FOLD = 0.36
"""Share of the two bones' length to which they fold; for nearer toes the foot bone turns down."""
_SOFT = 0.35  # of the foot bone's length over which it begins to turn down
_UNCURL = 1.2  # of the foot bone's length over which a paw gives up its curl, around the same place


@kernel(forceinline=True)
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


@kernel
def solve_leg(x, z, upper, lower, foot, lean, curl, side):
    """(upper, lower, foot) angles [rad] of a leg whose toe is at (x, z) [m].

    ``lean`` [rad] is how far the foot bone's upper end is behind the line from the toe to the joint,
    ``curl`` [rad] what a swinging paw folds back from that. The foot bone gives way where the two others
    would be stretched too straight or folded too far, smoothly, so that no joint has to turn ever faster
    there.
    """
    far = math.sqrt(x * x + z * z)
    nearer = (_FOLD * (upper + lower) + foot - far) / foot
    u = min(max(0.5 - nearer / _UNCURL, 0.0), 1.0)
    bent = lean - curl * u * u * (3.0 - 2.0 * u) + _SOFT * math.log1p(math.exp(min(nearer / _SOFT, 60.0)))
    # as far as the foot bone may be bent for the two others to reach it
    cosine = (far * far + foot * foot - (_REACH * (upper + lower)) ** 2) / (2.0 * far * foot)
    most = max(math.acos(min(max(cosine, -1.0), 1.0)), 1e-6)
    lean = most * math.tanh(bent / most) + math.atan2(x, -z)
    # if the leg is too short the toe misses its place; this is not hidden, so that it can be measured
    first, second = two_bones(x - foot * math.sin(lean), z + foot * math.cos(lean), upper, lower, side)
    return first, second, lean
