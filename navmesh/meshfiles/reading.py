"""Which reader a mesh file goes to."""

import os
from collections.abc import Callable
from pathlib import Path

from navmesh.errors import NavmeshError
from navmesh.files.inputs import note_input
from navmesh.meshfiles.gltf import read_gltf
from navmesh.meshfiles.mesh_file import MeshFile
from navmesh.meshfiles.obj import read_obj
from navmesh.meshfiles.others import read_other

__all__ = ["read_mesh"]

_READERS: dict[str, Callable[[str | os.PathLike[str]], MeshFile]] = {
    "obj": read_obj,
    "gltf": read_gltf,
    "glb": read_gltf,
}


def read_mesh(path: str | os.PathLike[str]) -> MeshFile:
    """The triangles of a mesh file; the end of its name says of what format it is. Raises `MeshFileError`."""
    file = Path(path)
    if not file.is_file():
        raise NavmeshError(f"{file}: no such file; expected a mesh (OBJ, PLY, STL, OFF, glTF, FBX or USD)")
    note_input(file)
    return _READERS.get(file.suffix.lower().removeprefix("."), read_other)(file)
