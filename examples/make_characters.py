"""Makes three rigged characters out of capsules, each proportioned, posed and named in its own way.

    python examples/make_characters.py [folder]

| file | who | bones |
| --- | --- | --- |
| `stout.glb` | 1.3 m, short legs, broad, rests in an A-pose | named as Mixamo's, y along the bones |
| `tall.glb` | 2.1 m, long legs, rests in a T-pose | VRM's names, in centimetres under a node of scale 0.01; no toes, no clavicles, no neck |
| `agent.glb` | 1.8 m, long arms, rests in an A-pose | named as Unreal's mannequin: five spines, two necks, twist bones, x along the bones, mirrored |

glTF 2.0: metres, Y up, facing +Z.
"""  # noqa: E501

import json
import struct
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

__all__ = ["AGENT", "CHARACTERS", "STOUT", "TALL", "Character", "write_character"]

_AROUND, _ALONG = 12, 9  # corners of a ring of a capsule; rings
_SKIN, _CLOTH, _DARK = (0.72, 0.42, 0.28), (0.10, 0.28, 0.55), (0.05, 0.05, 0.07)


@dataclass(frozen=True)
class Character:
    """Measures in metres. ``names``: how its bones are called, by our parts; what is left out, it lacks.

    arms: degrees below the horizontal at rest. axes: which axis of a bone lies along it: "x", "y", or "" for
    bones with the axes of the file. unit: metres per unit below the uppermost node. cloth: a colour.
    """

    name: str
    names: dict[str, str]
    thigh: float
    shank: float
    ankle: float
    hips: float
    trunk: float
    shoulders: float
    upper_arm: float
    forearm: float
    hand: float
    head: float
    girth: float
    heel: float
    ball: float
    tip: float
    arms: float
    axes: str = "y"
    unit: float = 1.0
    spines: tuple[str, ...] = ()
    necks: tuple[str, ...] = ()
    twists: bool = False
    mirrored: bool = False
    cloth: tuple[float, float, float] = _CLOTH
    extensions: dict[str, Any] = field(default_factory=dict)


@dataclass
class _Bone:
    name: str
    parent: int
    at: np.ndarray
    along: np.ndarray
    left: bool = True
    turn: Rotation = field(default_factory=Rotation.identity)


def _bones(who: Character) -> tuple[list[_Bone], dict[str, int]]:
    """The bones, and the number of each part's."""
    bones: list[_Bone] = []
    parts: dict[str, int] = {}

    def add(part: str, name: str, parent: str | int, at: Any, along: Any, left: bool = True) -> int:
        number = parent if isinstance(parent, int) else parts[parent]
        bones.append(_Bone(name, number, np.array(at, float), np.array(along, float), left))
        parts[part] = len(bones) - 1
        return parts[part]

    hip = who.thigh + who.shank + who.ankle
    up = np.array([0.0, 1.0, 0.0])
    above = add("root", who.names["root"], -1, (0, 0, 0), up) if "root" in who.names else -1
    waist = np.array([0.0, hip + 0.03, 0.0])
    add("pelvis", who.names["pelvis"], above, waist, up)
    last = "pelvis"
    for k, name in enumerate(who.spines):
        at = waist + up * who.trunk * (k + 1) / (len(who.spines) + 1)
        add(f"spine{k}", name, last, at, up)
        last = f"spine{k}"
    parts["chest"] = parts[last]
    top = waist + up * who.trunk
    for k, name in enumerate(who.necks):
        add(f"neck{k}", name, last if k == 0 else f"neck{k - 1}", top + up * 0.04 * who.head * k / 0.2, up)
    neck = f"neck{len(who.necks) - 1}" if who.necks else last
    add("head", who.names["head"], neck, top + up * 0.35 * who.head, up)
    slope = np.radians(who.arms)
    for side, x in (("left", 1.0), ("right", -1.0)):
        left = x > 0.0
        out = np.array([x * np.cos(slope), -np.sin(slope), 0.0])
        shoulder = top + np.array([x * who.shoulders, -0.06 * who.trunk, 0.0])
        holder = "chest"
        if f"{side}_clavicle" in who.names:
            at = top + np.array([0.18 * x * who.shoulders, -0.06 * who.trunk, 0.02])
            add(f"{side}_clavicle", who.names[f"{side}_clavicle"], "chest", at, shoulder - at, left)
            holder = f"{side}_clavicle"
        elbow = shoulder + who.upper_arm * out
        wrist = elbow + who.forearm * out
        add(f"{side}_upper_arm", who.names[f"{side}_upper_arm"], holder, shoulder, out, left)
        if who.twists:
            end = side[0]
            at = shoulder + 0.4 * who.upper_arm * out
            add(f"{side}_arm_twist", f"upperarm_twist_01_{end}", f"{side}_upper_arm", at, out, left)
        add(f"{side}_forearm", who.names[f"{side}_forearm"], f"{side}_upper_arm", elbow, out, left)
        if who.twists:
            at = elbow + 0.6 * who.forearm * out
            add(f"{side}_twist", f"lowerarm_twist_01_{side[0]}", f"{side}_forearm", at, out, left)
        add(f"{side}_hand", who.names[f"{side}_hand"], f"{side}_forearm", wrist, out, left)
        add(f"{side}_fingers", f"{who.names[f'{side}_hand']}_fingers", f"{side}_hand",
            wrist + 0.5 * who.hand * out, out, left)  # fmt: skip
    for side, x in (("left", 1.0), ("right", -1.0)):
        left = x > 0.0
        at = np.array([x * who.hips, hip, 0.0])
        knee, ankle = at - who.thigh * up, at - (who.thigh + who.shank) * up
        add(f"{side}_thigh", who.names[f"{side}_thigh"], "pelvis", at, -up, left)
        if who.twists:
            twist = f"thigh_twist_01_{side[0]}"
            add(f"{side}_thigh_twist", twist, f"{side}_thigh", at - 0.4 * who.thigh * up, -up, left)
        add(f"{side}_shank", who.names[f"{side}_shank"], f"{side}_thigh", knee, -up, left)
        ball = np.array([ankle[0], 0.3 * who.ankle, who.ball])
        add(f"{side}_foot", who.names[f"{side}_foot"], f"{side}_shank", ankle, ball - ankle, left)
        if f"{side}_toes" in who.names:
            add(f"{side}_toes", who.names[f"{side}_toes"], f"{side}_foot", ball, (0.0, 0.0, 1.0), left)
    if who.twists:  # as Unreal's: goals that hang on the root
        add("ik", "ik_foot_root", "root", (0, 0, 0), up)
    for bone in bones:
        bone.turn = _turn(who, bone)
    return bones, parts


