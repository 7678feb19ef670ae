"""Going over from one motion to another without a jump: what the poses differ by fades out.

The new motion plays at once. Added to it is the difference from the old one at the moment of the change,
which goes to 0 along the quintic that begins with the difference and its rate and ends at rest: D. Bollo,
"Inertialization: high-performance animation transitions in Gears of War", GDC 2018. Nothing of the old motion
has to be sampled any more.
"""

import math

import numpy as np
from numpy.typing import NDArray

__all__ = ["SECONDS", "STEP", "Fade", "difference", "fade_from", "faded", "rates"]

STEP = 0.01
"""[s] over which rates of change are taken."""
SECONDS = 0.3
"""[s] that a fade takes at least."""
_MOST_RATE = math.radians(240.0)  # [rad/s] of a joint at which a fade may go at most: 4 degrees at 60 Hz
_MOST_PACE = 1.2  # [m/s] of the root
_PEAK = 1.875  # greatest slope of the quintic from 1 to 0 over 1
_LONGEST = 1.5  # [s]

Fade = tuple[NDArray[np.float64], NDArray[np.float64], float]
"""Offsets (45,), their rates [1/s] (45,), and how long it takes [s]."""


def difference(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    """How a pose differs from another, each (46,) ``qpos`` of the person: (45,) float64, root [m], turn [rad]
    as a rotation vector in the world, joints [rad]."""
    out = np.empty(45)
    out[:3] = one[:3] - other[:3]
    out[3:6] = _vector(_product(one[3:7], other[3:7] * _CONJUGATE))
    out[6:] = one[7:] - other[7:]
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
    needed = _PEAK * max(np.abs(offsets[3:]).max() / _MOST_RATE, np.linalg.norm(offsets[:3]) / _MOST_PACE)
    return offsets, old_rates - new_rates, float(min(max(needed, SECONDS), _LONGEST))


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
    s = elapsed / seconds
    cube = s * s * s
    place = 1.0 - cube * (10.0 - s * (15.0 - 6.0 * s))
    pace = seconds * (s - cube * (6.0 - s * (8.0 - 3.0 * s)))
    left = place * offsets + pace * offset_rates
    out = pose.copy()
    out[:3] += left[:3]
    out[3:7] = _product(_quaternion(left[3:6]), pose[3:7])
    out[7:] += left[6:]
    return out


_CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])


def _product(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    w, x, y, z = a
    p, i, j, k = b
    return np.array(
        [
            w * p - x * i - y * j - z * k,
            w * i + x * p + y * k - z * j,
            w * j - x * k + y * p + z * i,
            w * k + x * j - y * i + z * p,
        ]
    )


def _vector(turn: NDArray[np.float64]) -> NDArray[np.float64]:
    turn = -turn if turn[0] < 0.0 else turn
    size = float(np.linalg.norm(turn[1:]))
    angle = 2.0 * math.atan2(size, float(turn[0]))
    return turn[1:] * (angle / size if size > 1e-12 else 2.0)


def _quaternion(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    angle = float(np.linalg.norm(vector))
    share = math.sin(0.5 * angle) / angle if angle > 1e-12 else 0.5
    return np.array([math.cos(0.5 * angle), *(share * vector)])
