"""A rigged figure out of a glTF file: its bones as they rest, and the points of its mesh that hang on them.

Everything is turned from glTF's Y up to Z up, (x, y, z) becoming (x, -z, y), and is in metres.
"""

import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from locomotion.errors import LocomotionError
from navmesh.meshfiles.gltf_document import Document
from navmesh.meshfiles.gltf_nodes import node_order, node_places, shown_nodes
from navmesh.meshfiles.gltf_surfaces import bone_places, skin_shares, skinned, surfaces
from navmesh.meshfiles.mesh_file import MeshFileError

__all__ = ["UPRIGHT", "Skeleton", "SkinnedMesh", "read_character"]

UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""(3, 3): from Y up to Z up."""
_MOST_BONES, _MOST_POINTS = 5_000, 5_000_000
_EVEN = 0.01  # that the scales of a bone along its axes may differ, relative to them


@dataclass(frozen=True, eq=False)
class SkinnedMesh:
    """The triangles of a character as they rest, Z up.

    Attributes:
        points: (v, 3) float64 [m]. faces: (f, 3) int64.
        bones: (v, k) int64 into the skeleton's bones. shares: (v, k) float64 of each, adding up to 1.
        colours: (f, 3) float64, 0 to 1: the materials' base colours.
    """

    points: np.ndarray
    faces: np.ndarray
    bones: np.ndarray
    shares: np.ndarray
    colours: np.ndarray


@dataclass(frozen=True, eq=False)
class Skeleton:
    """The b bones of a character as they rest, parents first; Z up.

    Attributes:
        path: of its file. nodes: (b,) int64, the bones' nodes in the file. names: their names.
        parents: (b,) int64, -1 for a bone that hangs on none.
        places: (b, 7) float64: position [m] and quaternion wxyz in the file's scene.
        scales: (b,) float64: metres per unit of what hangs on the bone.
        above: (b, 7) float64 and above_scales (b,): the same of what each bone hangs on: its parent, else the
            node above it, else the scene.
        humanoid: bones by the names of VRM's own table; empty if the file has none.
        mesh: what is drawn of it. scale: metres per unit of the file.
    """

    path: str
    nodes: np.ndarray
    names: tuple[str, ...]
    parents: np.ndarray
    places: np.ndarray
    scales: np.ndarray
    above: np.ndarray
    above_scales: np.ndarray
    humanoid: dict[str, int]
    mesh: SkinnedMesh
    scale: float = 1.0


def read_character(path: str | os.PathLike[str], scale: float = 1.0) -> Skeleton:
    """Read the skinned figure of a glTF 2.0 file (.glb, .gltf): all bones of all skins that its scene shows.

    scale: metres per unit of the file. Raises `LocomotionError` for what is damaged, has no skin, or has
    bones that are mirrored or stretched more along one axis than along another.
    """
    try:
        with np.errstate(over="ignore", invalid="ignore"):  # what comes out infinite is refused
            return _read(Document(path), scale)
    except MeshFileError as error:
        raise LocomotionError(f"{error.path}: cannot be read as a character: {error.problem}") from None


def _read(document: Document, scale: float) -> Skeleton:
    nodes = document.items("nodes")
    order = node_order(document, nodes)
    upright = np.eye(4)
    upright[:3, :3] = scale * UPRIGHT
    placed = upright @ node_places(document, nodes, order)
    shown = shown_nodes(document, nodes, order)
    dressed = [k for k, _ in order if k in shown and "skin" in nodes[k] and "mesh" in nodes[k]]
    if not dressed:
        raise document.error("", "it shows no mesh with a skin; a character needs one that is bound to bones")
    joints = {joint for k in dressed for joint in _joints(document, nodes[k]["skin"], f"nodes[{k}]")}
    parent_of = dict(order)
    bones = [k for k, _ in order if k in _with_those_between(joints, parent_of)]
    if not 0 < len(bones) <= _MOST_BONES:
        raise document.error("skins", f"{len(bones)} bones; a character has 1 to {_MOST_BONES}")
    number = {node: b for b, node in enumerate(bones)}
    parents = np.array([number.get(parent_of[k], -1) for k in bones])
    places, scales = _similar(document, bones, placed)
    above, above_scales = places[parents].copy(), scales[parents].copy()
    for b in np.flatnonzero(parents < 0):
        node = parent_of[bones[b]]
        here = upright[None] if node < 0 else placed[[node]]
        one, size = _similar(document, [node], here, named=False)
        above[b], above_scales[b] = one[0], size[0]
    names = tuple(_name(nodes[k], k) for k in bones)
    return Skeleton(
        str(document.path), np.array(bones), names, parents, places, scales, above, above_scales,
        _humanoid(document, number), _mesh(document, dressed, placed, number), scale,
    )  # fmt: skip


def _joints(document: Document, skin: Any, where: str) -> list[int]:
    found = document.items("joints", document.item("skins", skin, where), int)
    for joint in found:
        document.item("nodes", joint, f"skins[{skin}]")
    return found


def _with_those_between(joints: set[int], parent_of: dict[int, int]) -> set[int]:
    """The joints, and the nodes that join one of them to another above it."""
    found = set(joints)
    for joint in joints:
        between: list[int] = []
        above = parent_of[joint]
        while above >= 0 and above not in found:
            between.append(above)
            above = parent_of[above]
        if above >= 0:
            found.update(between)
    return found


def _similar(
    document: Document, nodes: list[int], placed: np.ndarray, named: bool = True
) -> tuple[np.ndarray, np.ndarray]:
    """Positions and quaternions (n, 7) and scales (n,) of nodes whose matrices are those in ``placed``, by
    the nodes' numbers if ``named``."""
    matrices = placed[nodes] if named else placed
    axes = matrices[:, :3, :3]
    sizes = np.linalg.norm(axes, axis=1)
    scales = sizes.mean(axis=1)
    found = np.zeros((len(nodes), 7))
    for k, node in enumerate(nodes):
        where = f"nodes[{node}]"
        if not np.isfinite(matrices[k]).all() or not 1e-9 < scales[k] < 1e9:
            raise document.error(where, "its place is not finite, or its scale is 0")
        turn = axes[k] / sizes[k]
        if np.ptp(sizes[k]) > _EVEN * scales[k] or np.abs(turn.T @ turn - np.eye(3)).max() > _EVEN:
            raise document.error(
                where, "a bone is scaled differently along its axes; apply the scales before exporting it"
            )
        if np.linalg.det(turn) < 0.0:
            raise document.error(where, "a bone is mirrored; apply the scales before exporting it")
        found[k, :3] = matrices[k, :3, 3]
        found[k, 3:] = Rotation.from_matrix(turn).as_quat(scalar_first=True)
    return found, scales