def _turn(who: Character, bone: _Bone) -> Rotation:
    """Orientation of a bone: its x or y along it."""
    if not who.axes:
        return Rotation.identity()
    along = bone.along / np.linalg.norm(bone.along)
    if who.mirrored and not bone.left:
        along = -along
    side = np.array([0.0, 0.0, 1.0]) if abs(along[2]) < 0.9 else np.array([0.0, 1.0, 0.0])
    third = np.cross(along, side)
    third /= np.linalg.norm(third)
    columns = (
        [along, np.cross(third, along), third] if who.axes == "x" else [third, along, np.cross(third, along)]
    )
    return Rotation.from_matrix(np.stack(columns, axis=1))


class _Mesh:
    """Capsules, each bound to a bone, at its beginning also to the one above."""

    def __init__(self) -> None:
        self.points: list[np.ndarray] = []
        self.normals: list[np.ndarray] = []
        self.joints: list[np.ndarray] = []
        self.weights: list[np.ndarray] = []
        self.faces: dict[tuple[float, float, float], list[np.ndarray]] = {}
        self.count = 0

    def capsule(
        self, start: Any, end: Any, radii: tuple[float, float], bones: list[tuple[float, int]], colour: Any,
        flat: float = 1.0,
    ) -> None:  # fmt: skip
        """From ``start`` to ``end``; ``bones``: from which share of the way on the points hang on which bone,
        changing over a quarter of it. ``flat``: how deep it is, relative to its width."""
        start, end = np.array(start, float), np.array(end, float)
        axis = end - start
        length = np.linalg.norm(axis)
        axis /= length
        aside = np.cross(axis, (0.0, 0.0, 1.0) if abs(axis[2]) < 0.9 else (1.0, 0.0, 0.0))
        aside /= np.linalg.norm(aside)
        deep = np.cross(axis, aside)
        rings = []
        for k in range(4):  # the round end
            angle = 0.5 * np.pi * (1.0 - k / 3.0)
            rings.append((-radii[0] * np.sin(angle), max(radii[0] * np.cos(angle), 1e-4), -np.sin(angle)))
        for k in range(1, _ALONG):
            share = k / _ALONG
            rings.append((share * length, radii[0] + share * (radii[1] - radii[0]), 0.0))
        for k in range(4):
            angle = 0.5 * np.pi * k / 3.0
            rings.append(
                (length + radii[1] * np.sin(angle), max(radii[1] * np.cos(angle), 1e-4), np.sin(angle))
            )
        turn = 2.0 * np.pi * np.arange(_AROUND) / _AROUND
        around = np.cos(turn)[:, None] * aside + flat * np.sin(turn)[:, None] * deep
        points, normals, shares = [], [], []
        for along, radius, lean in rings:
            points.append(start + along * axis + radius * around)
            outward = around / np.linalg.norm(around, axis=1, keepdims=True)
            normals.append(np.sqrt(1.0 - lean**2) * outward + lean * axis)
            shares.append(np.full(_AROUND, along / length))
        joints, weights = _bound(np.concatenate(shares), bones)
        faces = []
        for ring in range(len(rings) - 1):
            for k in range(_AROUND):
                a, b = ring * _AROUND + k, ring * _AROUND + (k + 1) % _AROUND
                faces += [(a, b, b + _AROUND), (a, b + _AROUND, a + _AROUND)]
        last = (len(rings) - 1) * _AROUND
        faces += [(0, k + 1, k) for k in range(1, _AROUND - 1)]
        faces += [(last, last + k, last + k + 1) for k in range(1, _AROUND - 1)]
        self.points.append(np.concatenate(points))
        self.normals.append(np.concatenate(normals))
        self.joints.append(joints)
        self.weights.append(weights)
        self.faces.setdefault(tuple(colour), []).append(np.array(faces) + self.count)
        self.count += len(self.points[-1])


