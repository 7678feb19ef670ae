"""What a person does, for tests: poses on the plane z = 0."""

import mujoco
import numpy as np

from locomotion.body.models import figure
from locomotion.body.person import BODY_NAMES
from locomotion.clips.clip import load_clip
from locomotion.clips.motion import motion_of_clip
from locomotion.data import POSTURES
from locomotion.gaits.run.skill import RUN_CLIP
from locomotion.ground.ground import Ground
from locomotion.postures.posture_file import load_postures

__all__ = ["places_of", "plane", "postures", "running"]


def places_of(qpos):
    """Places (n, 20, 7) of the bodies in poses (n, 46)."""
    model = figure()
    data = mujoco.MjData(model)
    ids = [model.body(name).id for name in BODY_NAMES]
    found = np.empty((len(qpos), len(ids), 7))
    for k, pose in enumerate(qpos):
        data.qpos[:] = pose
        mujoco.mj_kinematics(model, data)
        found[k, :, :3], found[k, :, 3:] = data.xpos[ids], data.xquat[ids]
    return found


def running():
    """A cycle of the package's own run."""
    return places_of(motion_of_clip(load_clip(RUN_CLIP)).qpos)


def postures():
    """The static postures of the package's own graph, by name."""
    graph = load_postures(POSTURES / "person.yaml")
    return dict(zip(graph.postures, places_of(graph.poses), strict=True))


def plane():
    """The plane z = 0 as a ground."""
    corners = np.array([[-20, -20, 0], [20, -20, 0], [20, 20, 0], [-20, 20, 0]], float)
    return Ground.from_arrays(corners, np.array([[0, 1, 2], [0, 2, 3]]))
