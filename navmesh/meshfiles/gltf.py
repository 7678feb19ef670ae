"""glTF 2.0 and GLB: the scene as triangles, every instance in its place, skins and morph targets at rest.

Metres, Y up. After the specification of the Khronos Group, section 3.7 and the extensions named here.
"""

import os
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from navmesh.meshfiles.gltf_compression import DRACO, draco_mesh
from navmesh.meshfiles.gltf_document import Document
from navmesh.meshfiles.mesh_file import MeshFile, flattened
from navmesh.meshfiles.strips import strip_faces

__all__ = ["read_gltf"]

_MODES = range(7)
_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_MOST_TRIANGLES = 100_000_000
"""A scene of more of them, instances counted, is damage."""


class _Part(NamedTuple):
    """The triangles of a primitive, before skin and morph targets move its points."""

    points: np.ndarray
    """(v, 3) float64"""
    faces: np.ndarray
    """(f, 3) int64"""
    targets: list[np.ndarray]
    """(v, 3) displacements"""
    joints: list[np.ndarray]
    """(v, 4) integers, a set for each four joints"""
    weights: list[np.ndarray]
    """(v, 4) float64"""
    material: str
    """its name; "" for none"""


@np.errstate(over="ignore", invalid="ignore")  # what comes out infinite is refused as a whole
def read_gltf(path: str | os.PathLike[str]) -> MeshFile:
    """The triangles of a file's scene (its default one, or the first; all nodes if it has none). Hidden nodes
    (KHR_node_visibility), points and lines are left out. Raises `MeshFileError` for what is damaged or not
    read."""
    document = Document(path)
    nodes = document.items("nodes")
    order = _order(document, nodes)
    placed = _placed(document, nodes, order)
    shown = _shown(document, nodes, order)
    shapes: dict[int, list[_Part]] = {}
    parts: list[tuple[np.ndarray, np.ndarray]] = []
    materials: list[str] = []
    total = 0
    for index in [each for each, _ in order if each in shown]:
        node, where = nodes[index], f"nodes[{index}]"
        if "mesh" not in node:
            continue
        number = node["mesh"]
        mesh = document.item("meshes", number, where)
        if number not in shapes:
            shapes[number] = _parts(document, mesh, f"meshes[{number}]")
        places = _instances(document, node, placed[index], where)
        total += len(places) * sum(len(part.faces) for part in shapes[number])
        if total > _MOST_TRIANGLES:
            raise document.error(where, f"comes to {total} triangles; at most {_MOST_TRIANGLES} are read")
        moved = [_morphed(document, node, mesh, part, where) for part in shapes[number]]
        if "skin" in node:
            bones = _bones(document, node["skin"], placed, where)
            parts += [(_skinned(document, part, points, bones, where), part.faces) for part, points in
                      zip(shapes[number], moved, strict=True)]  # fmt: skip
            materials += [part.material for part in shapes[number]]
            continue
        for place in places:
            turned = np.linalg.det(place[:3, :3]) < 0.0  # mirrored: what was seen clockwise is not any more
            for part, points in zip(shapes[number], moved, strict=True):
                materials.append(part.material)
                parts.append((points @ place[:3, :3].T + place[:3, 3], part.faces[:, :: -1 if turned else 1]))
    vertices, faces = flattened(parts)
    if not any(materials):
        return MeshFile(vertices, faces, up="y")
    return MeshFile(vertices, faces, up="y", materials=np.repeat(materials, [len(part[1]) for part in parts]))


def _order(document: Document, nodes: list[dict[str, Any]]) -> list[tuple[int, int]]:
    """Every node with its parent (-1: none), parents first, in the file's order otherwise."""
    parents = [-1] * len(nodes)
    for index, node in enumerate(nodes):
        for child in document.items("children", node, int):
            document.item("nodes", child, f"nodes[{index}]")
            if parents[child] >= 0:
                raise document.error(f"nodes[{child}]", f"is a child of {parents[child]} and of {index}")
            parents[child] = index
    order: list[tuple[int, int]] = []
    stack = [index for index in reversed(range(len(nodes))) if parents[index] < 0]
    while stack:
        index = stack.pop()
        order.append((index, parents[index]))
        stack += reversed(nodes[index].get("children", []))
    if len(order) < len(nodes):
        lost = min(set(range(len(nodes))) - {index for index, _ in order})
        raise document.error(f"nodes[{lost}]", "is its own ancestor")
    return order


