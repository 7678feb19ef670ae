"""Our own person as a character without a mesh."""

import mujoco
import numpy as np

from locomotion.body.models import figure
from locomotion.body.person import BODY_NAMES
from locomotion.characters.character_file import Skeleton, SkinnedMesh
from locomotion.characters.person_measures import person_tree

__all__ = ["person_skeleton"]


def person_skeleton() -> Skeleton:
    """The skeleton of the person in its neutral pose, a bone for each body."""
    model = figure()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    tree = person_tree()
    names = ("pelvis", *tree)
    ids = [model.body(name).id for name in names]
    parents = np.array([names.index(tree[name][0]) if name in tree else -1 for name in names])
    places = np.concatenate([data.xpos[ids], data.xquat[ids]], axis=1)
    origin = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    above = np.where(parents[:, None] < 0, origin, places[parents])
    ones, none = np.ones(len(BODY_NAMES)), np.empty((0, 3))
    mesh = SkinnedMesh(none, none.astype(np.int64), np.empty((0, 4), np.int64), np.empty((0, 4)), none)
    return Skeleton("our person", np.arange(len(names)), names, parents, places, ones, above, ones, {}, mesh)