def _bound(shares: np.ndarray, bones: list[tuple[float, int]]) -> tuple[np.ndarray, np.ndarray]:
    joints, weights = np.zeros((len(shares), 4), np.uint16), np.zeros((len(shares), 4), np.float32)
    for k, share in enumerate(shares):
        later = [b for b, (begin, _) in enumerate(bones) if share >= begin - 0.125]
        now = later[-1] if later else 0
        begin, bone = bones[now]
        weight = np.clip((share - begin + 0.125) / 0.25, 0.0, 1.0) if now else 1.0
        joints[k, 0], weights[k, 0] = bone, weight
        if now and bones[now - 1][1] == bone:
            weights[k, 0] = 1.0
        elif now and weight < 1.0:
            joints[k, 1], weights[k, 1] = bones[now - 1][1], 1.0 - weight
    return joints, weights


def _mesh(who: Character, bones: list[_Bone], parts: dict[str, int]) -> _Mesh:
    mesh = _Mesh()
    at = {part: bones[bone].at for part, bone in parts.items()}
    g = who.girth
    spine = [parts["pelvis"], *(parts[f"spine{k}"] for k in range(len(who.spines)))]
    steps = [((k + 0.5) / len(spine), bone) for k, bone in enumerate(spine)]
    steps[0] = (0.0, spine[0])
    top = at["pelvis"] + np.array([0.0, who.trunk, 0.0])
    mesh.capsule(
        at["pelvis"] - [0, 0.02, 0], top - [0, 0.9 * g, 0], (1.05 * g, 1.15 * g), steps, who.cloth, 0.75
    )
    mesh.capsule(top - [0, 0.5 * g, 0], at["head"], (0.5 * g, 0.42 * g), [
        (0.0, parts["chest"]), (0.6, parts["head"] if not who.necks else parts["neck0"]),
    ], _SKIN)  # fmt: skip
    mesh.capsule(at["head"] + [0, 0.2 * who.head, 0.02], at["head"] + [0, 0.55 * who.head, 0.02],
                 (0.40 * who.head, 0.45 * who.head), [(0.0, parts["head"])], _SKIN)  # fmt: skip
    mesh.capsule(at["head"] + [0, 0.3 * who.head, 0.35 * who.head],
                 at["head"] + [0, 0.3 * who.head, 0.5 * who.head],
                 (0.08 * who.head, 0.06 * who.head), [(0.0, parts["head"])], _DARK)  # fmt: skip
    for side in ("left", "right"):
        arm, fore, hand = (parts[f"{side}_{part}"] for part in ("upper_arm", "forearm", "hand"))
        holder = parts.get(f"{side}_clavicle", parts["chest"])
        shoulder, elbow, wrist = (at[f"{side}_{part}"] for part in ("upper_arm", "forearm", "hand"))
        mesh.capsule(top - [0, 0.6 * g, 0], shoulder, (0.55 * g, 0.55 * g),
                     [(0.0, parts["chest"]), (0.45, holder)], who.cloth)  # fmt: skip
        steps = [(0.0, holder), (0.02, arm)]
        mesh.capsule(shoulder, elbow, (0.5 * g, 0.40 * g), steps, who.cloth)
        steps = [(0.0, arm), (0.02, fore)]
        if who.twists:
            steps.append((0.6, parts[f"{side}_twist"]))
        mesh.capsule(elbow, wrist, (0.38 * g, 0.28 * g), steps, _SKIN)
        end = wrist + who.hand * (wrist - elbow) / np.linalg.norm(wrist - elbow)
        mesh.capsule(
            wrist, end, (0.26 * g, 0.22 * g), [(0.0, hand), (0.6, parts[f"{side}_fingers"])], _SKIN, 0.6
        )
        thigh, shank, foot = (parts[f"{side}_{part}"] for part in ("thigh", "shank", "foot"))
        hip, knee, ankle = (at[f"{side}_{part}"] for part in ("thigh", "shank", "foot"))
        mesh.capsule(hip, knee, (0.75 * g, 0.52 * g), [(0.0, parts["pelvis"]), (0.02, thigh)], _DARK)
        mesh.capsule(knee, ankle, (0.50 * g, 0.33 * g), [(0.0, thigh), (0.02, shank)], _DARK)
        half = 0.5 * who.ankle
        heel = np.array([ankle[0], half, -who.heel + half])
        tip = np.array([ankle[0], half, who.tip - half])
        steps = [(0.0, foot)]
        if f"{side}_toes" in parts:
            steps.append(((who.ball + who.heel - half) / (tip[2] - heel[2]), parts[f"{side}_toes"]))
        mesh.capsule(heel, tip, (half, half), steps, (0.45, 0.05, 0.03), 1.0)
        mesh.capsule(ankle, heel + np.array([0.0, 0.0, 0.5 * half]), (0.33 * g, half), [(0.0, foot)], _DARK)
    return mesh


