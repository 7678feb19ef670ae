"""Mesh files as triangles: one module for each format, one rule for polygons."""

from navmesh.meshfiles.mesh_file import MeshFile, MeshFileError
from navmesh.meshfiles.reading import read_mesh

__all__ = ["MeshFile", "MeshFileError", "read_mesh"]
