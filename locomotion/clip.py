"""Reference clips: keyframes of joint angles in a YAML file, checked and sampled.

A clip names channels (joints of `locomotion.person.JOINT_NAMES`) and gives each a list of
``[share of the duration, degrees]``. Channels that are not named stay at zero. A *cyclic* clip is periodic; a
*mirrored* one gives the right side and the trunk only, and the left side does the same half a cycle later.
"""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from scipy.interpolate import CubicSpline, PchipInterpolator

from locomotion.errors import LocomotionError
from locomotion.person import JOINT_NAMES

__all__ = ["Clip", "load_clip"]

_Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast, where PyYAML was built with it
_KEYS = {"name", "cyclic", "mirrored", "duration", "speed", "root", "channels"}


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
    """One channel at ``at`` (n,): a periodic cubic through the keys, or a monotone one that holds its
    ends."""
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
    """Read and check a clip; raises `LocomotionError` that names the file, the key and what would be
    right."""
    source = Path(path)
    try:
        data = yaml.load(source.read_text(encoding="utf-8"), _Loader)
    except OSError as error:
        raise LocomotionError(f"{source}: cannot be read: {error.strerror}") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise LocomotionError(f"{source}: not YAML: {error}") from error
    if not isinstance(data, dict):
        raise LocomotionError(f"{source}: expected a mapping with the keys {sorted(_KEYS)}")
    unknown = sorted(set(map(str, data)) - _KEYS)
    if unknown:
        raise LocomotionError(f"{source}: unknown key {unknown[0]!r}; the keys are {sorted(_KEYS)}")
    root = data.get("root", {})
    if not isinstance(root, dict):
        raise LocomotionError(f"{source}: 'root' must be a mapping with height [m] and pitch [deg]")
    cyclic, mirrored = bool(data.get("cyclic", False)), bool(data.get("mirrored", False))
    raw = data.get("channels")
    if not isinstance(raw, dict) or not raw:
        raise LocomotionError(f"{source}: 'channels' must map joint names to lists of [share, degrees]")
    channels = {str(name): _keys(source, str(name), keys, cyclic) for name, keys in raw.items()}
    if mirrored:
        channels |= _mirrored(source, channels, cyclic)
    return Clip(
        name=str(data.get("name", source.stem)),
        cyclic=cyclic,
        duration=_number(source, data, "duration", 1e-3),
        speed=_number(source, data, "speed", 0.0),
        root_height=_number(source, root, "height", 0.0),
        root_pitch=float(np.deg2rad(_number(source, root, "pitch", -90.0))),
        channels=channels,
    )


def _number(source: Path, data: dict[str, Any], key: str, low: float) -> float:
    value = data.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float) or not np.isfinite(value) or value < low:
        raise LocomotionError(
            f"{source}: {key!r} must be a finite number of at least {low:g}, found {value!r}"
        )
    return float(value)


def _keys(source: Path, name: str, keys: Any, cyclic: bool) -> np.ndarray:
    """One channel's keyframes with the angles in radians, checked."""
    if name not in JOINT_NAMES:
        raise LocomotionError(
            f"{source}: no joint is called {name!r}; the joints are {', '.join(JOINT_NAMES)}"
        )
    try:
        table = np.array(keys, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise LocomotionError(f"{source}: {name}: expected a list of [share, degrees]") from error
    if (
        table.ndim != 2
        or table.shape[1] != 2
        or len(table) < (2 if cyclic else 1)
        or not np.isfinite(table).all()
    ):
        raise LocomotionError(f"{source}: {name}: expected at least two finite pairs [share, degrees]")
    shares = table[:, 0]
    if shares[0] < 0.0 or shares[-1] > 1.0 or (np.diff(shares) <= 0).any() or (cyclic and shares[-1] >= 1.0):
        raise LocomotionError(f"{source}: {name}: shares must grow from 0 to 1 (below 1 in a cyclic clip)")
    table[:, 1] = np.deg2rad(table[:, 1])
    return table


def _mirrored(source: Path, channels: dict[str, np.ndarray], cyclic: bool) -> dict[str, np.ndarray]:
    """The left side's channels: the right side's, half a cycle later."""
    if not cyclic or any(name.startswith("left_") for name in channels):
        raise LocomotionError(f"{source}: a mirrored clip is cyclic and has no left_ channels")
    result = {}
    for name, keys in channels.items():
        if name.startswith("right_"):
            shifted = keys.copy()
            shifted[:, 0] = np.mod(shifted[:, 0] + 0.5, 1.0)
            result["left_" + name[len("right_") :]] = shifted[np.argsort(shifted[:, 0])]
    return result
