"""The nodes of a glTF file: which hang on which, which are shown, where they are.

After the specification of the Khronos Group (glTF 2.0, section 3.5).
"""

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from navmesh.meshfiles.gltf_document import Document

__all__ = ["node_order", "node_places", "numbers_of", "shown_nodes", "transforms"]


def node_order(document: Document, nodes: list[dict[str, Any]]) -> list[tuple[int, int]]:
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


def shown_nodes(document: Document, nodes: list[dict[str, Any]], order: list[tuple[int, int]]) -> set[int]:
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


def node_places(document: Document, nodes: list[dict[str, Any]], order: list[tuple[int, int]]) -> np.ndarray:
    """(n, 4, 4): from each node to the scene."""
    placed = np.tile(np.eye(4), (len(nodes), 1, 1))
    for index, parent in order:
        node, where = nodes[index], f"nodes[{index}]"
        if "matrix" in node:
            own = numbers_of(document, node, "matrix", 16, None, where).reshape(4, 4).T
        else:
            translation = numbers_of(document, node, "translation", 3, (0.0, 0.0, 0.0), where)
            rotation = numbers_of(document, node, "rotation", 4, (0.0, 0.0, 0.0, 1.0), where)
            scale = numbers_of(document, node, "scale", 3, (1.0, 1.0, 1.0), where)
            own = transforms(document, translation[None], rotation[None], scale[None], where)[0]
        placed[index] = own if parent < 0 else placed[parent] @ own
    return placed


def numbers_of(
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


def transforms(
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
