"""How people run, to compare with: measurements that the learned run's reference was not made from.

Curves over the cycle from a foot's strike, every 4 %, and the times of a stride: means of the 28 runners of
Fukuchi, Fukuchi and Duarte (2017), "A public dataset of running biomechanics and the effects of running speed
on lower extremity kinematics and kinetics", PeerJ 5:e3298 (data: figshare 4543435, CC BY 4.0), who ran on a
treadmill at 2.5, 3.5 and 4.5 m/s. They were averaged from the markers with the treadmill's force by the
project migera (its ``fukuchi_running_strides.csv``). Thighs are measured from the vertical, because the zero
of a pelvis depends on the markers; the ankle is that of foot and shank. At 2.5 m/s the knee is within 6
degrees of the angles that R. Fukuchi published himself. These runners fly for 23, 33 and 36 % of a stride,
and their pelvis rises by 93, 89 and 76 mm.

Peak reaction: Nilsson and Thorstensson (1989), "Ground reaction forces at different speeds of human walking
and running", Acta Physiol. Scand. 136.
"""

import numpy as np
from numpy.typing import NDArray

from benchmarks.human_walk import over_cycle

__all__ = ["CURVES", "TARGETS", "runners_cadence", "runners_curves"]

CURVES: dict[float, dict[str, tuple[float, ...]]] = {
    2.5: {
        "thigh": (17.1, 18.1, 20.1, 19.9, 15.8, 10.0, 2.7, -5.0, -12.0, -17.2, -19.9, -19.8, -16.9, -11.9,
                  -6.0, 0.4, 7.8, 15.6, 22.1, 26.3, 27.7, 26.3, 22.7, 19.1, 17.1),
        "knee": (9.4, 18.0, 31.0, 39.8, 42.0, 39.6, 33.9, 26.3, 18.7, 14.1, 14.8, 21.4, 33.6, 48.5, 63.1,
                 76.0, 85.3, 89.7, 87.8, 79.8, 67.1, 50.4, 32.1, 16.3, 8.1),
        "ankle": (3.6, 2.6, 11.2, 19.2, 24.5, 26.5, 24.2, 16.4, 4.3, -7.8, -15.6, -19.0, -18.4, -16.2,
                  -14.1, -10.8, -6.1, -2.0, 0.8, 2.7, 3.5, 3.4, 3.5, 3.6, 3.6),
    },
    3.5: {
        "thigh": (21.0, 21.6, 23.1, 20.8, 14.2, 5.7, -3.8, -13.2, -20.9, -25.3, -26.4, -24.3, -19.7, -13.8,
                  -6.9, 1.5, 11.7, 21.5, 28.9, 33.3, 34.4, 32.5, 28.5, 24.4, 21.7),
        "knee": (10.3, 19.8, 34.0, 41.9, 42.4, 38.0, 30.4, 21.0, 13.0, 11.3, 17.9, 30.7, 47.0, 64.0, 80.0,
                 93.6, 102.8, 105.0, 99.6, 88.4, 72.9, 54.4, 34.7, 17.5, 8.8),
        "ankle": (3.0, 1.2, 10.8, 19.7, 25.4, 26.3, 19.9, 6.2, -10.3, -21.9, -24.4, -21.8, -20.1, -19.8,
                  -17.6, -13.1, -8.0, -4.2, -1.8, -0.3, 0.3, 1.2, 2.4, 2.9, 3.1),
    },
    4.5: {
        "thigh": (24.9, 24.6, 25.0, 21.6, 13.3, 2.9, -8.2, -18.8, -26.9, -30.4, -29.9, -26.8, -21.7, -15.3,
                  -7.5, 3.6, 15.9, 27.3, 35.4, 39.7, 40.9, 39.1, 35.0, 30.3, 26.6),
        "knee": (11.8, 20.5, 34.6, 42.6, 42.6, 37.2, 28.4, 17.8, 10.4, 13.1, 24.6, 40.4, 58.1, 75.7, 92.1,
                 107.0, 115.5, 116.0, 108.5, 95.2, 78.5, 59.4, 38.9, 20.8, 11.1),
        "ankle": (1.7, -0.9, 9.3, 18.9, 25.2, 25.0, 15.5, -2.0, -20.2, -27.6, -25.8, -23.7, -23.5, -22.8,
                  -19.4, -14.3, -9.0, -5.0, -2.6, -1.3, -0.6, 0.9, 2.3, 2.9, 2.5),
    },
}  # fmt: skip
"""[deg], at each speed [m/s]."""
_SPEEDS = tuple(CURVES)
_STRIDES = (0.7451, 0.7031, 0.6570)  # [s] at these speeds
TARGETS: dict[str, tuple[str, str]] = {
    "speed": ("m/s", "as asked"),
    "cadence": ("steps/s", "people's +- 10 %"),
    "step width": ("mm", ""),
    "crossing": ("mm", "none"),
    "rise": ("mm", "60 to 100"),
    "flight": ("%", "23 to 36"),
    "knee when loaded": ("deg", "40 to 45"),
    "knee in swing": ("deg", "90 to 116"),
    "slide": ("mm", "<= 10"),
    "penetration": ("mm", "<= 10"),
    "limb in limb": ("mm", "<= 15"),
    "peak reaction": ("weights", "2 to 3"),
    "hardest step": ("weights", "<= 3 at 3.5 m/s, 3.5 at 5 m/s"),
    "shoulder range": ("deg", ""),
    "elbow range": ("deg", ""),
    "left against right": ("%", "<= 4"),
}
"""Unit of each figure, and what it should be."""


def runners_cadence(speed: float) -> float:
    """Steps per second of the runners at ``speed`` [m/s]; above 4.5 m/s as it grows up to there."""
    return float(np.polyval(np.polyfit(_SPEEDS, 2.0 / np.array(_STRIDES), 1), speed))


def runners_curves(speed: float, samples: int) -> dict[str, NDArray[np.float64]]:
    """Curves of thigh, knee and ankle at ``speed`` [m/s] at equal shares of the cycle, each (samples,) [deg]:
    between those of `CURVES`, and those of the nearest speed outside of them."""
    found = {}
    for name in CURVES[_SPEEDS[0]]:
        rows = np.array([CURVES[each][name] for each in _SPEEDS])
        values = [float(np.interp(speed, _SPEEDS, column)) for column in rows.T]
        found[name] = over_cycle(values, samples)
    return found