def _name(node: dict[str, Any], index: int) -> str:
    name = node.get("name")
    return name if isinstance(name, str) and name else f"nodes[{index}]"


def _humanoid(document: Document, number: dict[int, int]) -> dict[str, int]:
    """Bones by name out of the table of VRM 1.0 or 0.x."""
    found: dict[str, int] = {}
    for extension, newer in (("VRMC_vrm", True), ("VRM", False)):
        humanoid = (document.extension(document.json, extension) or {}).get("humanoid")
        table = humanoid.get("humanBones") if isinstance(humanoid, dict) else None
        entries: list[tuple[Any, Any]] = []
        if newer and isinstance(table, dict):
            entries = list(table.items())
        elif isinstance(table, list):
            entries = [(each.get("bone"), each) for each in table if isinstance(each, dict)]
        for name, entry in entries:
            node = entry.get("node") if isinstance(entry, dict) else None
            if isinstance(name, str) and isinstance(node, int) and node in number:
                found.setdefault(name, number[node])
    return found


def _mesh(document: Document, dressed: list[int], placed: np.ndarray, number: dict[int, int]) -> SkinnedMesh:
    points, faces, bones, shares, colours = [], [], [], [], []
    count = 0
    for k in dressed:
        node, where = document.items("nodes")[k], f"nodes[{k}]"
        mesh = document.item("meshes", node["mesh"], where)
        joints = np.array([number[each] for each in _joints(document, node["skin"], where)], np.int64)
        bound = bone_places(document, node["skin"], placed, where)
        for part in surfaces(document, mesh, f"meshes[{node['mesh']}]"):
            if not part.joints:
                continue
            which, share = skin_shares(document, part, len(bound), where)
            keep = min(which.shape[1], 4)
            most = np.argsort(-share, axis=1, kind="stable")[:, :keep]
            share = np.take_along_axis(share, most, axis=1)
            points.append(skinned(document, part, part.points, bound, where))
            faces.append(part.faces + count)
            bones.append(_four(joints[np.take_along_axis(which, most, axis=1)]))
            shares.append(_four(share / share.sum(axis=1, keepdims=True)))
            colours.append(np.tile(_colour(document, mesh["primitives"][part.number]), (len(part.faces), 1)))
            count += len(part.points)
            if count > _MOST_POINTS:
                raise document.error(where, f"more than {_MOST_POINTS} points")
    if not count:
        raise document.error("", "no point of its mesh is bound to a bone")
    whole = np.concatenate(points)
    if not np.isfinite(whole).all():
        raise document.error("", "a point of its mesh is not finite")
    return SkinnedMesh(
        whole, np.concatenate(faces), np.concatenate(bones), np.concatenate(shares), np.concatenate(colours)
    )


def _four(values: np.ndarray) -> np.ndarray:
    return np.pad(values, ((0, 0), (0, 4 - values.shape[1])))


def _colour(document: Document, primitive: dict[str, Any]) -> np.ndarray:
    """(3,) the base colour of a primitive, as screens take it; grey where its material says none."""
    grey = np.full(3, 0.7)
    if "material" not in primitive:
        return grey
    surface = document.item("materials", primitive["material"], "a primitive").get("pbrMetallicRoughness")
    linear = surface.get("baseColorFactor") if isinstance(surface, dict) else None
    try:
        found = np.array(linear, np.float64)
    except (TypeError, ValueError):
        return grey
    if found.shape != (4,) or not np.isfinite(found).all():
        return grey
    return np.clip(found[:3], 0.0, 1.0) ** (1.0 / 2.2)
