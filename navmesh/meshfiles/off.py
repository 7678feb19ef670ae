"""Object File Format (OFF) of Geomview: text, with or without colours, normals and texture coordinates."""

import os
import re

import numpy as np

from navmesh.meshfiles.mesh_file import MeshFile, MeshFileError
from navmesh.meshfiles.polygons import CrossingPolygon, triangulate
from navmesh.meshfiles.text import as_lines, finite_rows, quoted, read_bytes

__all__ = ["read_off"]

_KIND = re.compile(rb"(ST)?C?N?(4?)(n?)OFF$")


def read_off(path: str | os.PathLike[str]) -> MeshFile:
    """The faces of an OFF file as triangles. Raises `MeshFileError` with the line for what is wrong."""
    bare = [line.partition(b"#")[0].strip() for line in as_lines(read_bytes(path))]
    lines = [(number, line) for number, line in enumerate(bare, 1) if line]
    if not lines:
        raise MeshFileError(path, "", "expected an OFF file")
    number, first = lines[0]
    kind = _KIND.match(first.split()[0])
    rest = first.split(None, 1)[1] if len(first.split()) > 1 else b""
    if rest.upper().startswith(b"BINARY") or (kind and (kind[2] or kind[3])):
        raise MeshFileError(path, f"line {number}", f"{quoted(first)} is not read; write it as plain OFF")
    if kind:
        lines = [(number, rest), *lines[1:]] if rest else lines[1:]
    number, counted = lines[0] if lines else (number, b"")
    counts = counted.split()
    if not 2 <= len(counts) <= 3 or not all(each.isdigit() for each in counts):
        raise MeshFileError(
            path, f"line {number}", f"{quoted(counted)}: expected OFF, or how many vertices and faces"
        )
    vertex_count, face_count = int(counts[0]), int(counts[1])
    if len(lines) - 1 != vertex_count + face_count:
        problem = f"{len(lines) - 1} lines for {vertex_count} vertices and {face_count} faces, one in a line"
        raise MeshFileError(path, "", problem)
    corner_lines, face_lines = lines[1 : 1 + vertex_count], lines[1 + vertex_count :]
    vertices = finite_rows(
        path, [line for _, line in corner_lines], [at for at, _ in corner_lines], "a vertex"
    )
    corners: list[int] = []
    sizes: list[int] = []
    for at, line in face_lines:
        words = line.split()
        try:
            size = int(words[0])
            own = [int(word) for word in words[1 : 1 + max(size, 0)]]
        except ValueError:
            size, own = -1, []
        if size != len(own) or not all(0 <= each < vertex_count for each in own):
            problem = f"{quoted(line)}: expected how many corners, and as many of the {vertex_count} vertices"
            raise MeshFileError(path, f"line {at}", problem)
        corners += own
        sizes.append(size)
    try:
        return MeshFile(
            vertices, triangulate(vertices, np.array(corners, np.int64), np.array(sizes, np.int64))
        )
    except CrossingPolygon as error:
        raise MeshFileError(path, f"line {face_lines[error.index][0]}", str(error)) from None
