"""The reference motion of a run: how people run, fitted to the person.

Joint curves go through round key angles, about those of Novacheck (1998), "The biomechanics of running", Gait
& Posture 7; rate of steps and time of contact are about those of Nilsson, Thorstensson and Halbertsma (1985),
"Changes in leg movements and muscle activity with speed of locomotion and mode of progression in humans",
Acta Physiol. Scand. 123. They are not digitised from these papers. A foot bears as half a sine wave, and
between the steps the body flies, which says how high it is at each moment. A least-squares fit then changes
hip, knee, ankle and toes a little, until the bearing foot stays where it is.
"""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.optimize import least_squares

from locomotion.gaits.policy.layout import JOINTS
from locomotion.training.policies.figure import Figure
from locomotion.training.policies.normal_gait import smooth
from locomotion.training.policies.reference import (
    COEFFICIENTS,
    HARMONICS,
    SAMPLES,
    SHARES,
    TWICE,
    Gait,
    Reference,
    between,
    quaternions,
    row_of,
)

__all__ = ["SPEEDS", "contact_time", "run_cadence", "with_run"]

SPEEDS = (2.6, 3.2, 3.8, 4.4, 5.0, 5.6)
_GRAVITY = 9.81
_LEAN = math.radians(6.0)
_HALF_WIDTH, _TOE_OUT = 0.035, math.radians(5.0)
_CLEARANCE = 0.04
_ARMS_LEAD = 0.14  # of the cycle: a shoulder is bent most soon after its own side's foot has left the ground
_MOST_ANKLE = 28.0  # [deg] upwards: the joint ends at 30
_KNOTS = {
    "hip_flexion": ((0, 36), (0.25, 32), (0.5, 20), (0.75, 5), (1, -8), (1.1, -10), (1.3, 10), (1.5, 36),
                    (1.7, 49), (1.85, 45)),
    "knee_flexion": ((0, 17), (0.2, 32), (0.45, 43), (0.7, 34), (1, 18), (1.1, 30), (1.35, 86), (1.45, 94),
                     (1.6, 84), (1.8, 40), (1.92, 16)),
    "ankle_flexion": ((0, 5), (0.15, 9), (0.5, 23), (0.75, 12), (1, -20), (1.1, -18), (1.3, -6), (1.6, 2),
                      (1.85, 5)),
    "toe_extension": ((0, 5), (0.1, 0), (0.6, 0), (0.8, 18), (0.95, 30), (1.05, 20), (1.2, 6), (1.6, 4)),
}  # fmt: skip
"""Angles [deg] of the right leg: in the stance at shares of 0 to 1 of it, in the swing at 1 to 2."""


def run_cadence(speed: float) -> float:
    """Steps per second."""
    return 2.35 + 0.145 * speed


def contact_time(speed: float) -> float:
    """[s] that a foot is on the ground."""
    return 0.29 * (speed / 2.5) ** -0.65


