"""Recorded motion of the person: its coordinates, frame by frame, in memory and on disk."""

import os
from dataclasses import dataclass
from typing import Self

import mujoco
import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator

from locomotion.body.models import figure
from locomotion.body.person import JOINT_NAMES
from locomotion.clips.clip import Clip
from locomotion.errors import LocomotionError
from surefoot.files.archive import ArchiveError, read_archive, write_archive
from surefoot.files.schema import Header, Numbers, Schema

__all__ = ["Motion", "load_motion", "lowest_points", "motion_of_clip", "place_on_ground"]

_RATES = (1.0, 1e4)  # [Hz] of a file
_UNIT = 1e-3  # tolerance of a quaternion's length
_RATE = 60.0  # [Hz] frame rate of keyframes played as a motion


@dataclass(frozen=True, eq=False)
class Motion:
    """A motion of the person.

    Attributes:
      name: for display. rate: frames per second.
      qpos: (n, 46) float64 per frame: root position [m], quaternion (w, x, y, z), angles [rad] of
        `person.JOINT_NAMES`; the ground is z = 0.
      grounded: whether the root's height was chosen to put the figure on the ground, so that it was not
      measured.
    """

    name: str
    rate: float
    qpos: NDArray[np.float64]
    grounded: bool = False

    @property
    def duration(self) -> float:
        """[s]"""
        return (len(self.qpos) - 1) / self.rate

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the motion; the file appears whole or not at all."""
        header = {"name": self.name, "rate": self.rate, "grounded": self.grounded}
        header["joints"] = list(JOINT_NAMES)
        write_archive(path, MOTION_FILE.kind, MOTION_FILE.version, header, {"qpos": self.qpos})


class _MotionHeader(Header):
    name: str = ""
    rate: float
    grounded: bool = False
    joints: tuple[str, ...]

    @model_validator(mode="after")
    def _fits_the_person(self) -> Self:
        if self.joints != JOINT_NAMES:
            raise ValueError("the motion of a person with other joints")
        slowest, fastest = _RATES
        if not slowest <= self.rate <= fastest:
            raise ValueError(f"its rate must be {slowest:g} to {fastest:g} Hz, not {self.rate:g}")
        return self


def _check(header: _MotionHeader, arrays: dict[str, np.ndarray]) -> str | None:
    qpos = arrays["qpos"]
    if not len(qpos):
        return "qpos has no frames"
    off = np.abs(np.linalg.norm(qpos[:, 3:7], axis=1) - 1.0) > _UNIT
    return (
        f"frame {int(np.argmax(off))} has a root rotation that is not a unit quaternion"
        if off.any()
        else None
    )


MOTION_FILE = Schema(
    kind="motion",
    version=1,
    header=_MotionHeader,
    arrays={"qpos": Numbers("frames", 7 + len(JOINT_NAMES), low=-1e6, high=1e6)},
    remedy="import it again (surefoot clip)",
    check=_check,
)


def load_motion(path: str | os.PathLike[str]) -> Motion:
    """Read a motion; raises `LocomotionError` if it is missing, cut off, of another version or another
    person."""
    try:
        header, arrays = read_archive(path, MOTION_FILE)
    except ArchiveError as error:
        raise LocomotionError(str(error)) from error
    return Motion(header.name, header.rate, arrays["qpos"], header.grounded)


def motion_of_clip(clip: Clip) -> Motion:
    """A clip of keyframes as a motion: one pass at 60 Hz, straight ahead at the clip's speed, on the
    ground."""
    count = max(round(clip.duration * _RATE), 1) + 1
    shares = np.linspace(0.0, 1.0, count)
    qpos = np.zeros((count, 7 + len(JOINT_NAMES)))
    qpos[:, 0], qpos[:, 2] = clip.speed * clip.duration * shares, clip.root_height
    qpos[:, 3], qpos[:, 5] = np.cos(0.5 * clip.root_pitch), np.sin(0.5 * clip.root_pitch)
    qpos[:, 7:] = clip.sample(shares - 1e-9 * (shares == 1.0))
    qpos[:, 2] -= lowest_points(qpos)
    return Motion(clip.name, (count - 1) / clip.duration, qpos, grounded=True)


def lowest_points(qpos: NDArray[np.float64]) -> NDArray[np.float64]:
    """Height [m], (n,), of the lowest point of the figure in each frame (n, 46)."""
    model = figure()
    data = mujoco.MjData(model)
    touching = model.geom_conaffinity > 0  # capsules and spheres
    radius, half = model.geom_size[touching, 0], model.geom_size[touching, 1]
    lowest = np.empty(len(qpos))
    for i, frame in enumerate(qpos):
        data.qpos[:] = frame
        mujoco.mj_kinematics(model, data)
        along = np.abs(data.geom_xmat[touching, 8])
        lowest[i] = (data.geom_xpos[touching, 2] - half * along - radius).min()
    return lowest


def place_on_ground(qpos: NDArray[np.float64]) -> NDArray[np.float64]:
    """``qpos`` (n, 46) raised or lowered as a whole, so that the figure's lowest point is below the ground z
    = 0 in one frame of ten: at the push-off, where our foot differs from the captured one and digs in."""
    placed = qpos.copy()
    placed[:, 2] -= np.quantile(lowest_points(qpos), 0.1)
    return placed
