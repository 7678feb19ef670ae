"""Triangle meshes of figures, and optional libraries."""

from importlib import import_module
from typing import Any

import numpy as np

from runtime.bodies.figure import Shapes
from runtime.errors import RuntimeInputError

__all__ = ["optional", "shape_mesh", "smooth_normals"]


def shape_mesh(shapes: Shapes, k: int) -> Any:
    """Shape k as a `trimesh.Trimesh` in its own frame."""
    import trimesh

    size = shapes.size[k]
    if not shapes.round[k]:
        mesh = trimesh.creation.capsule(height=2.0 * size[1], radius=size[0], count=[12, 12])
        mesh.vertices -= mesh.bounds.mean(axis=0)
        return mesh
    mesh = trimesh.creation.icosphere(subdivisions=2)
    mesh.vertices *= size
    return mesh


def smooth_normals(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """(v, 3) unit normals at ``points`` (v, 3) of ``faces`` (f, 3), over seams: points at the same place have
    the same one. Unit z where no face has an area."""
    corners = points[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    _, place = np.unique(points.round(5), axis=0, return_inverse=True)
    total = np.zeros((int(place.max(initial=-1)) + 1, 3))
    for corner in range(3):
        np.add.at(total, place.ravel()[faces[:, corner]], across)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    unit = np.where(length > 1e-15, total / np.maximum(length, 1e-15), np.array([0.0, 0.0, 1.0]))
    return unit[place.ravel()]


def optional(module: str, extra: str, what: str) -> Any:
    """The library ``module`` of our ``extra``; raises `RuntimeInputError` that says how to install it."""
    try:
        return import_module(module)
    except ImportError:
        how = f"in Surefoot's folder, pip install -e '.[{extra}]'"
        raise RuntimeInputError(f"{what} needs {module}: {how}") from None
