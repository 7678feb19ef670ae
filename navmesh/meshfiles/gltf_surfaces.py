"""The surfaces of a glTF file's meshes, and what morph targets and skins do to their points.

After the specification of the Khronos Group (glTF 2.0, section 3.7).
"""

from typing import Any, NamedTuple

import numpy as np

from navmesh.meshfiles.gltf_compression import DRACO, draco_mesh
from navmesh.meshfiles.gltf_document import Document
from navmesh.meshfiles.gltf_nodes import numbers_of
from navmesh.meshfiles.strips import strip_faces

__all__ = ["Part", "bone_places", "morphed", "skin_shares", "skinned", "surfaces"]

_MODES = range(7)
_TRIANGLES, _STRIP, _FAN = 4, 5, 6


class Part(NamedTuple):
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
    number: int
    """of the primitive in its mesh"""


def surfaces(document: Document, mesh: dict[str, Any], where: str) -> list[Part]:
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
            found.append(_part(document, primitive, mode, place)._replace(number=number))
    return found


def _part(document: Document, primitive: dict[str, Any], mode: int, where: str) -> Part:
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
    part = Part(
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
        0,
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


def morphed(
    document: Document, node: dict[str, Any], mesh: dict[str, Any], part: Part, where: str
) -> np.ndarray:
    """The points of a part, moved by its morph targets as the node weighs them."""
    if not part.targets or ("weights" not in node and "weights" not in mesh):
        return part.points
    given = node if "weights" in node else mesh
    weights = numbers_of(document, given, "weights", len(given["weights"]), None, where)
    if len(weights) < len(part.targets):
        raise document.error(where, f"{len(weights)} weights for {len(part.targets)} morph targets")
    return part.points + sum(w * target for w, target in zip(weights, part.targets, strict=False))


def bone_places(document: Document, index: Any, placed: np.ndarray, where: str) -> np.ndarray:
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


def skinned(document: Document, part: Part, points: np.ndarray, bones: np.ndarray, where: str) -> np.ndarray:
    """Where its joints move the points of a part. Its node's own place does not count, as the specification
    says; a part without weights stays as it is."""
    if not part.joints:
        return points
    moved = np.zeros_like(points)
    joints, shares = skin_shares(document, part, len(bones), where)
    for joint, share in zip(joints.T, shares.T, strict=True):
        turned = np.einsum("vij,vj->vi", bones[joint, :3, :3], points) + bones[joint, :3, 3]
        moved += share[:, None] * turned
    return moved


def skin_shares(document: Document, part: Part, bones: int, where: str) -> tuple[np.ndarray, np.ndarray]:
    """Which joints of a skin of so many ``bones`` move each point of a part that has weights, (v, k), and the
    shares of each, (v, k) float64, which add up to 1."""
    joints, weights = np.concatenate(part.joints, axis=1), np.concatenate(part.weights, axis=1)
    weighed = np.where(weights > 0.0, joints, 0)
    if joints.dtype.kind != "u" or weighed.max(initial=0) >= bones:
        raise document.error(where, f"its mesh names joints that its skin of {bones} does not have")
    total = weights.sum(axis=1, keepdims=True)
    first = np.arange(weights.shape[1]) == 0
    return weighed, np.where(total > 0.0, weights / np.where(total > 0.0, total, 1.0), first)
