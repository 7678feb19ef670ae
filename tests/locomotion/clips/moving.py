"""Captures of a person that moves all its joints, in files that rest in any pose."""

import numpy as np
from scipy.spatial.transform import Rotation

from locomotion.clips.bvh import read_bvh
from locomotion.clips.retargeting import retarget

# Joints with their parents and places [m] in a person that stands in a T pose: X ahead, Y left, Z up.
BONES: dict[str, tuple[str | None, tuple[float, float, float]]] = {
    "pelvis": (None, (0, 0, 0.94)), "waist": ("pelvis", (0, 0, 1.07)), "chest": ("waist", (0, 0, 1.2)),
    "head": ("chest", (0, 0, 1.5)),
}  # fmt: skip
for side, sign in (("right", -1), ("left", 1)):
    BONES |= {
        f"{side}_clavicle": ("chest", (0, 0.06 * sign, 1.4)),
        f"{side}_upper_arm": (f"{side}_clavicle", (0, 0.19 * sign, 1.4)),
        f"{side}_forearm": (f"{side}_upper_arm", (0, 0.46 * sign, 1.4)),
        f"{side}_hand": (f"{side}_forearm", (0, 0.72 * sign, 1.4)),
        f"{side}_thigh": ("pelvis", (0, 0.09 * sign, 0.94)),
        f"{side}_shank": (f"{side}_thigh", (0, 0.09 * sign, 0.52)),
        f"{side}_foot": (f"{side}_shank", (0, 0.09 * sign, 0.1)),
        f"{side}_toes": (f"{side}_foot", (0.13, 0.09 * sign, 0.03)),
    }
JOINTS = list(BONES)
PARENTS = [-1 if BONES[name][0] is None else JOINTS.index(str(BONES[name][0])) for name in JOINTS]
PLACES = np.array([BONES[name][1] for name in JOINTS])
TO_Y_UP = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])


def motion(times, seed=0, begins_upright=True):
    """Orientations (n, j, 3, 3) of the joints in the world and places (n, 3) [m] of the root: each joint
    turns about axes of its own, to and fro, knees and elbows as they can."""
    rng = np.random.default_rng(seed)
    turns = np.empty((len(times), len(JOINTS), 3, 3))
    begin = np.minimum(times / 0.4, 1.0)[:, None] if begins_upright else 1.0
    for j, name in enumerate(JOINTS):
        axis, phase = rng.normal(0.0, 0.25, 3), rng.uniform(0.0, 2.0 * np.pi)
        swing = np.sin(5.0 * times + phase)[:, None]
        if name.endswith("shank"):
            axis, swing = np.array([0.0, 0.5, 0.0]), 1.1 + swing
        if name.endswith("forearm"):  # stretched out to its side: bent forward, about Z
            axis, swing = np.array([0.0, 0.0, 0.5 * (-1 if name.startswith("left") else 1)]), 1.1 + swing
        lowered = (
            np.radians(-50.0 if name.startswith("left") else 50.0) if name.endswith("upper_arm") else 0.0
        )
        own = (Rotation.from_rotvec([lowered, 0, 0]) * Rotation.from_rotvec(begin * swing * axis)).as_matrix()
        turns[:, j] = own if PARENTS[j] < 0 else turns[:, PARENTS[j]] @ own
    way = PLACES[0] + np.stack([1.2 * times, 0.1 * np.sin(2.0 * times), 0.02 * np.sin(9.0 * times)], axis=1)
    return turns, way


