"""Captured motion: reading BVH, retargeting it to the person and back, and what a motion does wrong."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from locomotion.body.person import JOINT_NAMES, person_spec
from locomotion.clips.bvh import read_bvh
from locomotion.clips.clip import load_clip
from locomotion.clips.motion import Motion, load_motion, lowest_points, motion_of_clip
from locomotion.clips.motion_check import check_motion
from locomotion.clips.retargeting import load_mapping, retarget
from locomotion.errors import LocomotionError
from locomotion.gaits.run.skill import RUN_CLIP

# A skeleton with the person's own proportions in a T pose, Y up, facing +Z, in centimetres.
BONES = {
    "Hips": (None, (0, 90, 0)),
    "Spine": ("Hips", (0, 12, 0)),
    "Chest": ("Spine", (0, 20, 0)),
    "Head": ("Chest", (0, 23, 0)),
}
for side, sign in (("Left", 1), ("Right", -1)):
    BONES |= {
        f"{side}Arm": ("Chest", (18.5 * sign, 16.5, 0)),
        f"{side}ForeArm": (f"{side}Arm", (27.5 * sign, 0, 0)),
        f"{side}Hand": (f"{side}ForeArm", (26.3 * sign, 0, 0)),
        f"{side}UpLeg": ("Hips", (8.5 * sign, 0, 0)),
        f"{side}Leg": (f"{side}UpLeg", (0, -41.2, 0)),
        f"{side}Foot": (f"{side}Leg", (0, -42.4, 0)),
    }
MAPPING = {"pelvis": "Hips", "waist": "Spine", "chest": "Chest", "head": "Head"}
for side in ("Left", "Right"):
    MAPPING |= {
        f"{side.lower()}_{part}": side + joint
        for part, joint in (
            ("upper_arm", "Arm"), ("forearm", "ForeArm"), ("hand", "Hand"),
            ("thigh", "UpLeg"), ("shank", "Leg"), ("foot", "Foot"),
        )
    }  # fmt: skip
TO_Y_UP = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])  # the person's axes (X ahead, Z up) in the file's


def bvh_text(frames):
    """frames: per frame a dictionary of joint -> rotation from its parent in the file's axes, and "at"
    [cm]."""
    lines, order = ["HIERARCHY"], []

    def write(name, depth):
        parent, offset = BONES[name]
        order.append(name)
        pad = "  " * depth
        lines.append(f"{pad}{'ROOT' if parent is None else 'JOINT'} {name}")
        lines.append(pad + "{")
        lines.append(f"{pad}  OFFSET {offset[0]} {offset[1]} {offset[2]}")
        place = "Xposition Yposition Zposition " if parent is None else ""
        lines.append(f"{pad}  CHANNELS {6 if place else 3} {place}Zrotation Xrotation Yrotation")
        children = [child for child, (above, _) in BONES.items() if above == name]
        for child in children:
            write(child, depth + 1)
        if not children:
            lines.extend([pad + "  End Site", pad + "  {", pad + "    OFFSET 0 1 0", pad + "  }"])
        lines.append(pad + "}")

    write("Hips", 0)
    lines += ["MOTION", f"Frames: {len(frames)}", "Frame Time: 0.0166667"]
    for frame in frames:
        numbers = list(frame.get("at", (0.0, 90.0, 0.0)))
        for name in order:
            turn = frame.get(name, Rotation.identity())
            numbers += list(turn.as_euler("ZXY", degrees=True))
        lines.append(" ".join(f"{x:.9f}" for x in numbers))
    return "\n".join(lines) + "\n"


def posed(qpos):
    """World orientations of the person's parts, by name, and places."""
    model = person_spec().compile()
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    names = [model.body(i).name for i in range(model.nbody)]
    turns = {name: data.xmat[i].reshape(3, 3).copy() for i, name in enumerate(names)}
    return turns, {name: data.xpos[i].copy() for i, name in enumerate(names)}


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


def test_units_and_the_axis_that_points_up_must_fit(bvh):
    path = bvh([{}])
    with pytest.raises(LocomotionError, match=r"would be 1\d\d m tall"):
        read_bvh(path, units="m")
    with pytest.raises(LocomotionError, match="units are one of m, cm"):
        read_bvh(path, units="furlong")
    with pytest.raises(LocomotionError, match="another axis"):
        read_bvh(path, up="z")


