"""Going over from one motion to another without a jump: what the poses differ by fades out.

The new motion plays at once. Added to it is the difference from the old one at the moment of the change,
which goes to 0 along the quintic that begins with the difference and its rate and ends at rest: D. Bollo,
"Inertialization: high-performance animation transitions in Gears of War", GDC 2018. Nothing of the old motion
has to be sampled any more.
"""

import math

import numpy as np
from numpy.typing import NDArray

from surefoot.kernels import kernel

__all__ = [
    "SECONDS", "STEP", "Fade", "add_fade", "difference", "fade_from", "fade_of", "faded", "rates",
    "tell_apart",
]  # fmt: skip

STEP = 0.01
"""[s] over which rates of change are taken."""
SECONDS = 0.3
"""[s] that a fade takes at least."""
_MOST_RATE = math.radians(240.0)  # [rad/s] of a joint at which a fade may go at most: 4 degrees at 60 Hz
_MOST_PACE = 1.2  # [m/s] of the root
_PEAK = 1.875  # greatest slope of the quintic from 1 to 0 over 1
_LONGEST = 1.5  # [s]
_SPENT = 0.15
"""[s] in which a difference in rates has gone: what is quick would swing far out in a long fade."""

Fade = tuple[NDArray[np.float64], NDArray[np.float64], float]
"""Offsets (45,), their rates [1/s] (45,), and how long it takes [s]."""


def difference(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    """How a pose differs from another, each (46,) ``qpos`` of the person: (45,) float64, root [m], turn [rad]
    as a rotation vector in the world, joints [rad]."""
    out = np.empty(45)
    tell_apart(one, other, out)
    return out


def rates(before: NDArray[np.float64], now: NDArray[np.float64], dt: float) -> NDArray[np.float64]:
    """How fast a pose changes, (45,) [1/s]: from ``before`` to ``now`` in ``dt`` [s]."""
    return difference(now, before) / dt


def fade_from(
    old: NDArray[np.float64],
    old_rates: NDArray[np.float64],
    new: NDArray[np.float64],
    new_rates: NDArray[np.float64],
) -> Fade:
    """The fade of a figure in pose ``old`` (46,) that goes on in ``new``; ``old_rates``, ``new_rates`` (45,):
    as of `rates`. The greater the difference, the longer it takes."""
    offsets = difference(old, new)
    return offsets, old_rates - new_rates, fade_of(offsets)


def faded(
    pose: NDArray[np.float64],
    offsets: NDArray[np.float64],
    offset_rates: NDArray[np.float64],
    seconds: float,
    elapsed: float,
) -> NDArray[np.float64]:
    """``pose`` (46,) with what is left of a fade after ``elapsed`` [s]."""
    if elapsed >= seconds:
        return pose
    out = pose.copy()
    add_fade(out, offsets, offset_rates, seconds, elapsed)
    return out


@kernel
def tell_apart(one, other, out):
    """Kernel of `difference`."""
    for k in range(3):
        out[k] = one[k] - other[k]
    w, x, y, z = _product(one[3], one[4], one[5], one[6], other[3], -other[4], -other[5], -other[6])
    if w < 0.0:
        w, x, y, z = -w, -x, -y, -z
    size = math.sqrt(x * x + y * y + z * z)
    share = 2.0 * math.atan2(size, w) / size if size > 1e-12 else 2.0
    out[3], out[4], out[5] = share * x, share * y, share * z
    for k in range(6, 45):
        out[k] = one[k + 1] - other[k + 1]


@kernel
def fade_of(offsets):
    """For how long a difference ``offsets`` (45,) fades [s]."""
    most = 0.0
    for k in range(3, 45):
        most = max(most, abs(offsets[k]))
    far = math.sqrt(offsets[0] * offsets[0] + offsets[1] * offsets[1] + offsets[2] * offsets[2])
    return min(max(_PEAK * max(most / _MOST_RATE, far / _MOST_PACE), SECONDS), _LONGEST)


@kernel
def add_fade(pose, offsets, offset_rates, seconds, elapsed):
    """Kernel of `faded`: ``pose`` (46,) is changed. ``elapsed`` is less than ``seconds``."""
    s = elapsed / seconds
    cube = s * s * s
    place = 1.0 - cube * (10.0 - s * (15.0 - 6.0 * s))
    spent = min(seconds, _SPENT)
    s = min(elapsed / spent, 1.0)
    pace = spent * (s - s * s * s * (6.0 - s * (8.0 - 3.0 * s)))
    for k in range(3):
        pose[k] += place * offsets[k] + pace * offset_rates[k]
    x, y = place * offsets[3] + pace * offset_rates[3], place * offsets[4] + pace * offset_rates[4]
    z = place * offsets[5] + pace * offset_rates[5]
    angle = math.sqrt(x * x + y * y + z * z)
    share = math.sin(0.5 * angle) / angle if angle > 1e-12 else 0.5
    pose[3], pose[4], pose[5], pose[6] = _product(
        math.cos(0.5 * angle), share * x, share * y, share * z, pose[3], pose[4], pose[5], pose[6]
    )
    for k in range(6, 45):
        pose[k + 1] += place * offsets[k] + pace * offset_rates[k]


@kernel
def _product(w, x, y, z, p, i, j, k):
    """Of two quaternions."""
    return (
        w * p - x * i - y * j - z * k,
        w * i + x * p + y * k - z * j,
        w * j - x * k + y * p + z * i,
        w * k + x * j - y * i + z * p,
    )
