"""A captured motion comes over to the person; mappings that do not fit are refused."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from locomotion.body.person import JOINT_NAMES
from locomotion.clips.bvh import read_bvh
from locomotion.clips.motion import lowest_points
from locomotion.clips.retargeting import load_mapping, retarget
from locomotion.errors import LocomotionError
from tests.locomotion.clips.tpose import MAPPING, TO_Y_UP, bvh_text, posed


@pytest.fixture
def bvh(tmp_path):
    def write(frames):
        path = tmp_path / "motion.bvh"
        path.write_text(bvh_text(frames))
        return path

    return write


def test_rest_pose_with_the_arms_stretched_out_comes_over_as_it_is(bvh):
    motion = retarget(read_bvh(bvh([{}, {}])), MAPPING)
    assert motion.qpos.shape == (2, 46) and motion.rate == pytest.approx(60.0, abs=0.01)
    turns, places = posed(motion.qpos[0])
    for side, sign in (("left", 1.0), ("right", -1.0)):
        arm = places[f"{side}_hand"] - places[f"{side}_upper_arm"]
        assert np.allclose(arm / np.linalg.norm(arm), [0, sign, 0], atol=1e-6)
        assert np.allclose(turns[f"{side}_foot"], np.eye(3), atol=1e-6)
    assert np.allclose(turns["pelvis"], np.eye(3), atol=1e-6)
    assert motion.qpos[0, 2] == pytest.approx(0.90, abs=0.02)
    assert lowest_points(motion.qpos) == pytest.approx([0.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_parts_turn_in_the_world_as_the_captured_joints_do(bvh, seed):
    """Random turns of hips and shoulders (three hinges each) and of knees (one) come over exactly."""
    rng = np.random.default_rng(seed)
    own = {
        name: Rotation.from_rotvec(rng.normal(0, spread, 3))
        for name, spread in (("pelvis", 0.4), ("chest", 0.2))
    }
    frame = {"at": (10.0, 90.0, 30.0)}
    for part, joint in (("pelvis", "Hips"), ("chest", "Chest")):
        frame[joint] = Rotation.from_matrix(TO_Y_UP @ own[part].as_matrix() @ TO_Y_UP.T)
    for side, letter in (("left", "Left"), ("right", "Right")):
        own[side] = Rotation.from_rotvec(rng.normal(0, 0.5, 3))
        frame[letter + "UpLeg"] = Rotation.from_matrix(TO_Y_UP @ own[side].as_matrix() @ TO_Y_UP.T)
        own[side + "knee"] = Rotation.from_rotvec([0.0, rng.uniform(0, 2), 0.0])
        frame[letter + "Leg"] = Rotation.from_matrix(TO_Y_UP @ own[side + "knee"].as_matrix() @ TO_Y_UP.T)
    motion = retarget(read_bvh(bvh([{}, frame])), MAPPING)
    turns, _ = posed(motion.qpos[1])
    assert np.allclose(turns["pelvis"], own["pelvis"].as_matrix(), atol=1e-5)
    for side in ("left", "right"):
        thigh = own["pelvis"] * own[side]
        assert np.allclose(turns[f"{side}_thigh"], thigh.as_matrix(), atol=1e-5)
        assert np.allclose(turns[f"{side}_shank"], (thigh * own[side + "knee"]).as_matrix(), atol=1e-5)
    assert np.allclose(turns["chest"], (own["pelvis"] * own["chest"]).as_matrix(), atol=1e-5)
    assert np.allclose(motion.qpos[1, :2] - motion.qpos[0, :2], [0.3, 0.1], atol=1e-5)


def test_knee_bends_by_its_angle_and_a_bend_it_does_not_have_is_left_out(bvh):
    turns = {"RightLeg": ("X", 40), "LeftLeg": ("Z", 30)}
    bend = {joint: Rotation.from_euler(axis, angle, degrees=True) for joint, (axis, angle) in turns.items()}
    motion = retarget(read_bvh(bvh([bend])), MAPPING)
    angle = dict(zip(JOINT_NAMES, motion.qpos[0, 7:], strict=True))
    assert np.degrees(angle["right_knee_flexion"]) == pytest.approx(40, abs=1e-3)
    assert angle["left_knee_flexion"] == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize(("offset", "length"), [("0 0 0", "0"), ("1e5 0 0", r"1e\+03")])
def test_limbs_have_a_length_and_hips_are_beside_each_other(tmp_path, offset, length):
    text, path = bvh_text([{}]), tmp_path / "short.bvh"
    for bone, message in (
        ("0 -41.2 0", r"joint 'LeftLeg' \(left_shank\) is {} m from 'LeftUpLeg' \(left_thigh\)"),
        ("-27.5 0 0", r"'RightForeArm' \(right_forearm\) is {} m .*; a right_upper_arm is 0.001 to 2 m long"),
        ("26.3 0 0", r"joint 'LeftHand' \(left_hand\) is {} m from"),
    ):
        path.write_text(text.replace(f"OFFSET {bone}", f"OFFSET {offset}", 1))
        with pytest.raises(LocomotionError, match=message.format(length)):
            retarget(read_bvh(path), MAPPING)
    path.write_text(text.replace("OFFSET -8.5", "OFFSET 8.5"))
    with pytest.raises(
        LocomotionError, match="the hips 'RightUpLeg' and 'LeftUpLeg' are not beside each other"
    ):
        retarget(read_bvh(path), MAPPING)


def test_mappings_name_parts_and_joints_that_there_are(tmp_path, bvh):
    path = tmp_path / "map.yaml"
    whole = "".join(f"{part}: {joint}\n" for part, joint in MAPPING.items())
    path.write_text(whole)
    assert load_mapping(path) == MAPPING
    for text, message in (
        ("", "1:1: empty; expected a mapping of parts to joints"),
        ("- pelvis", "a mapping is needed, not a list"),
        ("pelvis: Hips\ntail: Hips", "2:1: no part is called 'tail'; the parts are pelvis"),
        (whole.replace("left_shank", "left_shin"), "'left_shin'; did you mean 'left_shank'"),
        ("pelvis: Hips", "has no joint for chest, right_thigh"),
        (whole.replace("chest: Chest", "chest: 5"), "3:8: chest: Input should be a valid string, not 5"),
        (f"{whole}pelvis: Spine", "17:1: 'pelvis' appears twice here"),
        (
            whole.replace("left_shank: LeftLeg", "left_shank: LeftUpLeg"),
            "9:1: left_thigh and left_shank are both mapped to 'LeftUpLeg'; a joint turns one part",
        ),
    ):
        path.write_text(text)
        with pytest.raises(LocomotionError, match=message):
            load_mapping(path)
    capture = read_bvh(bvh([{}]))
    for wrong, message in (
        ({"pelvis": "Rump"}, "no joint called 'Rump'; its joints are Hips, Spine"),
        ({"waist": "Hips"}, "pelvis and waist are both mapped to 'Hips'"),
        ({"tail": "Hips"}, "no part is called 'tail'"),
    ):
        with pytest.raises(LocomotionError, match=message):
            retarget(capture, {**MAPPING, **wrong})


def test_a_joint_that_turns_a_part_has_a_name_of_its_own(tmp_path):
    path = tmp_path / "twins.bvh"
    path.write_text(bvh_text([{}]).replace("JOINT Head", "JOINT Chest"))
    mapping = {part: joint for part, joint in MAPPING.items() if part != "head"}
    with pytest.raises(LocomotionError, match="several joints called 'Chest'"):
        retarget(read_bvh(path), mapping)
