"""However a character rests, it shows the same; a figure that does not stand is refused."""

from dataclasses import replace

import numpy as np
import pytest

from examples.make_characters import AGENT, STOUT, TALL, write_character
from locomotion import LocomotionError, Rig
from locomotion.characters.bone_names import bones_of_parts
from locomotion.characters.character_file import read_character
from locomotion.characters.rest_pose import rest_pose
from tests.locomotion.characters.persons import postures, running
from tests.locomotion.characters.test_character_file import changed, node


@pytest.mark.parametrize("who", [STOUT, AGENT], ids=lambda who: who.name)
@pytest.mark.parametrize(
    "other", [{"arms": 0.0}, {"arms": 80.0}, {"axes": "y"}, {"axes": "x"}, {"axes": ""}], ids=str
)
def test_rest_poses_and_axes_of_bones_do_not_matter(rigs, tmp_path, who, other):
    write_character(replace(who, **other), tmp_path / "other.glb")
    rig, places = Rig.load(tmp_path / "other.glb"), np.concatenate([running()[::20], [postures()["sit"]]])
    one, two = rigs[who.name].pose_from(places), rig.pose_from(places)
    # what rests lower on the trunk with the arms down is the shoulders' joint itself: none of our figures
    np.testing.assert_allclose(one[..., :3], two[..., :3], atol=1e-6)


def test_measures(files):
    skeleton = read_character(files["tall"])
    found = rest_pose(skeleton, bones_of_parts(skeleton, None))
    np.testing.assert_allclose(found.thigh, TALL.thigh, atol=1e-6)
    np.testing.assert_allclose(found.forearm, TALL.forearm, atol=1e-6)
    assert found.ankle == pytest.approx(TALL.ankle, abs=1e-3)
    assert found.half_width == pytest.approx(TALL.hips, abs=1e-6)
    assert not found.has_toes


def test_figures_that_do_not_stand_or_are_in_other_units_are_refused(files, tmp_path):
    def lie(document):
        node(document, "Armature")["rotation"] = [0.7071068, 0, 0, 0.7071068]

    with pytest.raises(LocomotionError, match="does not point down at rest"):
        Rig.load(changed(files["stout"], tmp_path, lie))
    with pytest.raises(LocomotionError, match="say so with scale"):
        Rig.load(files["stout"], scale=100.0)


def test_left_and_right_exchanged(files, tmp_path):
    def exchange(document):
        for each in document["nodes"]:
            name = each["name"]
            each["name"] = name.replace("Left", "@").replace("Right", "Left").replace("@", "Right")

    with pytest.raises(LocomotionError, match="left and right are exchanged"):
        Rig.load(changed(files["stout"], tmp_path, exchange), "mixamo")


def test_feet_without_toes_or_mesh_still_stand(files, tmp_path):
    def strip(document):
        """All weight on the pelvis: no point tells where the soles are."""
        joints = document["skins"][0]["joints"]
        document["skins"][0]["joints"] = [joints[0]] * len(joints) + joints
        document["skins"][0].pop("inverseBindMatrices")

    rig = Rig.load(changed(files["stout"], tmp_path, strip))
    pose = rig.pose_from(postures()["stand"])
    foot = pose[rig.names.index(rig.parts["right_foot"])]
    assert 0.02 < foot[2] < 0.1
