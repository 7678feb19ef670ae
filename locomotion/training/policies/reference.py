"""The reference motion: normal gait fitted to the person, so that its feet neither slip nor sink at any
speed.

For each speed the measured curves (`normal_gait`) are first stretched at the hips to the length of the step.
Then a least-squares fit changes hip, knee, ankle and toes a little, with the height of the root and its speed
over the cycle: heel, ball and tip of a bearing foot stay in place at z = 0, the swinging foot stays clear of
the ground, the knee does not overstretch. In the frontal plane the hip and the ankle are solved for, so that
each foot moves on a straight line, level, turned a little outward, while the pelvis sways over it like an
inverted pendulum.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from locomotion.gaits.policy.layout import JOINTS
from locomotion.training.policies.figure import Figure
from locomotion.training.policies.normal_gait import cadence, curve, smooth

__all__ = [
    "COEFFICIENTS", "HARMONICS", "SAMPLES", "SHARES", "SPEEDS", "TWICE", "Gait", "Reference", "between",
    "derivative", "make_reference", "quaternions", "row_of", "stance",
]  # fmt: skip

SAMPLES = 64
"""Rows of a cycle."""
SPEEDS = (0.0, 0.35, 0.6, 0.9, 1.25, 1.6, 2.0, 2.3)
"""[m/s] at which the reference is made; at 0 it steps in place."""
_USUAL = 1.25  # [m/s] of the measured curves
_LEAN, _TOE_OUT = math.radians(2.0), math.radians(6.0)
_HALF_WIDTH = 0.06  # [m] from the line of the walk to each foot
_CLEARANCE = 0.018  # [m] under a swinging foot
_SOFT = 0.3  # [m/s] at which a heel comes down
_HEEL = 0.03  # [m] that it is lifted at the end of the swing
_MOST_RISE = 0.030  # [m] of the root, up and down from its mean
_IN_PLACE, _IN_PLACE_HALF_WIDTH = math.radians(16.0), 0.065  # hip flexion that lifts a foot; [m]
_STEPS_IN_PLACE = 1.8  # [steps/s], as fast as people march
_QUIETER = 0.3  # share of a slow walk's pelvis and arms
FITTED = ("hip_flexion", "knee_flexion", "ankle_flexion", "toe_extension")
_FRONTAL = ("hip_abduction", "hip_rotation", "ankle_inversion")
_STAND = {
    "hip_flexion": 5.0, "knee_flexion": 5.0, "ankle_flexion": 2.0, "hip_abduction": -0.5, "ankle_inversion":
    0.5, "hip_rotation": -5.0, "shoulder_flexion": 0.0, "shoulder_abduction": 7.0, "elbow_flexion": 15.0,
}  # fmt: skip
HARMONICS = 8
_GRAVITY = 9.81
SHARES = np.arange(SAMPLES) / SAMPLES
WAVES = np.stack(
    [np.ones(SAMPLES)]
    + [f(2 * np.pi * k * SHARES) for k in range(1, HARMONICS + 1) for f in (np.cos, np.sin)],
    axis=1,
)
TWICE = np.stack([f(4 * np.pi * k * SHARES) for k in (1, 2) for f in (np.cos, np.sin)], axis=1)
COEFFICIENTS, ROOT = WAVES.shape[1], TWICE.shape[1]


@dataclass(frozen=True)
class Reference:
    """Poses over the cycle: first of the stand, then at each speed; all float64, first axes 1 + ``speeds``
    and `SAMPLES`.

    Attributes:
      speeds, periods: (s,) [m/s], [s].
      joints, rates: (1 + s, n, 24) [rad], [rad/s].
      root: (1 + s, n, 8): sway to the left and height [m]; roll, pitch and yaw [rad]; velocity ahead,
        left, up.
      spin: (1 + s, n, 3) angular velocity in the root's frame [rad/s].
      soles: (1 + s, n, 6, 3) `layout.SOLE_POINTS` from the root, along the heading [m].
      loads: (1 + s, n, 2) what the right and the left foot bear [body weights].
    """

    speeds: NDArray[np.float64]
    periods: NDArray[np.float64]
    joints: NDArray[np.float64]
    rates: NDArray[np.float64]
    root: NDArray[np.float64]
    spin: NDArray[np.float64]
    soles: NDArray[np.float64]
    loads: NDArray[np.float64]


def stance(speed: float) -> float:
    """Share of the cycle in which a foot bears, at ``speed`` [m/s]: 64 % at the usual one, less when faster.
    That is 2 % more than people's, for at both ends it bears next to nothing."""
    return min(0.5 + 0.14 * (_USUAL / max(speed, 0.1)) ** 0.6, 0.66)


