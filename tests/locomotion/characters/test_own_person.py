"""Our own person as a character shows what the person does."""

import numpy as np

from locomotion import Rig
from locomotion.body.person import BODY_NAMES
from locomotion.characters.bone_names import bones_of_parts
from locomotion.characters.own_person import person_skeleton
from tests.locomotion.characters.persons import plane, postures, running


def test_it_is_where_the_person_is():
    skeleton = person_skeleton()
    rig = Rig(skeleton, bones_of_parts(skeleton, "surefoot"))
    order = [BODY_NAMES.index(name) for name in rig.names]
    places = np.concatenate([running()[::4], [postures()["stand"], postures()["crouch"]]])
    poses = rig.pose_from(places)
    off = np.linalg.norm(poses[..., :3] - places[:, order, :3], axis=2)
    trunk = [rig.names.index(name) for name in ("pelvis", "chest", "head", "left_upper_arm", "right_forearm")]
    feet = [rig.names.index(name) for name in ("left_foot", "right_foot", "left_toes")]
    assert off[:, trunk].max() < 0.006  # lowered until straight legs reach
    assert off[:, feet].max() < 0.005
    assert off.max() < 0.05  # a knee that is not quite straight
    grounded = rig.pose_from(places, ground=plane())
    assert grounded.shape == poses.shape and np.isfinite(grounded).all()
