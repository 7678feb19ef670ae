"""How people walk: joint curves over the cycle and the pace at each speed, from published measurements.

Legs and pelvis: the mean normal gait that comes with OpenSim (Delp et al. 2007, "OpenSim: open-source
software to create and analyze dynamic simulations of movement", IEEE Trans. Biomed. Eng. 54(11); file
``normal.mot`` of its tutorial on musculoskeletal modelling). Toes and arms: key angles of Perry and
Burnfield (2010), "Gait Analysis: Normal and Pathological Function", and of Murray, Sepic and Barnard (1967),
"Patterns of sagittal rotation of the upper limbs in walking", Phys. Ther. 47(4). Pace: the walk ratio of
Sekiya et al. (1996), "The invariant relationship between step length and step rate during free walking",
J. Hum. Mov. Stud. 30: length and rate of steps are proportional at all speeds.

The cycle begins when the right heel strikes. Signs are those of the person's joints.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

__all__ = ["CURVES", "WALK_RATIO", "cadence", "curve", "smooth"]

WALK_RATIO = 0.373
"""Step length over step rate [m s], of adults: 0.0062 m per step/min."""
_SLOWEST_CADENCE = 1.2  # [steps/s]; the relation was measured at usual speeds
_HARMONICS = 12

_EVERY_4 = {
    "hip_flexion": (24.6, 24.1, 23.0, 20.2, 16.4, 11.9, 7.2, 2.6, -1.9, -6.1, -10.1, -13.5, -15.9, -16.8,
                    -15.4, -10.7, -3.2, 4.9, 12.0, 17.6, 21.8, 24.3, 25.3, 25.0, 24.7),
    "knee_flexion": (3.9, 9.5, 14.8, 17.0, 16.2, 13.9, 11.0, 8.0, 5.4, 3.4, 2.4, 3.0, 5.8, 11.3, 20.2, 32.7,
                     46.2, 55.7, 58.3, 55.1, 47.0, 35.2, 21.2, 8.5, 2.3),
    "ankle_flexion": (-1.7, -4.7, -4.2, -0.8, 1.9, 3.9, 5.3, 6.3, 7.3, 8.4, 9.6, 10.6, 10.5, 8.3, 1.1, -9.7,
                      -14.1, -10.2, -5.3, -1.3, 1.4, 2.6, 2.4, 1.2, 0.1),
    "pelvis_roll": (-0.5, -1.4, -2.8, -3.8, -4.1, -3.5, -2.4, -1.3, -0.4, 0.1, 0.2, 0.3, 0.5, 1.2, 2.3, 3.6,
                    4.4, 4.3, 3.4, 2.2, 1.2, 0.7, 0.4, 0.4, 0.4),
    "pelvis_yaw": (2.4, 2.5, 2.0, 1.7, 1.9, 2.2, 2.3, 2.0, 1.4, 0.7, -0.5, -1.7, -2.8, -3.3, -3.1, -2.7, -2.9,
                   -3.4, -3.6, -3.5, -3.1, -2.6, -1.9, -0.9, 0.1),
}  # fmt: skip
_KNOTS: dict[str, tuple[tuple[float, float], ...]] = {
    **{name: tuple((0.04 * k, v) for k, v in enumerate(values)) for name, values in _EVERY_4.items()},
    "toe_extension": ((0, 6), (0.08, 0), (0.2, 0), (0.4, 0), (0.46, 5), (0.52, 22), (0.58, 38), (0.62, 25),
                      (0.66, 8), (0.75, 2), (0.88, 5)),
    "shoulder_flexion": ((0, -25), (0.25, -7), (0.5, 9), (0.75, -7)),
    "elbow_flexion": ((0, 20), (0.25, 29), (0.5, 42), (0.75, 31)),
}  # fmt: skip
CURVES = tuple(_KNOTS)
"""Names of the curves: joints of the right side, and roll and yaw of the pelvis."""


def smooth(values: NDArray[np.float64], harmonics: int = _HARMONICS) -> NDArray[np.float64]:
    """A periodic curve (n, ...) without its higher harmonics."""
    spectrum = np.fft.rfft(values, axis=0)
    spectrum[harmonics + 1 :] = 0.0
    return np.fft.irfft(spectrum, len(values), axis=0)


def curve(name: str, samples: int) -> NDArray[np.float64]:
    """A curve of `CURVES` at ``samples`` equal shares of the cycle, (samples,) float64 [rad]."""
    shares, degrees = np.array(_KNOTS[name], dtype=np.float64).T
    through = CubicSpline(np.append(shares, 1.0), np.append(degrees, degrees[0]), bc_type="periodic")
    return np.radians(smooth(through(np.linspace(0.0, 1.0, samples, endpoint=False))))


def cadence(speed: float) -> float:
    """Steps per second at ``speed`` [m/s]."""
    return max(float(np.sqrt(speed / WALK_RATIO)), _SLOWEST_CADENCE)