def between(low: float, high: float, width: float = 0.01) -> NDArray[np.float64]:
    """1 in an interval of the cycle, 0 outside, (samples,)."""
    return 1.0 / (1.0 + np.exp(-(SHARES - low) / width)) / (1.0 + np.exp((SHARES - high) / width))


def derivative(values: NDArray[np.float64], period: float) -> NDArray[np.float64]:
    """Rate of a periodic curve (n, ...)."""
    spectrum = np.fft.rfft(values, axis=0)
    waves = 2j * np.pi / period * np.arange(len(spectrum))
    return np.fft.irfft(spectrum * waves.reshape(-1, *[1] * (values.ndim - 1)), len(values), axis=0)


def quaternions(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 4) of roll, pitch and yaw (n, 3), turned about x first and z last."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(angles.T / 2), np.sin(angles.T / 2)
    return np.stack(
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ],
        axis=1,
    )


def _spin_of(turned: NDArray[np.float64], period: float) -> NDArray[np.float64]:
    """Angular velocity (n, 3) [rad/s], in the body's frame, of attitudes (n, 4) over a cycle."""
    spin, n = np.empty((len(turned), 3)), len(turned)
    for k in range(n):
        mujoco.mju_subQuat(spin[k], turned[(k + 1) % n], turned[k - 1])
    return spin * n / (2.0 * period)


