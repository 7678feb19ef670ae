"""Convert part of a recorded motion to a clip of keyframes, which a skill can be trained from."""

import os
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.spatial.transform import Rotation

from locomotion.body.person import JOINT_NAMES
from locomotion.clips.clip import Clip
from locomotion.clips.motion import Motion, lowest_points
from locomotion.errors import LocomotionError
from surefoot.files.atomic_write import whole_file

__all__ = ["keyframes_of", "mirrored", "save_clip", "stretch_of"]

_CLOSE = np.deg2rad(1.0)  # [rad] error allowed between keyframes and motion
_STILL = np.deg2rad(0.5)  # [rad] joints that move less stay at zero


def stretch_of(motion: Motion, begin: float, end: float) -> Motion:
    """The frames of ``motion`` from ``begin`` to ``end`` [s]. Raises `LocomotionError` if they are outside of
    the motion, or fewer than two frames."""
    if not 0.0 <= begin < end <= motion.duration + 1e-9:
        raise LocomotionError(
            f"{motion.name}: {begin:g} to {end:g} s is not within its {motion.duration:.3f} s"
        )
    first, last = round(begin * motion.rate), round(end * motion.rate)
    if last <= first:
        raise LocomotionError(f"{motion.name}: {begin:g} to {end:g} s is less than a frame")
    return Motion(motion.name, motion.rate, motion.qpos[first : last + 1], motion.grounded)


def mirrored(motion: Motion) -> Motion:
    """``motion`` with left and right swapped: clips of skills begin on the right foot."""
    qpos = motion.qpos.copy()
    qpos[:, [1, 4, 6]] *= -1.0
    for index, name in enumerate(JOINT_NAMES):
        side, _, joint = name.partition("_")
        other = {"left": "right", "right": "left"}.get(side)
        if other is not None:
            qpos[:, 7 + index] = motion.qpos[:, 7 + JOINT_NAMES.index(f"{other}_{joint}")]
        elif name.endswith(("_roll", "_yaw")):
            qpos[:, 7 + index] *= -1.0
    return Motion(motion.name, motion.rate, qpos, motion.grounded)


def keyframes_of(motion: Motion) -> Clip:
    """``motion`` as a non-cyclic clip, within 1 degree: for each joint as few of its frames as suffice. The
    root's height, lean and speed are the means over the motion."""
    qpos = motion.qpos
    shares = np.linspace(0.0, 1.0, len(qpos))
    channels = {}
    for index, name in enumerate(JOINT_NAMES):
        angles = qpos[:, 7 + index]
        if np.abs(angles).max() > _STILL:
            keys = _keys(shares, angles)
            channels[name] = np.column_stack([shares[keys], angles[keys]])
    if not channels:
        raise LocomotionError(f"{motion.name}: no joint moves away from zero; there is nothing to play")
    turned = Rotation.from_quat(qpos[:, 3:7], scalar_first=True)
    pitch = turned.as_euler("ZYX")[:, 1]
    height = qpos[:, 2] - (lowest_points(qpos) if motion.grounded else 0.0)
    way = float(np.linalg.norm((qpos[-1] - qpos[0])[:2]))
    return Clip(
        motion.name, False, motion.duration, way / motion.duration, float(height.mean()), float(pitch.mean()),
        channels,
    )  # fmt: skip


def _keys(shares: NDArray[np.float64], angles: NDArray[np.float64]) -> list[int]:
    """Frames to interpolate between: both ends, then the frame with the largest error until none is too
    large."""
    if np.ptp(angles) <= _CLOSE:
        return [0]
    keys = [0, len(angles) - 1]
    while True:
        off = np.abs(PchipInterpolator(shares[keys], angles[keys])(shares) - angles)
        worst = int(np.argmax(off))
        if off[worst] <= _CLOSE:
            return keys
        keys = sorted([*keys, worst])


def save_clip(clip: Clip, path: str | os.PathLike[str]) -> None:
    """Write ``clip`` as `locomotion.load_clip` reads it; the file appears whole or not at all."""
    described = {
        "name": clip.name,
        "cyclic": clip.cyclic,
        "duration": round(clip.duration, 4),
        "speed": round(clip.speed, 3),
        "root": {"height": round(clip.root_height, 3), "pitch": round(float(np.rad2deg(clip.root_pitch)), 1)},
    }
    lines = [yaml.safe_dump(described, sort_keys=False), "channels:  # [share of the duration, degrees]\n"]
    for name, keys in clip.channels.items():
        pairs = ", ".join(f"[{share:.4g}, {np.rad2deg(angle):.1f}]" for share, angle in keys)
        lines.append(f"  {name}: [{pairs}]\n")
    with whole_file(Path(path)) as temporary:
        temporary.write_text("".join(lines), encoding="utf-8")