def _shown(document: Document, nodes: list[dict[str, Any]], order: list[tuple[int, int]]) -> set[int]:
    """The nodes of the scene that are not hidden."""
    scenes = document.items("scenes")
    roots = {index for index, parent in order if parent < 0}
    if scenes:
        scene = document.item("scenes", document.json.get("scene", 0), "scene")
        roots = set(document.items("nodes", scene, int))
    for index in roots:
        document.item("nodes", index, "the scene")
    shown: set[int] = set()
    for index, parent in order:
        visibility = document.extension(nodes[index], "KHR_node_visibility") or {}
        if (index in roots or parent in shown) and visibility.get("visible") is not False:
            shown.add(index)
    return shown


def _placed(document: Document, nodes: list[dict[str, Any]], order: list[tuple[int, int]]) -> np.ndarray:
    """(n, 4, 4): from each node to the scene."""
    placed = np.tile(np.eye(4), (len(nodes), 1, 1))
    for index, parent in order:
        node, where = nodes[index], f"nodes[{index}]"
        if "matrix" in node:
            own = _vector(document, node, "matrix", 16, None, where).reshape(4, 4).T
        else:
            translation = _vector(document, node, "translation", 3, (0.0, 0.0, 0.0), where)
            rotation = _vector(document, node, "rotation", 4, (0.0, 0.0, 0.0, 1.0), where)
            scale = _vector(document, node, "scale", 3, (1.0, 1.0, 1.0), where)
            own = _transforms(document, translation[None], rotation[None], scale[None], where)[0]
        placed[index] = own if parent < 0 else placed[parent] @ own
    return placed


def _vector(
    document: Document, node: dict[str, Any], name: str, count: int, default: Any, where: str
) -> np.ndarray:
    value = node.get(name, default)
    try:
        found = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        found = np.empty(0)
    if found.shape != (count,) or not np.isfinite(found).all():
        raise document.error(where, f"{name} = {value!r}: expected {count} numbers")
    return found


def _transforms(
    document: Document, translation: np.ndarray, rotation: np.ndarray, scale: np.ndarray, where: str
) -> np.ndarray:
    """(n, 4, 4) of translations (n, 3), rotations (n, 4; x, y, z, w) and scales (n, 3)."""
    if not (np.linalg.norm(rotation, axis=1) > 0.0).all():
        raise document.error(where, "a rotation of length 0")
    made = np.zeros((len(translation), 4, 4))
    made[:, :3, :3] = Rotation.from_quat(rotation).as_matrix() * scale[:, None, :]
    made[:, :3, 3] = translation
    made[:, 3, 3] = 1.0
    return made


def _instances(document: Document, node: dict[str, Any], place: np.ndarray, where: str) -> np.ndarray:
    """(n, 4, 4): where a node's mesh stands; once, or as often as EXT_mesh_gpu_instancing says."""
    instancing = document.extension(node, "EXT_mesh_gpu_instancing")
    if instancing is None:
        return place[None]
    named = instancing.get("attributes")
    kinds = {"TRANSLATION": "VEC3", "ROTATION": "VEC4", "SCALE": "VEC3"}
    given = {
        name: document.numbers(named[name], kind, where)
        for name, kind in kinds.items()
        if isinstance(named, dict) and name in named
    }
    counts = {len(each) for each in given.values()}
    if len(counts) != 1:
        raise document.error(where, "EXT_mesh_gpu_instancing needs attributes of one length")
    count = counts.pop()
    translation = given.get("TRANSLATION", np.zeros((count, 3)))
    rotation = given.get("ROTATION", np.tile([0.0, 0.0, 0.0, 1.0], (count, 1)))
    scale = given.get("SCALE", np.ones((count, 3)))
    return place @ _transforms(document, translation, rotation, scale, where)


def _parts(document: Document, mesh: dict[str, Any], where: str) -> list[_Part]:
    """The primitives of a mesh that have a surface."""
    found = []
    for number, primitive in enumerate(document.items("primitives", mesh)):
        place = f"{where}.primitives[{number}]"
        mode = primitive.get("mode", _TRIANGLES)
        if mode not in _MODES:
            raise document.error(place, f"mode = {mode!r}: expected 0 to 6")
        attributes = primitive.get("attributes")
        if not isinstance(attributes, dict):
            raise document.error(place, "has no attributes")
        if mode >= _TRIANGLES and "POSITION" in attributes:
            found.append(_part(document, primitive, mode, place))
    return found


