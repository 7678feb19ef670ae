"""A person on the learned walk turns its head first, then its body."""

import mujoco
from numpy.typing import NDArray

from locomotion.body.person import JOINT_NAMES
from locomotion.gaits.walk.layout import wrap
from locomotion.paths.command import HEADING_ASKED

__all__ = ["look_ahead"]

_NECK = JOINT_NAMES.index("neck_yaw")
_FARTHEST = 0.9  # [rad] that the head turns at most
_HASTE = 0.3  # [rad] that its servo is ahead of it at most: it turns by 3 rad/s


def look_ahead(yaw: float, command: NDArray, data: mujoco.MjData) -> None:
    """Turn the head of a person who faces ``yaw`` [rad] to where its way leads; writes its target into
    ``data.ctrl``."""
    wanted = min(max(wrap(float(command[HEADING_ASKED]) - yaw), -_FARTHEST), _FARTHEST)
    now = float(data.qpos[7 + _NECK])
    data.ctrl[_NECK] = now + min(max(wanted - now, -_HASTE), _HASTE)
