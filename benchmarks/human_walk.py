"""How people walk, to compare with: measurements that the learned walk's reference was not made from.

Curves over the cycle from a heel's strike, every 4 %: the normal data that Oxford Metrics (Vicon) delivered
with its clinical gait software (``normal.gcd``; stride 1.39 m at some 1.2 m/s). The thigh's angle is taken
against the vertical, because the zero of a pelvis depends on the markers. Pace: step rate and length in
constant proportion (Sekiya et al. 1996, 0.0062 m per step/min). Rise of the centre of mass: Orendurff et al.
(2004), "The effect of walking speed on center of mass displacement", J. Rehabil. Res. Dev. 41(6). Step width
and double support: Winter (1991), "The biomechanics and motor control of human gait"; Perry and Burnfield
(2010), "Gait Analysis". Peaks of the ground reaction and angles of arms and knees: Perry and Burnfield;
Murray et al. (1967).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

__all__ = ["CURVES", "TARGETS", "human_cadence", "human_curves", "over_cycle"]

_HIP = (33.5, 33.8, 32.3, 30.3, 26.1, 22.4, 17.9, 12.4, 7.5, 3.2, -0.6, -3.8, -6.5, -8.8, -9.8, -8.0, -2.4,
        5.8, 14.8, 21.7, 27.9, 32.4, 34.3, 34.3, 34.1)  # fmt: skip
_TILT = (10.9, 10.9, 10.3, 9.0, 8.2, 8.4, 8.4, 8.3, 8.6, 9.0, 9.5, 10.1, 10.7, 10.9, 10.9, 9.9, 8.5, 8.3,
         8.7, 8.5, 8.7, 8.9, 9.0, 9.2, 9.7)  # fmt: skip
CURVES: dict[str, tuple[float, ...]] = {
    "thigh": tuple(np.subtract(_HIP, _TILT)),
    "knee": (0.4, 3.3, 8.1, 14.6, 15.4, 14.9, 13.1, 9.5, 6.5, 3.6, 1.8, 1.2, 2.0, 4.5, 9.8, 20.6, 36.9, 51.8,
             61.0, 64.0, 61.0, 52.2, 38.5, 22.8, 8.4),
    "ankle": (2.0, 1.1, -1.0, 0.6, 3.1, 5.9, 7.7, 8.9, 10.3, 11.8, 13.6, 15.4, 16.5, 15.7, 12.5, 5.0, -4.3,
              -10.9, -8.5, -3.5, 0.6, 2.3, 1.9, 1.8, 1.8),
}  # fmt: skip
"""[deg]"""
TARGETS: dict[str, tuple[str, str]] = {
    "speed": ("m/s", "as asked"),
    "cadence": ("steps/s", "human relation +- 10 %"),
    "step width": ("mm", "80 to 150"),
    "rise": ("mm", "25 to 55"),
    "double support": ("%", "15 to 30"),
    "knee at midstance": ("deg", "<= 20"),
    "knee when loaded": ("deg", "15 to 20"),
    "knee in swing": ("deg", "60"),
    "heel first": ("%", ">= 95"),
    "slide": ("mm", "<= 10"),
    "penetration": ("mm", "<= 10"),
    "limb in limb": ("mm", "<= 15"),
    "peak reaction": ("weights", "1.1 to 1.3"),
    "shoulder range": ("deg", "32 to 43"),
    "elbow range": ("deg", "25"),
    "left against right": ("%", "<= 4"),
}
"""Unit of each figure, and what it should be."""


def human_cadence(speed: float) -> float:
    """Steps per second of people at ``speed`` [m/s]."""
    return float(np.sqrt(speed / 0.372))


def human_curves(samples: int) -> dict[str, NDArray[np.float64]]:
    """`CURVES` at equal shares of the cycle, each (samples,) [deg]."""
    return {name: over_cycle(values, samples) for name, values in CURVES.items()}


def over_cycle(values: Sequence[float], samples: int) -> NDArray[np.float64]:
    """A curve of any number of ``values`` at equal shares of the cycle, which begins anew, (samples,)."""
    shares = np.arange(len(values)) / len(values)
    return np.interp(np.arange(samples) / samples, shares, values, period=1.0)
