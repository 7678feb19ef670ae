"""The formats that trimesh reads for us."""

import os

import numpy as np

from navmesh.meshfiles.mesh_file import MeshFile, MeshFileError

__all__ = ["read_other"]


def read_other(path: str | os.PathLike[str]) -> MeshFile:
    """The triangles of a file of any other format that trimesh reads: every instance with its transform."""
    import trimesh
    from trimesh.visual import ColorVisuals

    try:
        loaded = trimesh.load_scene(os.fspath(path), process=False)
        for part in loaded.geometry.values():
            if isinstance(part, trimesh.Trimesh):  # else trimesh packs all textures into one: gigabytes
                part.visual = ColorVisuals()
        mesh = loaded.to_mesh()
        return MeshFile(np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces))
    except MemoryError:
        raise
    except Exception as error:
        raise MeshFileError(path, "", str(error) or type(error).__name__) from error
