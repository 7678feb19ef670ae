"""Reads an FBX file with ufbx, in a process of its own: ``python fbx_process.py LEVEL.fbx RESULT.npz``.

Imports nothing of this package, which need not be importable there. Prints a sentence, and leaves with 1, for
a file that is not read.

ufbx's binding is young (0.0.5): an element of a list of nodes is freed once too often, and so are lists that
are read as buffers. So every node is taken out once and kept to the end, lists of numbers are walked through,
and what ends this process nevertheless does not end the one that asked for it.
"""

import os
import sys

import numpy as np
import ufbx

_KEPT: list[object] = []
_SAYS_WHAT_IS_HIDDEN = 6000
"""Version of the format from which on; in older files ufbx finds nothing visible."""


def parts(path: str) -> tuple[dict[str, np.ndarray], str]:
    """What `navmesh.meshfiles.fbx` needs of a file, or a sentence that says why it is not read."""
    try:
        scene = ufbx.load_file(
            path,
            evaluate_skinning=True,
            ignore_embedded=True,
            index_error_handling=ufbx.IndexErrorHandling.NO_INDEX,
        )
    except ufbx.UfbxError as error:
        return {}, f"ufbx: {error or type(error).__name__}"
    found: dict[str, list[np.ndarray]] = {"points": [], "corners": [], "sizes": []}
    names, mirrored = [], []
    nodes = list(scene.nodes)
    _KEPT.extend([scene, *nodes])
    finest = {node.parent.element_id: node.element_id for node in reversed(nodes) if node.parent is not None}
    for node in nodes:
        if node.attrib_type in (ufbx.ElementType.NURBS_SURFACE, ufbx.ElementType.NURBS_TRIM_SURFACE):
            return {}, f"{node.name!r} is a NURBS surface, which is not read; convert it to polygons"
        mesh = node.mesh
        if mesh is None or (scene.metadata.version >= _SAYS_WHAT_IS_HIDDEN and not is_shown(node, finest)):
            continue
        place = np.array(node.geometry_to_world)
        skinned = len(mesh.skin_deformers) > 0 and not mesh.skinned_is_local
        bent = len(mesh.skin_deformers) + len(mesh.blend_deformers) > 0
        points = numbers(mesh.skinned_position.values if bent else mesh.vertices)
        sizes = np.fromiter((face.num_indices for face in mesh.faces), np.int64, len(mesh.faces))
        source = mesh.skinned_position.indices if bent else mesh.vertex_indices
        corners = np.fromiter(source, np.int64, mesh.num_indices)
        kept = ~np.fromiter(mesh.face_hole, bool, len(mesh.face_hole)) if len(mesh.face_hole) else None
        if kept is not None:
            corners, sizes = corners[np.repeat(kept, sizes)], sizes[kept]
        found["points"].append(points if skinned else points @ place[:3] + place[3])
        found["corners"].append(corners)
        found["sizes"].append(sizes)
        names.append(node.name)
        mirrored.append(not skinned and np.linalg.det(place[:3]) < 0.0)
    arrays = {
        "points": np.concatenate([np.empty((0, 3)), *found["points"]]),
        "corners": np.concatenate([np.empty(0, np.int64), *found["corners"]]),
        "sizes": np.concatenate([np.empty(0, np.int64), *found["sizes"]]),
    }
    arrays |= {f"{name}_counts": np.array([len(x) for x in each], np.int64) for name, each in found.items()}
    axes = scene.settings.axes
    arrays |= {"names": np.array(names, dtype=str), "mirrored": np.array(mirrored, dtype=bool)}
    arrays["axes"] = np.array([int(axes.right), int(axes.up), int(axes.front)])
    arrays["unit"] = np.array(scene.settings.unit_meters)
    return arrays, ""


def numbers(points: "ufbx.Vec3List") -> np.ndarray:
    """(n, 3) float64"""
    return np.fromiter((value for point in points for value in point), np.float64, 3 * len(points)).reshape(
        -1, 3
    )


def is_shown(node: "ufbx.Node", finest: dict[int, int]) -> bool:
    """Whether neither a node nor what it belongs to is hidden, or a coarser level of detail: ``finest`` is
    the first child of every node."""
    at: ufbx.Node | None = node
    while at is not None:
        parent = at.parent
        if not at.visible:
            return False
        if parent is not None and parent.attrib_type == ufbx.ElementType.LOD_GROUP:
            if finest[parent.element_id] != at.element_id:
                return False
        at = parent
    return True


if __name__ == "__main__":
    found, problem = parts(sys.argv[1])
    if problem:
        print(problem)
    else:
        with open(sys.argv[2], "wb") as result:
            np.savez(result, allow_pickle=False, **found)
    sys.stdout.flush()
    os._exit(1 if problem else 0)  # nothing is freed
