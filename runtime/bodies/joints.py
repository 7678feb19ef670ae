"""The joints of a person, for those who turn a skeleton by angles."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from locomotion.body.models import figure
from locomotion.body.person import JOINT_NAMES

__all__ = ["Joints", "person_joints"]


@dataclass(frozen=True)
class Joints:
    """j hinges, in the order in which they turn their bodies.

    ``names`` (j,); ``body`` (j,) int32: number of the body that each turns; ``axes`` (j, 3) float64: the unit
    vector in that body's frame that it turns about. ``offsets`` (n, 3) float64 [m]: where each body's origin
    is in the frame of its parent; those of the root are 0. With all angles at 0, all frames are parallel.
    """

    names: tuple[str, ...]
    body: np.ndarray
    axes: np.ndarray
    offsets: np.ndarray


@lru_cache(maxsize=1)
def person_joints() -> Joints:
    """Those of all persons, at every level of detail; the bodies are those of a person's `Figure`."""
    model = figure()
    joints = [model.joint(name) for name in JOINT_NAMES]
    body = np.array([int(joint.bodyid[0]) - 1 for joint in joints], np.int32)
    offsets = np.array(model.body_pos[1:], dtype=np.float64)[: 1 + int(body.max())]
    offsets[0] = 0.0
    return Joints(JOINT_NAMES, body, np.array([joint.axis for joint in joints]), offsets)
