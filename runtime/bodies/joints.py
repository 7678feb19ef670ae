"""What a person of any size looks like, and its joints, for those who turn a skeleton by angles."""

from functools import lru_cache

import numpy as np

from locomotion.body.models import figure
from locomotion.body.person import JOINT_NAMES
from runtime.bodies.figure import Figure, Joints

__all__ = ["person_figure", "person_joints"]


@lru_cache(maxsize=256)
def person_figure(size: float = 1.0) -> Figure:
    """What persons of a ``size`` look like, at every level of detail."""
    return Figure.from_model(figure()).scaled(size)


@lru_cache(maxsize=256)
def person_joints(size: float = 1.0) -> Joints:
    """Those of persons of a ``size``, at every level of detail; bodies are those of a person's `Figure`."""
    model = figure()
    joints = [model.joint(name) for name in JOINT_NAMES]
    body = np.array([int(joint.bodyid[0]) - 1 for joint in joints], np.int32)
    offsets = np.array(model.body_pos[1:], dtype=np.float64)[: 1 + int(body.max())]
    offsets[0] = 0.0
    offsets *= size
    return Joints(JOINT_NAMES, body, np.array([joint.axis for joint in joints]), offsets)