def test_files_that_are_no_captures_are_refused(tmp_path, bvh):
    with pytest.raises(LocomotionError, match="no such file"):
        read_bvh(tmp_path / "none.bvh")
    folder = tmp_path / "folder.bvh"
    folder.mkdir()
    with pytest.raises(LocomotionError, match="no such file"):
        read_bvh(folder)
    (tmp_path / "bytes.bvh").write_bytes(bytes(range(256)))
    with pytest.raises(LocomotionError, match="not a BVH file"):
        read_bvh(tmp_path / "bytes.bvh")
    text = bvh_text([{}, {}])
    for broken, message in (
        ("", "1: not a whole BVH file: it ends where HIERARCHY is expected"),
        ("HIERARCHY\nROOT", "2: expected a name after ROOT"),
        ("HIERARCHY\nROOT Hips", "2: not a whole BVH file: it ends where { is expected"),
        (text[: text.index("JOINT Head")], "it ends where } is expected"),
        ("MOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0\n", "must begin with HIERARCHY, not 'MOTION'"),
        (text.replace("HIERARCHY", "TREE"), "must begin with HIERARCHY, not 'TREE'"),
        (text.replace("}", "", 1), "expected JOINT, End Site or }, not 'MOTION'"),
        (text.replace("MOTION", "}\nMOTION"), "expected MOTION"),
        (text.replace("ROOT", "JOINT"), "2: expected ROOT and a name, not 'JOINT Hips'"),
        (text.replace("OFFSET 0 12 0", "OFFSET 0 12"), "expected OFFSET of 'Spine' and three numbers"),
        (text.replace("OFFSET 0 12 0", "OFFSET 0 nan 0"), "the OFFSET of Spine: expected a number .* 'nan'"),
        (text.replace("3 Zrotation", "4 Zrotation", 1), "expected CHANNELS of 'Spine'"),
        (text.replace("3 Zrotation", "3 zrotation", 1), "channel 'zrotation', which is none; valid: Xpos"),
        (text.replace("3 Zrotation", "3 Xrotation", 1), "channel 'Xrotation', twice"),
        (text[: text.index("Frame Time")], "it ends where Frame Time: is expected"),
        (text.replace("Frames: 2", "Frames: 0"), "expected Frames: and how many"),
        (text.replace("Frames: 2", f"Frames: {'9' * 5000}"), "expected Frames: and how many"),
        (text.replace("Frames: 2", "Frames: 1000000"), "take 278 minutes; a capture has at most 10"),
        (text.replace("Frames: 2", "Frames: 100"), "it ends where frame 3 of 100 is expected"),
        (text.replace(" 0.000000000\n", "\n", 1), "frame 1 of 2 has 50 numbers; its joints have 51 channels"),
        (text.replace(" 90.000000000", " 1e39", 1), "Hips Yposition in frame 1 of 2: .* not '1e39'"),
        (text.replace(" 90.000000000", " tall", 1), "Hips Yposition in frame 1 of 2: .* not 'tall'"),
        (text.replace(" 0.000000000\n", " nan\n", 1), "RightFoot Yrotation in frame 1 of 2: .* 'nan'"),
    ):
        path = tmp_path / "broken.bvh"
        path.write_text(broken)
        with pytest.raises(LocomotionError, match=message):
            read_bvh(path)


@pytest.mark.parametrize("time", ["0", "-0.03", "nan", "inf", "33.3", "1e-9", "fast", ""])
def test_frames_come_at_a_rate_that_there_is(tmp_path, time):
    path = tmp_path / "odd.bvh"
    path.write_text(bvh_text([{}, {}]).replace("0.0166667", time))
    with pytest.raises(
        LocomotionError, match=r"odd\.bvh:\d+: expected Frame Time: .* from 0\.0001 to 1, not"
    ):
        read_bvh(path)


def test_lines_end_where_they_do_for_who_reads_the_file(tmp_path):
    """A form feed ends no line: two rows with one between them counted as two, and reading never ended."""
    text = bvh_text([{}, {}])
    head, first, second = text[:-1].rsplit("\n", 2)
    path = tmp_path / "feed.bvh"
    path.write_text(f"{head}\n{first}\f{second}\n")
    with pytest.raises(LocomotionError, match="frame 1 of 2 has 102 numbers"):
        read_bvh(path)


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


def still(seconds=0.5, rate=60.0):
    qpos = np.zeros((round(seconds * rate) + 1, 46))
    qpos[:, 3] = 1.0
    qpos[:, 2] -= lowest_points(qpos[:1])[0]
    return qpos, rate


def test_a_still_stand_has_no_fault_and_faults_are_found_where_they_are():
    qpos, rate = still()
    assert check_motion(Motion("stand", rate, qpos)) == []
    knee = 7 + JOINT_NAMES.index("left_knee_flexion")
    bent = qpos.copy()
    bent[6:13, knee] = np.radians(-12.0)
    (fault,) = check_motion(Motion("bent", rate, bent))
    assert (fault.kind, fault.joint) == ("joint", "left_knee_flexion")
    assert (fault.begin, fault.end) == (pytest.approx(0.1), pytest.approx(0.2))
    assert fault.worst == pytest.approx(10.0, abs=0.1)
    for lift, kind in ((0.2, "floats"), (-0.2, "sinks")):
        moved = qpos + np.eye(1, 46, 2)[0] * lift
        (fault,) = check_motion(Motion("moved", rate, moved))
        assert fault.kind == kind and fault.worst == pytest.approx(0.2) and kind in str(fault)


def test_a_body_in_free_fall_does_not_float():
    qpos, rate = still(0.6)
    time = np.arange(len(qpos)) / rate
    qpos[:, 2] += 3.0 * time - 0.5 * 9.81 * time**2 + 0.0
    faults = check_motion(Motion("jump", rate, qpos))
    assert [fault for fault in faults if fault.kind == "floats"] == []


def test_a_clip_of_keyframes_is_a_motion_on_the_ground(tmp_path):
    clip = load_clip(RUN_CLIP)
    motion = motion_of_clip(clip)
    assert motion.grounded and motion.duration == pytest.approx(clip.duration)
    assert np.abs(lowest_points(motion.qpos)).max() < 1e-9
    assert motion.qpos[-1, 0] == pytest.approx(clip.speed * clip.duration)
    assert check_motion(motion) == []
    motion.save(tmp_path / "run.npz")
    again = load_motion(tmp_path / "run.npz")
    assert (again.name, again.rate, again.grounded) == (motion.name, motion.rate, True)
    assert np.array_equal(again.qpos, motion.qpos)
    for rate, turned in ((0.0, motion.qpos), (np.inf, motion.qpos), (60.0, motion.qpos.astype(np.float32))):
        Motion("odd", rate, turned).save(tmp_path / "odd.npz")
        with pytest.raises(
            LocomotionError, match=r"odd\.npz: not a whole motion.* (1 to 10000 Hz|float64|not finite)"
        ):
            load_motion(tmp_path / "odd.npz")
    whole = (tmp_path / "run.npz").read_bytes()
    (tmp_path / "run.npz").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(LocomotionError, match=r"run\.npz"):
        load_motion(tmp_path / "run.npz")
