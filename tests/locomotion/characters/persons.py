"""What a person does, for tests: poses on the plane z = 0."""

import numpy as np

from locomotion.clips.clip import load_clip
from locomotion.clips.motion import motion_of_clip
from locomotion.data import POSTURES
from locomotion.gaits.run.skill import RUN_CLIP
from locomotion.ground.ground import Ground
from locomotion.postures.posture_file import load_postures
from locomotion.recorded.posing import posed, whole_figures
from locomotion.recorded.skeletons import skeleton

__all__ = ["places_of", "plane", "postures", "running"]


def places_of(qpos):
    """Places (n, 20, 7) of the bodies in poses (n, 46)."""
    own = skeleton("full")
    return whole_figures(own, posed(own, qpos[:, 7:], qpos[:, :7]))


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
