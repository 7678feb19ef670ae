"""Triangle meshes of figures, and optional libraries."""

from importlib import import_module
from typing import Any

from runtime.bodies.figure import Shapes
from runtime.errors import RuntimeInputError

__all__ = ["optional", "shape_mesh"]


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


def optional(module: str, extra: str, what: str) -> Any:
    """The library ``module`` of our ``extra``; raises `RuntimeInputError` that says how to install it."""
    try:
        return import_module(module)
    except ImportError:
        how = f"in Surefoot's folder, pip install -e '.[{extra}]'"
        raise RuntimeInputError(f"{what} needs {module}: {how}") from None
