"""Which reader a mesh file goes to."""

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.meshfiles.fbx import read_fbx
from navmesh.meshfiles.gltf import read_gltf
from navmesh.meshfiles.mesh_file import MeshFile, MeshFileError
from navmesh.meshfiles.obj import read_obj
from navmesh.meshfiles.off import read_off
from navmesh.meshfiles.ply import read_ply
from navmesh.meshfiles.stl import read_stl
from navmesh.meshfiles.usd import read_usd
from surefoot.files.inputs import note_input

__all__ = ["read_mesh"]

_READERS: dict[str, Callable[[str | os.PathLike[str]], MeshFile]] = {
    ".obj": read_obj,
    ".ply": read_ply,
    ".stl": read_stl,
    ".off": read_off,
    ".gltf": read_gltf,
    ".glb": read_gltf,
    ".fbx": read_fbx,
    ".usd": read_usd,
    ".usda": read_usd,
    ".usdc": read_usd,
    ".usdz": read_usd,
}


def read_mesh(path: str | os.PathLike[str]) -> MeshFile:
    """The triangles of a mesh file; the end of its name says of what format it is. Raises `MeshFileError`."""
    file = Path(path)
    if not file.is_file():
        raise NavmeshError(f"{file}: no such file; expected a mesh (OBJ, PLY, STL, OFF, glTF, FBX or USD)")
    reader = _READERS.get(file.suffix.lower())
    if reader is None:
        problem = f"its name ends with none of {', '.join(_READERS)}; export it as one of these, best as .glb"
        raise MeshFileError(file, "", problem)
    note_input(file)
    mesh = reader(file)
    outside = (mesh.faces < 0) | (mesh.faces >= len(mesh.vertices))
    if outside.any():
        at = int(np.flatnonzero(outside.any(axis=1))[0])
        problem = f"names vertices {mesh.faces[at].tolist()}; there are {len(mesh.vertices)}"
        raise MeshFileError(file, f"triangle {at}", problem)
    return mesh