def write_character(who: Character, path: Path) -> None:
    """Write a character as a GLB file."""
    bones, parts = _bones(who)
    mesh = _mesh(who, bones, parts)
    data, views, accessors = bytearray(), [], []

    def add(values: np.ndarray, kind: str, component: int, target: int | None = None, **more: Any) -> int:
        data.extend(b"\0" * (-len(data) % 4))
        content = np.ascontiguousarray(values).tobytes()
        view = {"buffer": 0, "byteOffset": len(data), "byteLength": len(content)}
        views.append(view | ({"target": target} if target else {}))
        data.extend(content)
        accessors.append(
            {"bufferView": len(views) - 1, "count": len(values), "type": kind, "componentType": component}
            | more
        )
        return len(accessors) - 1

    unit = who.unit
    points = (np.concatenate(mesh.points) / unit).astype(np.float32)
    attributes = {
        "POSITION": add(points, "VEC3", 5126, 34962, min=points.min(axis=0).tolist(),
                        max=points.max(axis=0).tolist()),
        "NORMAL": add(np.concatenate(mesh.normals).astype(np.float32), "VEC3", 5126, 34962),
        "JOINTS_0": add(np.concatenate(mesh.joints), "VEC4", 5123, 34962),
        "WEIGHTS_0": add(np.concatenate(mesh.weights), "VEC4", 5126, 34962),
    }  # fmt: skip
    primitives, materials = [], []
    for colour, faces in mesh.faces.items():
        indices = add(np.concatenate(faces).astype(np.uint32).reshape(-1), "SCALAR", 5125, 34963)
        surface = {"baseColorFactor": [*colour, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.8}
        materials.append({"pbrMetallicRoughness": surface})
        primitives.append({"attributes": attributes, "indices": indices, "material": len(materials) - 1})
    bound = np.tile(np.eye(4), (len(bones), 1, 1))
    nodes: list[dict[str, Any]] = []
    for b, bone in enumerate(bones):
        bound[b, :3, :3], bound[b, :3, 3] = bone.turn.as_matrix(), bone.at / unit
        above = bones[bone.parent] if bone.parent >= 0 else _Bone("", -1, np.zeros(3), np.zeros(3))
        place = above.turn.inv().apply(bone.at - above.at) / unit
        node = {"name": bone.name, "translation": place.tolist(),
                "rotation": (above.turn.inv() * bone.turn).as_quat().tolist()}  # fmt: skip
        children = [c for c, other in enumerate(bones) if other.parent == b]
        nodes.append(node | ({"children": children} if children else {}))
    inverse = np.linalg.inv(bound).transpose(0, 2, 1).astype(np.float32).reshape(-1, 16)
    inverse[:, [3, 7, 11]], inverse[:, 15] = 0.0, 1.0
    skin = {"joints": list(range(len(bones))), "inverseBindMatrices": add(inverse, "MAT4", 5126)}
    nodes.append({"name": who.name, "mesh": 0, "skin": 0})
    roots = [b for b, bone in enumerate(bones) if bone.parent < 0]
    nodes.append({"name": "Armature", "children": roots, "scale": [unit] * 3})
    content: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "make_characters.py"},
        "scene": 0, "scenes": [{"nodes": [len(nodes) - 1, len(nodes) - 2]}], "nodes": nodes,
        "meshes": [{"name": who.name, "primitives": primitives}], "materials": materials, "skins": [skin],
        "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(data)}],
    }  # fmt: skip
    if who.extensions:
        content |= {"extensions": who.extensions, "extensionsUsed": list(who.extensions)}
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    data.extend(b"\0" * (-len(data) % 4))
    size = 28 + len(text) + len(data)
    path.write_bytes(b"".join([
        b"glTF", struct.pack("<II", 2, size), struct.pack("<I", len(text)), b"JSON", text,
        struct.pack("<I", len(data)), b"BIN\0", bytes(data),
    ]))  # fmt: skip


