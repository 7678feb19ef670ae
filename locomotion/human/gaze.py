"""A person on the learned walk turns its head first, then its body."""

from locomotion.body.person import JOINT_NAMES
from locomotion.gaits.walk.layout import wrap
from locomotion.paths.command import HEADING_ASKED
from surefoot.kernels import kernel

__all__ = ["look_ahead"]

_NECK = JOINT_NAMES.index("neck_yaw")
_FARTHEST = 0.9  # [rad] that the head turns at most
_HASTE = 0.3  # [rad] that its servo is ahead of it at most: it turns by 3 rad/s


@kernel
def look_ahead(yaw, command, qpos, ctrl):
    """Turn the head of a person who faces ``yaw`` [rad] to where its way leads; writes its target into
    ``ctrl`` (39,)."""
    wanted = min(max(wrap(command[HEADING_ASKED] - yaw), -_FARTHEST), _FARTHEST)
    now = qpos[7 + _NECK]
    ctrl[_NECK] = now + min(max(wanted - now, -_HASTE), _HASTE)