class _Run(Gait):
    def __init__(self, figure: Figure, speed: float) -> None:
        self.bears = 0.5 * contact_time(speed) * run_cadence(speed)
        super().__init__(figure, speed)

    def _begin(self) -> None:
        self.period = 2.0 / run_cadence(self.speed)
        self.half_width, self.toe_out = _HALF_WIDTH, _TOE_OUT
        for name in _KNOTS:
            self.put(name, self._curve(name))
        knee = self.joints[:, JOINTS.index("right_knee_flexion")]
        swing = between(self.bears + 0.08, 0.9, 0.03)
        self.put("knee_flexion", knee + math.radians(12.0) * (self.speed - 3.5) * swing)
        wave = np.cos(2 * np.pi * (SHARES - 0.02))
        self.attitude = np.stack(
            [math.radians(3.0) * np.sin(2 * np.pi * (SHARES - 0.02)), np.full(SAMPLES, _LEAN),
             math.radians(5.0) * wave], axis=1,
        )  # fmt: skip
        vigour = 0.8 + 0.2 * (self.speed - 2.6) / 2.4
        arms = np.cos(2 * np.pi * (SHARES + _ARMS_LEAD))
        self.put("shoulder_flexion", math.radians(-12.0) - vigour * math.radians(32.0) * arms)
        self.put("elbow_flexion", math.radians(88.0) - vigour * math.radians(14.0) * arms)
        self.put("shoulder_abduction", np.full(SAMPLES, math.radians(10.0)))
        roll, yaw = self.attitude[:, 0], self.attitude[:, 2]
        self.joints[:, JOINTS.index("waist_roll")] = -roll
        self.joints[:, JOINTS.index("waist_yaw")] = -1.3 * yaw
        self.joints[:, JOINTS.index("chest_yaw")] = -1.0 * yaw
        self.sway = -0.006 * np.sin(2 * np.pi * (SHARES - 0.5 * self.bears + 0.25))
        self.height = self._flight()
        self.height -= (self.soles()[:, :3, 2].min(axis=1))[SHARES < 0.7 * self.bears].mean()
        length = self.speed * contact_time(self.speed)
        hip = self.joints[:, JOINTS.index("right_hip_flexion")].copy()
        scale = 1.0
        for _ in range(30):
            soles = self.soles()
            ends = int(self.bears * SAMPLES) - 1
            got = soles[0, 1, 0] - soles[ends, 1, 0]
            scale += 0.4 * (length * ends / (self.bears * SAMPLES) - got)
            self.put("hip_flexion", hip.mean() + scale * (hip - hip.mean()))

    def _curve(self, name: str) -> NDArray[np.float64]:
        shares, degrees = np.array(_KNOTS[name], dtype=np.float64).T
        at = np.where(shares <= 1.0, shares * self.bears, self.bears + (shares - 1.0) * (1.0 - self.bears))
        at, degrees = np.concatenate([at - 1, at, at + 1]), np.tile(degrees, 3)
        return np.radians(smooth(PchipInterpolator(at, degrees)(SHARES), HARMONICS))

    def loads(self) -> NDArray[np.float64]:
        """What both feet bear, (samples, 2) [body weights]."""
        within = SHARES < self.bears
        right = within * 0.25 * np.pi / self.bears * np.sin(np.pi * np.minimum(SHARES / self.bears, 1.0))
        right *= 0.5 / right.mean()
        return np.stack([right, np.roll(right, SAMPLES // 2)], axis=1)

    def _flight(self) -> NDArray[np.float64]:
        """How high the root is over its mean, (samples,) [m]."""
        spectrum = np.fft.rfft(_GRAVITY * (self.loads().sum(axis=1) - 1.0))
        waves = 2.0 * np.pi / self.period * np.arange(len(spectrum))
        spectrum[1:] /= -(waves[1:] ** 2)
        spectrum[0] = 0.0
        return np.fft.irfft(spectrum, SAMPLES)

    def set_straight(self) -> None:
        """Solve hip abduction of the right leg: the foot on its line."""
        column, turned = JOINTS.index("right_hip_abduction"), quaternions(self.attitude)
        self.put("hip_rotation", np.full(SAMPLES, -self.toe_out))
        self.put("ankle_inversion", np.full(SAMPLES, math.radians(-2.0)))

        def off(k: int) -> float:
            self._pose(k, turned[k])
            return float(self.data.site_xpos[self.figure.soles[:2], 1].mean()) + self.half_width

        for k in range(SAMPLES):
            for _ in range(5):
                before = off(k)
                self.joints[k, column] += 1e-4
                slope = (off(k) - before) / 1e-4
                self.joints[k, column] -= 1e-4 + min(max(before / slope, -0.1), 0.1)
        self.put("hip_abduction", smooth(self.joints[:, column], HARMONICS))

    def fit(self) -> None:
        begun, flight, ends = self.legs(), self._flight(), self.bears
        height = (self.height - flight).mean() + flight
        flat = between(0.0, 0.42 * ends) + between(1.0, 1.5)
        ball = between(0.0, 0.75 * ends) + between(1.0, 1.5)
        tip, swing = between(0.2 * ends, ends - 0.01), between(ends + 0.06, 0.92, 0.02)

        def change(x: NDArray[np.float64]) -> NDArray[np.float64]:
            self.height = height + 0.01 * x[4 * COEFFICIENTS]
            self.ahead = self.speed * (1.0 + 0.1 * TWICE @ x[4 * COEFFICIENTS + 1 :])
            return self.change_legs(begun, x[: 4 * COEFFICIENTS])

        def residuals(x: NDArray[np.float64]) -> NDArray[np.float64]:
            degrees = change(x)
            soles = self.soles()[:, :3]
            terms = self.slips(soles, (flat, ball, tip), 0.004, 0.12)
            low = soles[:, :, 2].min(axis=1)
            knee = np.degrees(self.joints[:, JOINTS.index("right_knee_flexion")])
            terms += [swing * np.minimum(low - _CLEARANCE, 0.0) / 0.006, np.minimum(low, 0.0) / 0.003]
            ankle = np.degrees(self.joints[:, JOINTS.index("right_ankle_flexion")])
            terms += [2.0 * np.maximum(ankle - _MOST_ANKLE, 0.0)]
            terms += [np.minimum(knee - 5.0, 0.0), 0.5 * (degrees / [4.0, 5.0, 2.0, 10.0]).ravel()]
            rest = x[4 * COEFFICIENTS :]
            terms += [0.3 * rest[:1], 8.0 * rest[1:], np.diff(degrees, 2, axis=0).ravel() / 4.0]
            return np.concatenate(terms)

        start = np.zeros(4 * COEFFICIENTS + 1 + TWICE.shape[1])
        change(least_squares(residuals, start, max_nfev=20, diff_step=1e-3).x)


def with_run(walk: Reference) -> Reference:
    """The reference of a ``walk`` with that of a run at `SPEEDS` behind it."""
    figure = Figure(whole=False, timestep=0.005)
    rows, periods = [], []
    for speed in SPEEDS:
        gait = _Run(figure, speed)
        gait.fit()
        gait.set_straight()
        gait.fit()
        gait.set_straight()
        row = row_of(gait)
        row["loads"] = gait.loads()
        rows.append(row)
        periods.append(gait.period)
    arrays = {name: np.concatenate([getattr(walk, name), [row[name] for row in rows]]) for name in rows[0]}
    return Reference(np.append(walk.speeds, SPEEDS), np.append(walk.periods, periods), **arrays)