class Gait:
    """The gait at one speed while it is fitted."""

    def __init__(self, figure: Figure, speed: float) -> None:
        self.model, self.speed = figure.model, speed
        self.period = 2.0 / (cadence(speed) if speed > 0.0 else _STEPS_IN_PLACE)
        self.half_width = _HALF_WIDTH if speed > 0.0 else _IN_PLACE_HALF_WIDTH
        self.toe_out = _TOE_OUT
        self.data, self.figure = mujoco.MjData(figure.model), figure
        self.feet = [figure.model.body(f"{side}_foot").id for side in ("right", "left")]
        self.joints = np.zeros((SAMPLES, len(JOINTS)))
        self.attitude = np.stack(
            [0.9 * curve("pelvis_roll", SAMPLES), np.full(SAMPLES, _LEAN), curve("pelvis_yaw", SAMPLES)],
            axis=1,
        )
        for axis in (0, 2):  # left and right alike
            values = self.attitude[:, axis]
            self.attitude[:, axis] = 0.5 * (values - np.roll(values, SAMPLES // 2))
        self.height = np.zeros(SAMPLES)
        pendulum = 1.0 + (2.0 * np.pi / self.period) ** 2 / 10.3
        self.sway = -1.27 * (self.half_width + 0.003) / pendulum * np.sin(2 * np.pi * (SHARES - 0.03))
        self.ahead = np.full(SAMPLES, speed)
        self._begin()

    def put(self, name: str, values: NDArray[np.float64]) -> None:
        """Set a joint of both legs or arms; ``values`` of the right one."""
        self.joints[:, JOINTS.index(f"right_{name}")] = values
        self.joints[:, JOINTS.index(f"left_{name}")] = np.roll(values, SAMPLES // 2)

    def _begin(self) -> None:
        vigour = min(max((self.speed - 0.4) / 0.85, 0.0), 1.5)
        loading = np.exp(-(((SHARES - 0.14) / 0.08) ** 2))
        self.put(
            "knee_flexion", curve("knee_flexion", SAMPLES) + (vigour - 1.0) * math.radians(8.0) * loading
        )
        self.put("ankle_flexion", curve("ankle_flexion", SAMPLES) * (0.7 + 0.3 * vigour))
        self.put("toe_extension", curve("toe_extension", SAMPLES) * (0.6 + 0.4 * min(vigour, 1.2)))
        swing = 0.45 + 0.55 * vigour
        for name in ("shoulder_flexion", "elbow_flexion"):
            values = curve(name, SAMPLES)
            self.put(name, values.mean() + swing * (values - values.mean()))
        self.put("shoulder_abduction", np.full(SAMPLES, math.radians(7.0)))
        roll, yaw = self.attitude[:, 0], self.attitude[:, 2]
        # trunk roll leans to the right, which is a positive turn about x
        self.joints[:, JOINTS.index("waist_roll")] = -roll
        self.joints[:, JOINTS.index("waist_yaw")] = -1.2 * yaw
        self.joints[:, JOINTS.index("chest_yaw")] = -0.8 * yaw
        self._stretch()

    def _stretch(self) -> None:
        """Scale and shift the hip's curve, until the step has its length and the heel strikes a little above
        the ground."""
        hip = curve("hip_flexion", SAMPLES)
        length, scale, shift = self.speed * self.period / 2.0, 1.0, 0.0
        lowest = np.zeros(SAMPLES)
        for _ in range(40):
            self.put("hip_flexion", hip.mean() + shift + scale * (hip - hip.mean()))
            soles = self.soles()
            lowest = soles[:, :, 2].min(axis=1)
            heel = soles[0, 0, 2] - lowest[0]
            got = soles[0, 0, 0] - soles[0, 3, 0]
            scale += 0.6 * (length - got)
            shift -= 0.8 * min(max(heel - 0.01, -0.02), 0.02)
        self.height = smooth(-lowest, 4)

    def soles(self) -> NDArray[np.float64]:
        """(n, 6, 3) points of the soles with the root at its height over the origin, sway included."""
        found, data = np.empty((SAMPLES, 6, 3)), self.data
        turned = quaternions(self.attitude)
        for k in range(SAMPLES):
            self._pose(k, turned[k])
            found[k] = data.site_xpos[self.figure.soles]
        return found

    def _pose(self, k: int, turned: NDArray[np.float64]) -> None:
        self.data.qpos[:3] = 0.0, self.sway[k], self.height[k]
        self.data.qpos[3:7] = turned
        self.data.qpos[self.figure.angles] = self.joints[k]
        mujoco.mj_kinematics(self.model, self.data)

    def set_straight(self) -> None:
        """Solve hip abduction and rotation and ankle inversion of the right leg: the foot on its line, turned
        outward, level from side to side."""
        columns = [JOINTS.index(f"right_{name}") for name in _FRONTAL]
        wanted, turned = np.array([-self.half_width, -self.toe_out, 0.0]), quaternions(self.attitude)

        def error(k: int) -> NDArray[np.float64]:
            self._pose(k, turned[k])
            frame = self.data.xmat[self.feet[0]].reshape(3, 3)
            middle = self.data.site_xpos[self.figure.soles[:2], 1].mean()
            return np.array([middle, math.atan2(frame[1, 0], frame[0, 0]), frame[2, 1]]) - wanted

        for k in range(SAMPLES):
            for _ in range(5):
                off, slopes = error(k), np.empty((3, 3))
                for j, column in enumerate(columns):
                    self.joints[k, column] += 1e-4
                    slopes[:, j] = (error(k) - off) / 1e-4
                    self.joints[k, column] -= 1e-4
                self.joints[k, columns] -= np.clip(np.linalg.solve(slopes, off), -0.1, 0.1)
        for name, column in zip(_FRONTAL, columns, strict=True):
            self.put(name, smooth(self.joints[:, column], HARMONICS))

    def legs(self) -> dict[str, NDArray[np.float64]]:
        """The curves of the right leg that a fit changes, (n,) each [rad]."""
        return {name: self.joints[:, JOINTS.index(f"right_{name}")].copy() for name in FITTED}

    def change_legs(
        self, begun: dict[str, NDArray[np.float64]], waves: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Add ``waves`` (4 `COEFFICIENTS`,) to what `legs` were; gives the changes (n, 4) [deg]."""
        degrees = WAVES @ waves.reshape(4, COEFFICIENTS).T
        for name, column in zip(FITTED, degrees.T, strict=True):
            self.put(name, begun[name] + np.radians(column))
        return degrees

    def slips(
        self, soles: NDArray[np.float64], bears: Sequence[NDArray[np.float64]], off: float, slip: float
    ) -> list[NDArray[np.float64]]:
        """How far heel, ball and tip, ``soles`` (n, 3, 3), are off z = 0, in units of ``off`` [m], and how
        fast they move, in units of ``slip`` [m/s], as far as each of them ``bears`` (n,)."""
        gone = (np.cumsum(self.ahead) - self.ahead) * self.period / SAMPLES
        along = soles[:, :, 0] + gone[:, None]
        speed = (along[2:] - along[:-2]) / (2.0 * self.period / SAMPLES)
        terms = []
        for k, weight in enumerate(bears):
            terms += [np.sqrt(weight) * soles[:, k, 2] / off, np.sqrt(weight[1:-1]) * speed[:, k] / slip]
        return terms

    def fit(self) -> None:
        """Change hip, knee, ankle, toes, height and speed until the feet neither slip nor sink."""
        begun = self.legs()
        height = self.height.mean()
        ends = stance(self.speed)
        heel, ball = between(-0.02, 0.34) + between(0.98, 1.5), between(0.11, 0.52)
        tip, swing = between(0.14, ends - 0.02), between(ends + 0.05, 0.93)
        strikes, reaches = 1.5 * between(0.93, 1.0, 0.005) / _SOFT, between(0.84, 1.2)

        def change(x: NDArray[np.float64]) -> NDArray[np.float64]:
            """Apply parameters; gives the changes of the joints (n, 4) [deg]."""
            rest = x[4 * COEFFICIENTS :]
            self.height = height + 0.01 * (rest[0] + TWICE @ rest[1 : 1 + ROOT])
            self.ahead = self.speed * (1.0 + 0.1 * TWICE @ rest[1 + ROOT :])
            return self.change_legs(begun, x[: 4 * COEFFICIENTS])

        def residuals(x: NDArray[np.float64]) -> NDArray[np.float64]:
            degrees = change(x)
            soles = self.soles()[:, :3]
            terms = self.slips(soles, (heel, ball, tip), 0.003, 0.06)
            low = soles[:, :, 2].min(axis=1)
            knee = np.degrees(self.joints[:, JOINTS.index("right_knee_flexion")])
            terms += [swing * np.minimum(low - _CLEARANCE, 0.0) / 0.004, np.minimum(low, 0.0) / 0.002]
            terms += [np.minimum(knee - 3.0, 0.0), 0.7 * (degrees / [4.0, 5.0, 2.5, 10.0]).ravel()]
            rest = x[4 * COEFFICIENTS :]
            falls = (np.roll(soles[:, 0, 2], -1) - np.roll(soles[:, 0, 2], 1)) / (2.0 * self.period / SAMPLES)
            terms += [strikes * np.minimum(falls + _SOFT, 0.0)]
            terms += [reaches * np.maximum(soles[:, 0, 2] - _HEEL, 0.0) / 0.006]
            terms += [8.0 * np.maximum(np.abs(TWICE @ rest[1 : 1 + ROOT]) - 100.0 * _MOST_RISE, 0.0)]
            terms += [
                0.3 * rest[: 1 + ROOT],
                6.0 * rest[1 + ROOT :],
                np.diff(degrees, 2, axis=0).ravel() / 3.0,
            ]
            return np.concatenate(terms)

        start = np.zeros(4 * COEFFICIENTS + 1 + 2 * ROOT)
        change(least_squares(residuals, start, max_nfev=14, diff_step=1e-3).x)


def _stand(figure: Figure) -> Gait:
    """A quiet stand, as a gait whose poses are all alike."""
    gait = Gait(figure, SPEEDS[1])
    gait.joints[:], gait.sway[:], gait.ahead[:] = 0.0, 0.0, 0.0
    gait.attitude[:] = 0.0, _LEAN, 0.0
    for name, degrees in _STAND.items():
        gait.put(name, np.full(SAMPLES, math.radians(degrees)))
    gait.height[:] = 0.0
    gait.height -= gait.soles()[:, :, 2].min()
    return gait


def _in_place(figure: Figure) -> Gait:
    """Steps in place: each foot is lifted straight up by hip and knee and put down again, level."""
    gait = Gait(figure, 0.0)
    gait.attitude[:, [0, 2]] *= _QUIETER
    for name in ("shoulder_flexion", "elbow_flexion", "waist_roll", "waist_yaw", "chest_yaw"):
        columns = [k for k, joint in enumerate(JOINTS) if joint.endswith(name)]
        mean = np.radians(_STAND.get(name, 0.0))
        values = gait.joints[:, columns]
        gait.joints[:, columns] = mean + _QUIETER * (values - values.mean(axis=0))
    begins, ends = stance(0.0) + 0.02, 0.98
    share = np.clip((SHARES - begins) / (ends - begins), 0.0, 1.0)
    lifted = _IN_PLACE * np.sin(np.pi * share) ** 2
    for name, part in (("hip_flexion", 1.0), ("knee_flexion", 2.0), ("ankle_flexion", 1.0)):
        gait.put(name, math.radians(_STAND[name]) + part * lifted)
    gait.put("toe_extension", np.zeros(SAMPLES))
    gait.height = np.full(SAMPLES, -np.median(gait.soles()[:, :3, 2].min(axis=1)[SHARES < begins]))
    gait.set_straight()
    gait.height -= np.median(gait.soles()[:, :3, 2].min(axis=1)[SHARES < begins])
    return gait


def make_reference() -> Reference:
    """Fit the reference at all `SPEEDS`; takes some 10 s, always with the same result."""
    figure = Figure(whole=False, timestep=0.005)
    gaits = [_stand(figure), _in_place(figure)]
    for speed in SPEEDS[1:]:
        gait = Gait(figure, speed)
        gait.set_straight()
        gait.fit()
        gait.set_straight()
        gaits.append(gait)
    rows = [row_of(gait) for gait in gaits]
    rows[0]["loads"][:] = 0.5
    arrays = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    return Reference(np.array(SPEEDS), np.array([gait.period for gait in gaits[1:]]), **arrays)


def row_of(gait: Gait) -> dict[str, NDArray[np.float64]]:
    place = np.stack([gait.sway, gait.height], axis=1)
    velocity = np.column_stack([gait.ahead, derivative(place, gait.period)])
    soles = gait.soles()
    soles[:, :, 1:] -= place[:, None]
    return {
        "joints": gait.joints,
        "rates": derivative(gait.joints, gait.period),
        "root": np.hstack([place, gait.attitude, velocity]),
        "spin": _spin_of(quaternions(gait.attitude), gait.period),
        "soles": soles,
        "loads": _loads(gait),
    }


def _loads(gait: Gait) -> NDArray[np.float64]:
    """What both feet bear, (samples, 2): all that holds the root up as it rises and falls, most in the middle
    of the double support, in which the weight goes over evenly from one foot to the other."""
    ends = stance(gait.speed)
    over = ends - 0.5
    swing = abs(np.fft.rfft(gait.height)[2]) / (0.5 * SAMPLES) * (4.0 * np.pi / gait.period) ** 2
    rise = swing * np.cos(4.0 * np.pi * (SHARES - 0.5 * over))
    right = np.clip(np.minimum(SHARES / over, (ends - SHARES) / over), 0.0, 1.0)
    share = np.stack([right, np.roll(right, SAMPLES // 2)], axis=1)
    return (1.0 + rise / _GRAVITY)[:, None] * share
