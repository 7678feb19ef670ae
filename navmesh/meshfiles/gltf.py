"""glTF 2.0 and GLB: the scene as triangles, every instance in its place, skins and morph targets at rest.

Metres, Y up. After the specification of the Khronos Group, section 3.7 and the extensions named here.
"""

import os
from typing import Any

import numpy as np

from navmesh.meshfiles.gltf_document import Document
from navmesh.meshfiles.gltf_nodes import node_order, node_places, shown_nodes, transforms
from navmesh.meshfiles.gltf_surfaces import Part, bone_places, morphed, skinned, surfaces
from navmesh.meshfiles.mesh_file import MeshFile, flattened

__all__ = ["read_gltf"]

_MOST_TRIANGLES = 100_000_000
"""A scene of more of them, instances counted, is damage."""


@np.errstate(over="ignore", invalid="ignore")  # what comes out infinite is refused as a whole
def read_gltf(path: str | os.PathLike[str]) -> MeshFile:
    """The triangles of a file's scene (its default one, or the first; all nodes if it has none). Hidden nodes
    (KHR_node_visibility), points and lines are left out. Raises `MeshFileError` for what is damaged or not
    read."""
    document = Document(path)
    nodes = document.items("nodes")
    order = node_order(document, nodes)
    placed = node_places(document, nodes, order)
    shown = shown_nodes(document, nodes, order)
    shapes: dict[int, list[Part]] = {}
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
            shapes[number] = surfaces(document, mesh, f"meshes[{number}]")
        places = _instances(document, node, placed[index], where)
        total += len(places) * sum(len(part.faces) for part in shapes[number])
        if total > _MOST_TRIANGLES:
            raise document.error(where, f"comes to {total} triangles; at most {_MOST_TRIANGLES} are read")
        moved = [morphed(document, node, mesh, part, where) for part in shapes[number]]
        if "skin" in node:
            bones = bone_places(document, node["skin"], placed, where)
            parts += [(skinned(document, part, points, bones, where), part.faces) for part, points in
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
    return place @ transforms(document, translation, rotation, scale, where)
