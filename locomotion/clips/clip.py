"""Reference clips: keyframes of joint angles in a YAML file, checked and sampled.

A clip lists for each channel (joints of `locomotion.body.person.JOINT_NAMES`) keyframes ``[share of the
duration, degrees]``. Other channels stay at zero. A *cyclic* clip is periodic; a *mirrored* one gives only
the right side and the trunk, and the left side does the same half a cycle later.
"""

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from locomotion.body.person import JOINT_NAMES
from locomotion.clips.schema import ClipFile
from locomotion.errors import LocomotionError
from surefoot.files.yamlfile import FileError, Located, nearest, read_yaml

__all__ = ["Clip", "load_clip"]

_APART = 1e-6  # least distance of two shares; nearer ones make the curve overflow


@dataclass(frozen=True, eq=False)
class Clip:
    """A reference motion.

    Attributes:
        name: the clip's name.
        cyclic: whether it repeats.
        duration: length [s] of one pass or cycle.
        speed: forward speed [m/s] at which it is meant to be played.
        root_height: mean height [m] of the root. root_pitch: forward lean [rad] of the pelvis.
        channels: per joint name the keyframes, (k, 2) float64: share of the duration in [0, 1], angle [rad].
    """

    name: str
    cyclic: bool
    duration: float
    speed: float
    root_height: float
    root_pitch: float
    channels: dict[str, np.ndarray]

    @property
    def digest(self) -> str:
        """Hex digest of the motion, independent of the file's formatting."""
        numbers = self.cyclic, self.duration, self.speed, self.root_height, self.root_pitch
        hasher = hashlib.sha256(repr(numbers).encode())
        for name in sorted(self.channels):
            hasher.update(name.encode() + self.channels[name].tobytes())
        return hasher.hexdigest()[:16]

    def sample(self, shares: np.ndarray) -> np.ndarray:
        """Joint angles [rad], (n, 39) float64, at ``shares`` (n,) of the duration (wrapped when cyclic)."""
        at = np.asarray(shares, dtype=np.float64)
        at = np.mod(at, 1.0) if self.cyclic else np.clip(at, 0.0, 1.0)
        angles = np.zeros((len(at), len(JOINT_NAMES)))
        for name, keys in self.channels.items():
            angles[:, JOINT_NAMES.index(name)] = _interpolate(keys, at, self.cyclic)
        return angles

    def rates(self, shares: np.ndarray, step: float = 1e-3) -> np.ndarray:
        """Joint rates [rad/s], (n, 39) float64, at ``shares`` (n,), by central differences."""
        at = np.asarray(shares, dtype=np.float64)
        return (self.sample(at + step) - self.sample(at - step)) / (2.0 * step * self.duration)


def _interpolate(keys: np.ndarray, at: np.ndarray, cyclic: bool) -> np.ndarray:
    """One channel at ``at`` (n,): a periodic cubic through the keys, or a monotone one held constant beyond
    its ends."""
    if cyclic:
        times = np.append(keys[:, 0], keys[0, 0] + 1.0)
        angles = np.append(keys[:, 1], keys[0, 1])
        spline = CubicSpline(times, angles, bc_type="periodic")
        return np.asarray(spline(keys[0, 0] + np.mod(at - keys[0, 0], 1.0)))
    if len(keys) == 1:
        return np.full(len(at), keys[0, 1])
    clipped = np.clip(at, keys[0, 0], keys[-1, 0])
    return np.asarray(PchipInterpolator(keys[:, 0], keys[:, 1])(clipped))


def load_clip(path: str | os.PathLike[str]) -> Clip:
    """Read and check a clip; raises `LocomotionError` with file, line, column, key and what would be
    right."""
    try:
        file, located = read_yaml(path, ClipFile, "clip of keyframes")
        channels = {name: _table(located, name, keys, file.cyclic) for name, keys in file.channels.items()}
        if file.mirrored:
            channels |= _mirrored(located, channels, file.cyclic)
    except FileError as error:
        raise LocomotionError(str(error)) from None
    return Clip(
        name=Path(path).stem if file.name is None else file.name,
        cyclic=file.cyclic,
        duration=file.duration,
        speed=file.speed,
        root_height=file.root.height,
        root_pitch=float(np.deg2rad(file.root.pitch)),
        channels=channels,
    )


def _table(located: Located, name: str, keys: list[tuple[float, float]], cyclic: bool) -> np.ndarray:
    """One channel's keyframes, (k, 2) float64, with the angles in radians, checked."""
    here = ["channels", name]
    if name not in JOINT_NAMES:
        hint = nearest(name, JOINT_NAMES)
        raise located.error(
            here, f"no joint is called {name!r}; {hint}valid: {', '.join(JOINT_NAMES)}", at_key=True
        )
    least = 2 if cyclic else 1
    if len(keys) < least:
        raise located.error(here, f"{name}: {len(keys)} keyframes; at least {least} are needed")
    table = np.array(keys, dtype=np.float64)
    for k, apart in enumerate(np.diff(table[:, 0]), 1):
        if apart < _APART:
            raise located.error(
                [*here, k],
                f"{name}: shares must grow, by {_APART:g} or more: {keys[k][0]:g} follows {keys[k - 1][0]:g}",
            )
    if cyclic and table[-1, 0] > table[0, 0] + 1.0 - _APART:
        raise located.error(
            [*here, len(keys) - 1],
            f"{name}: the last share must be below 1 in a cyclic clip, where the first keyframe follows it",
        )
    table[:, 1] = np.deg2rad(table[:, 1])
    return table


def _mirrored(located: Located, channels: dict[str, np.ndarray], cyclic: bool) -> dict[str, np.ndarray]:
    """The left side's channels: the right side's, half a cycle later."""
    if not cyclic or any(name.startswith("left_") for name in channels):
        raise located.error(["mirrored"], "a mirrored clip is cyclic and has no left_ channels")
    result = {}
    for name, keys in channels.items():
        if name.startswith("right_"):
            shifted = keys.copy()
            shifted[:, 0] = np.mod(shifted[:, 0] + 0.5, 1.0)
            result["left_" + name[len("right_") :]] = shifted[np.argsort(shifted[:, 0])]
    return result
