"""Captures of a person in a T pose: the file's text, and where the person's parts are in a pose."""

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from locomotion.body.person import person_spec

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