def bvh_text(turns, way, rests, rate=60.0, units=0.01, axes=TO_Y_UP, prefix=""):
    """A file of the motion whose joints rest turned by ``rests`` (j, 3, 3); lengths in ``units`` [m];
    ``axes`` (3, 3) turns ours to the file's."""
    turned = axes @ turns @ rests @ axes.T
    bones = np.array([place - PLACES[max(PARENTS[j], 0)] for j, place in enumerate(PLACES)])
    bones[0] = 0.0
    bones = np.array([rests[max(PARENTS[j], 0)].T @ bone for j, bone in enumerate(bones)]) @ axes.T / units
    lines, order = ["HIERARCHY"], []

    def write(j, depth):
        pad = "  " * depth
        order.append(j)
        place = "Xposition Yposition Zposition " if PARENTS[j] < 0 else ""
        lines.extend([f"{pad}{'JOINT' if depth else 'ROOT'} {prefix}{JOINTS[j]}", pad + "{"])
        lines.append(f"{pad}  OFFSET {' '.join(f'{x:.9f}' for x in bones[j])}")
        lines.append(f"{pad}  CHANNELS {6 if place else 3} {place}Zrotation Xrotation Yrotation")
        children = [k for k, parent in enumerate(PARENTS) if parent == j]
        for k in children:
            write(k, depth + 1)
        if not children:
            lines.extend([pad + "  End Site", pad + "  {", pad + "    OFFSET 0 0 0", pad + "  }"])
        lines.append(pad + "}")

    write(0, 0)
    lines += ["MOTION", f"Frames: {len(turned)}", f"Frame Time: {1.0 / rate:.9f}"]
    numbers = [way @ axes.T / units]
    for j in order:
        own = turned[:, j] if PARENTS[j] < 0 else np.swapaxes(turned[:, PARENTS[j]], 1, 2) @ turned[:, j]
        numbers.append(Rotation.from_matrix(own).as_euler("ZXY", degrees=True, suppress_warnings=True))
    lines += [" ".join(f"{x:.9f}" for x in row) for row in np.concatenate(numbers, axis=1)]
    return "\n".join(lines) + "\n"


def resting(kind, seed=0):
    """What turns each joint's axes in the T pose to those of a file that rests in another, (j, 3, 3)."""
    rests = np.broadcast_to(np.eye(3), (len(JOINTS), 3, 3)).copy()
    if kind == "A":
        for j, name in enumerate(JOINTS):
            if "arm" in name or "hand" in name:
                angle = 45.0 if name.startswith("left") else -45.0
                rests[j] = Rotation.from_euler("x", angle, degrees=True).as_matrix()
    elif kind == "lying":
        rests[:] = Rotation.from_euler("xyz", (0, 90, 0), degrees=True).as_matrix()
    elif kind == "on its side":
        rests[:] = Rotation.from_euler("xyz", (-90, 0, 0), degrees=True).as_matrix()
    elif kind == "upside down":
        rests[:] = Rotation.from_euler("xyz", (180, 0, 90), degrees=True).as_matrix()
    elif kind == "bones along one axis":
        for j, parent in enumerate(PARENTS):
            children = [k for k, above in enumerate(PARENTS) if above == j]
            bone = PLACES[children[0]] - PLACES[j] if children else PLACES[j] - PLACES[parent]
            rests[j] = Rotation.align_vectors(bone / np.linalg.norm(bone), [1.0, 0.0, 0.0])[0].as_matrix()
    elif kind == "any":
        rests[:] = Rotation.from_quat(np.random.default_rng(seed).normal(size=(len(JOINTS), 4))).as_matrix()
    return rests


def retargeted(folder, turns, way, rests, units="cm", up="y", prefix="", **given):
    """The motion of the person from a file in ``folder`` with what is given."""
    scale = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}[units]
    axes = TO_Y_UP if up == "y" else np.eye(3)
    path = folder / "capture.bvh"
    path.write_text(bvh_text(turns, way, rests, units=scale, axes=axes, prefix=prefix, **given))
    return retarget(read_bvh(path, units, up), {part: prefix + part for part in JOINTS})


TIMES = np.arange(90) / 60.0
RESTS = ["A", "lying", "on its side", "upside down", "bones along one axis", "any"]


def assert_same(one, other):
    assert one.qpos.shape == other.qpos.shape
    assert np.abs(one.qpos - other.qpos).max() < 1e-4  # rad, m: the file's reader has single precision