def _sides(names: dict[str, str], right: str, left: str) -> dict[str, str]:
    """Names of both sides: {side} stands for ``right`` and ``left``."""
    return {f"right_{part}": name.replace("{side}", right) for part, name in names.items()} | {
        f"left_{part}": name.replace("{side}", left) for part, name in names.items()
    }


_MIXAMO = {
    "clavicle": "mixamorig:{side}Shoulder", "upper_arm": "mixamorig:{side}Arm",
    "forearm": "mixamorig:{side}ForeArm", "hand": "mixamorig:{side}Hand", "thigh": "mixamorig:{side}UpLeg",
    "shank": "mixamorig:{side}Leg", "foot": "mixamorig:{side}Foot", "toes": "mixamorig:{side}ToeBase",
}  # fmt: skip
_VRM = {
    "upper_arm": "{side}UpperArm", "forearm": "{side}LowerArm", "hand": "{side}Hand",
    "thigh": "{side}UpperLeg", "shank": "{side}LowerLeg", "foot": "{side}Foot",
}  # fmt: skip
_UNREAL = {
    "clavicle": "clavicle_{side}", "upper_arm": "upperarm_{side}", "forearm": "lowerarm_{side}",
    "hand": "hand_{side}", "thigh": "thigh_{side}", "shank": "calf_{side}", "foot": "foot_{side}",
    "toes": "ball_{side}",
}  # fmt: skip
STOUT = Character(
    "stout", {"pelvis": "mixamorig:Hips", "head": "mixamorig:Head"} | _sides(_MIXAMO, "Right", "Left"),
    thigh=0.28, shank=0.27, ankle=0.06, hips=0.11, trunk=0.42, shoulders=0.21, upper_arm=0.22, forearm=0.20,
    hand=0.15, head=0.24, girth=0.14, heel=0.06, ball=0.11, tip=0.18, arms=45.0,
    spines=("mixamorig:Spine", "mixamorig:Spine1", "mixamorig:Spine2"), necks=("mixamorig:Neck",),
    cloth=(0.55, 0.20, 0.06),
)  # fmt: skip
TALL = Character(
    "tall", {"pelvis": "hips", "head": "head"} | _sides(_VRM, "right", "left"),
    thigh=0.53, shank=0.55, ankle=0.09, hips=0.10, trunk=0.56, shoulders=0.20, upper_arm=0.33, forearm=0.31,
    hand=0.20, head=0.23, girth=0.095, heel=0.07, ball=0.17, tip=0.24, arms=0.0, axes="", unit=0.01,
    spines=("spine", "chest"), cloth=(0.05, 0.35, 0.16),
)  # fmt: skip
AGENT = Character(
    "agent", {"root": "root", "pelvis": "pelvis", "head": "head"} | _sides(_UNREAL, "r", "l"),
    thigh=0.43, shank=0.42, ankle=0.08, hips=0.10, trunk=0.50, shoulders=0.19, upper_arm=0.32, forearm=0.30,
    hand=0.19, head=0.22, girth=0.10, heel=0.06, ball=0.14, tip=0.21, arms=55.0, axes="x", mirrored=True,
    spines=tuple(f"spine_{k:02}" for k in range(1, 6)), necks=("neck_01", "neck_02"), twists=True,
    cloth=(0.25, 0.10, 0.40),
)  # fmt: skip
CHARACTERS = (STOUT, TALL, AGENT)


def main(folder: Path) -> None:
    """Write all of them into ``folder``."""
    for who in CHARACTERS:
        write_character(who, folder / f"{who.name}.glb")
        print(folder / f"{who.name}.glb")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd())
