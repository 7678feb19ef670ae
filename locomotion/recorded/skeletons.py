"""The person at three levels of detail: full, medium and low.

Granieri, Crabtree and Badler (1995), "Production and playback of human figure motion for visual simulation",
section 3.2. Medium and low are the same person with some of its joints held straight: the bodies on both
sides of such a joint move as one. So a pose of any level is a pose of the person (`Skeleton.as_qpos`), and a
change of level needs no other figure.

=======  ======  ========  ====
level    bodies  channels  rate
=======  ======  ========  ====
full     20      39        60 Hz
medium   13      22        30 Hz
low      12      17        15 Hz
=======  ======  ========  ====
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from locomotion.body.models import figure
from locomotion.body.person import BODY_NAMES, JOINT_NAMES
from locomotion.errors import LocomotionError

__all__ = ["FULL", "LEVELS", "LOW", "MEDIUM", "Skeleton", "level_number", "skeleton"]

FULL, MEDIUM, LOW = 0, 1, 2
LEVELS = ("full", "medium", "low")
"""Names of the levels; their numbers are `FULL`, `MEDIUM`, `LOW`."""

_ARMS_AND_LEGS = (
    "shoulder_flexion", "shoulder_abduction", "elbow_flexion",
    "hip_flexion", "hip_abduction", "knee_flexion", "ankle_flexion",
)  # fmt: skip
_KEPT = {
    "full": frozenset(name.removeprefix("right_").removeprefix("left_") for name in JOINT_NAMES),
    "medium": frozenset(
        ("waist_pitch", "waist_roll", "waist_yaw", "neck_pitch", "shoulder_rotation", "hip_rotation")
    ).union(_ARMS_AND_LEGS),
    "low": frozenset(("waist_pitch", "shoulder_rotation", *_ARMS_AND_LEGS)),
}
_RATES = {"full": 60.0, "medium": 30.0, "low": 15.0}


@dataclass(frozen=True, eq=False)
class Skeleton:
    """b bodies, joined by hinges that c channels turn.

    Attributes:
        name: its level. rate: [Hz] at which its motion is kept.
        bodies: their names, those of the person; the first is the pelvis, and a parent comes before its
            children. parents: (b,) int64, -1 for the pelvis. offsets: (b, 3) float64 [m], of a body's origin
            in its parent's frame; all frames are parallel in the rest pose.
        channels: names of the joints that move. joints: (c,) int64, their numbers in `JOINT_NAMES`.
        first: (b + 1,) int64: body k is turned by the channels ``first[k]`` to ``first[k + 1]``, in this
            order. axes: (c,) int64, the axis (0 x, 1 y, 2 z) of the body that each turns about. signs: (c,)
            float64, 1 or -1, the direction.
        carrier: (20,) int64: the body that carries each of `BODY_NAMES`. carried: (20, 3) float64 [m]: where
            in its frame.
    """

    name: str
    rate: float
    bodies: tuple[str, ...]
    parents: NDArray[np.int64]
    offsets: NDArray[np.float64]
    channels: tuple[str, ...]
    joints: NDArray[np.int64]
    first: NDArray[np.int64]
    axes: NDArray[np.int64]
    signs: NDArray[np.float64]
    carrier: NDArray[np.int64]
    carried: NDArray[np.float64]

    def as_qpos(self, channels: NDArray[np.float64], roots: NDArray[np.float64]) -> NDArray[np.float64]:
        """Poses of the person (n, 46) float64, of ``channels`` (n, c) [rad] and ``roots`` (n, 7); what is
        held straight is 0."""
        qpos = np.zeros((len(channels), 7 + len(JOINT_NAMES)))
        qpos[:, :7] = roots
        qpos[:, 7 + self.joints] = channels
        return qpos


def level_number(level: str) -> int:
    """The number of a level; `LocomotionError` for an unknown one."""
    if level not in LEVELS:
        raise LocomotionError(f"level {level!r}: valid: {', '.join(LEVELS)}")
    return LEVELS.index(level)


@cache
def skeleton(level: str) -> Skeleton:
    """The skeleton of a level; `LocomotionError` for an unknown one."""
    level_number(level)
    model = figure()
    joints = [
        k
        for k, name in enumerate(JOINT_NAMES)
        if name.removeprefix("right_").removeprefix("left_") in _KEPT[level]
    ]
    owner = [int(model.joint(JOINT_NAMES[k]).bodyid[0]) for k in joints]
    ids = {name: model.body(name).id for name in BODY_NAMES}
    kept = [ids["pelvis"], *sorted(set(owner))]
    carrier, carried = {}, {}
    for body in sorted(ids.values()):
        if body in kept:
            carrier[body], carried[body] = body, np.zeros(3)
        else:
            above = int(model.body_parentid[body])
            carrier[body], carried[body] = carrier[above], carried[above] + model.body_pos[body]
    parents, offsets = [-1], [np.zeros(3)]
    for body in kept[1:]:
        above = int(model.body_parentid[body])
        parents.append(kept.index(carrier[above]))
        offsets.append(carried[above] + model.body_pos[body])
    axes = np.array([model.joint(JOINT_NAMES[k]).axis for k in joints])
    axis = np.abs(axes).argmax(axis=1)
    return Skeleton(
        name=level,
        rate=_RATES[level],
        bodies=tuple(model.body(body).name for body in kept),
        parents=np.array(parents, np.int64),
        offsets=np.array(offsets),
        channels=tuple(JOINT_NAMES[k] for k in joints),
        joints=np.array(joints, np.int64),
        first=np.searchsorted(owner, [*kept, kept[-1] + 1]).astype(np.int64),
        axes=axis.astype(np.int64),
        signs=axes[np.arange(len(axes)), axis],
        carrier=np.array([kept.index(carrier[ids[name]]) for name in BODY_NAMES], np.int64),
        carried=np.array([carried[ids[name]] for name in BODY_NAMES]),
    )