def _part(document: Document, primitive: dict[str, Any], mode: int, where: str) -> _Part:
    attributes = primitive["attributes"]
    draco = document.extension(primitive, DRACO)
    if DRACO not in document.required and "bufferView" in document.item(
        "accessors", attributes["POSITION"], where
    ):
        draco = None  # the file has it plain, too
    stored, faces = ({}, None) if draco is None else draco_mesh(document, draco, where)

    def numbers(name: str, kind: str) -> np.ndarray:
        if name not in stored:
            return document.numbers(attributes[name], kind, f"{where}.{name}")
        found = document.meant(stored[name], document.item("accessors", attributes[name], where))
        return found.reshape(len(found), -1)

    points = numbers("POSITION", "VEC3")
    if faces is None:
        named = np.arange(len(points))
        if "indices" in primitive:
            named = document.numbers(primitive["indices"], "SCALAR", f"{where}.indices")[:, 0]
        faces = _faces(document, named, mode, where)
    if faces.size and not 0 <= faces.min() <= faces.max() < len(points):
        raise document.error(where, f"its indices reach to {faces.max()}; there are {len(points)} points")
    sets = [k for k in range(8) if f"JOINTS_{k}" in attributes and f"WEIGHTS_{k}" in attributes]
    part = _Part(
        points.astype(np.float64),
        faces,
        [
            document.numbers(target["POSITION"], "VEC3", f"{where}.targets").astype(np.float64)
            for target in document.items("targets", primitive)
            if "POSITION" in target
        ],
        [numbers(f"JOINTS_{k}", "VEC4") for k in sets],
        [numbers(f"WEIGHTS_{k}", "VEC4") for k in sets],
        _material(document, primitive, where),
    )
    for each in (*part.targets, *part.joints, *part.weights):
        if len(each) != len(points):
            raise document.error(where, f"has {len(points)} points, but {len(each)} of another attribute")
    if not np.isfinite(part.points).all():
        raise document.error(where, "a point is not finite")
    return part


def _material(document: Document, primitive: dict[str, Any], where: str) -> str:
    """The name of a primitive's material; "" for none, or for one without a name."""
    if "material" not in primitive:
        return ""
    name = document.item("materials", primitive["material"], where).get("name", "")
    return name if isinstance(name, str) else ""


def _faces(document: Document, named: np.ndarray, mode: int, where: str) -> np.ndarray:
    """(f, 3): the triangles that indices (n,) make in a ``mode``, all turned as the first."""
    named = named.astype(np.int64)
    if mode == _TRIANGLES:
        if len(named) % 3:
            raise document.error(where, f"{len(named)} indices; triangles have three each")
        return named.reshape(-1, 3)
    if mode == _FAN:
        step = np.arange(max(len(named) - 2, 0))
        return np.stack([named[step + 1], named[step + 2], np.broadcast_to(named[:1], len(step))], axis=1)
    return strip_faces(named, np.array([len(named)]))


def _morphed(
    document: Document, node: dict[str, Any], mesh: dict[str, Any], part: _Part, where: str
) -> np.ndarray:
    """The points of a part, moved by its morph targets as the node weighs them."""
    if not part.targets or ("weights" not in node and "weights" not in mesh):
        return part.points
    given = node if "weights" in node else mesh
    weights = _vector(document, given, "weights", len(given["weights"]), None, where)
    if len(weights) < len(part.targets):
        raise document.error(where, f"{len(weights)} weights for {len(part.targets)} morph targets")
    return part.points + sum(w * target for w, target in zip(weights, part.targets, strict=False))


def _bones(document: Document, index: Any, placed: np.ndarray, where: str) -> np.ndarray:
    """(j, 4, 4): from a mesh, as it was bound to each joint of a skin, to the scene."""
    skin = document.item("skins", index, where)
    place = f"skins[{index}]"
    joints = document.items("joints", skin, int)
    for joint in joints:
        document.item("nodes", joint, place)
    if "inverseBindMatrices" not in skin:
        return placed[joints]
    bound = document.numbers(skin["inverseBindMatrices"], "MAT4", place).reshape(-1, 4, 4)
    if len(bound) < len(joints):
        raise document.error(place, f"{len(joints)} joints, but {len(bound)} inverseBindMatrices")
    return placed[joints] @ bound[: len(joints)].transpose(0, 2, 1)


def _skinned(
    document: Document, part: _Part, points: np.ndarray, bones: np.ndarray, where: str
) -> np.ndarray:
    """Where its joints move the points of a part. Its node's own place does not count, as the specification
    says; a part without weights stays as it is."""
    if not part.joints:
        return points
    joints, weights = np.concatenate(part.joints, axis=1), np.concatenate(part.weights, axis=1)
    weighed = np.where(weights > 0.0, joints, 0)
    if joints.dtype.kind != "u" or weighed.max(initial=0) >= len(bones):
        raise document.error(where, f"its mesh names joints that its skin of {len(bones)} does not have")
    total = weights.sum(axis=1, keepdims=True)
    first = np.arange(weights.shape[1]) == 0
    shares = np.where(total > 0.0, weights / np.where(total > 0.0, total, 1.0), first)
    moved = np.zeros_like(points)
    for joint, share in zip(weighed.T, shares.T, strict=True):
        turned = np.einsum("vij,vj->vi", bones[joint, :3, :3], points) + bones[joint, :3, 3]
        moved += share[:, None] * turned
    return moved
