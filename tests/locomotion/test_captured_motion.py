"""Captured motion: reading BVH, retargeting it to the person and back, and what a motion does wrong."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from locomotion.bvh import read_bvh
from locomotion.clip import load_clip
from locomotion.errors import LocomotionError
from locomotion.motion import Motion, load_motion, lowest_points, motion_of_clip
from locomotion.motion_check import check_motion
from locomotion.person import JOINT_NAMES, person_spec
from locomotion.retargeting import load_mapping, retarget
from locomotion.skill import RUN_CLIP

pytest.importorskip("bvhio", reason="BVH files are read through bvhio")

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
    text = bvh_text([{}, {}])
    for broken, message in (
        ("", "no line MOTION"),
        ("HIERARCHY\nROOT", "not a BVH file: it has no line MOTION"),
        (text[: len(text) // 3], "not a BVH file: it has no line MOTION"),
        ("MOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0\n", "not a BVH file: 0 braces"),
        (text.replace("}", "", 1), "braces"),
        (text[: text.index("Frame Time")], "Frame Time"),
        (text.replace("HIERARCHY", "TREE"), "not a BVH file"),
        (text.replace("Frames: 2", "Frames: 0"), "frames"),
        (text.replace("Frames: 2", "Frames: 100"), "has 2 of the 100 frames"),
        (
            text[: text.index("Time")] + text[text.index("Time") :].replace("0.000000000", "nan", 9),
            "not finite|must be numerics only",
        ),
    ):
        path = tmp_path / "broken.bvh"
        path.write_text(broken)
        with pytest.raises(LocomotionError, match=message):
            read_bvh(path)


def test_mappings_name_parts_and_joints_that_there_are(tmp_path, bvh):
    path = tmp_path / "map.yaml"
    for text, message in (
        ("- pelvis", "must map parts"),
        ("pelvis: Hips\ntail: Hips", "no part is called 'tail'"),
        ("pelvis: Hips", "says no joint for chest"),
    ):
        path.write_text(text)
        with pytest.raises(LocomotionError, match=message):
            load_mapping(path)
    with pytest.raises(LocomotionError, match="no joint called 'Rump'; its joints are Hips, Spine"):
        retarget(read_bvh(bvh([{}])), {**MAPPING, "pelvis": "Rump"})


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
    whole = (tmp_path / "run.npz").read_bytes()
    (tmp_path / "run.npz").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(LocomotionError, match=r"run\.npz"):
        load_motion(tmp_path / "run.npz")
