"""Stereolithography files (STL), binary and text."""

import os
import struct

import numpy as np

from navmesh.meshfiles.mesh_file import MeshFile, MeshFileError
from navmesh.meshfiles.polygons import CrossingPolygon, triangulate
from navmesh.meshfiles.text import as_lines, finite_rows, quoted, read_bytes

__all__ = ["read_stl"]

_HEAD = 84
_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
_PASSED_OVER = (b"facet", b"outer", b"endfacet", b"solid", b"color")


def read_stl(path: str | os.PathLike[str]) -> MeshFile:
    """The facets of an STL file. Raises `MeshFileError`."""
    content = read_bytes(path)
    count = struct.unpack_from("<I", content, 80)[0] if len(content) >= _HEAD else 0
    size = _HEAD + count * _FACET.itemsize
    if size == len(content) and count:
        return _binary(path, content, count)
    lines = as_lines(content)
    first = next((line.split(None, 1)[0].lower() for line in lines if line.strip()), b"")
    if first == b"solid" and b"\0" not in b"".join(lines[:20]):
        return _text(path, lines)
    if not count:
        raise MeshFileError(path, "", "expected an STL file with facets, binary or text")
    if len(content) < size:
        raise MeshFileError(path, "", f"is cut off: {len(content)} bytes, {count} facets take {size}")
    return _binary(path, content, count)


def _binary(path: str | os.PathLike[str], content: bytes, count: int) -> MeshFile:
    facets = np.frombuffer(content, _FACET, count, _HEAD)
    corners = facets["corners"].astype(np.float64)
    broken = np.flatnonzero(~np.isfinite(corners).all(axis=(1, 2)))
    if len(broken):
        raise MeshFileError(path, f"facet {broken[0]}", "a corner is not finite")
    return MeshFile(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))


def _text(path: str | os.PathLike[str], lines: list[bytes]) -> MeshFile:
    rows: list[bytes] = []
    numbers: list[int] = []
    sizes: list[int] = []
    word, whole = b"", 0
    for number, line in enumerate(lines, 1):
        words = line.split(None, 1)
        if not words:
            continue
        word = words[0].lower()
        if word == b"vertex":
            rows.append(words[1] if len(words) > 1 else b"")
            numbers.append(number)
        elif word == b"endloop":
            sizes.append(len(rows) - whole)
            whole = len(rows)
        elif word not in _PASSED_OVER and not word.startswith(b"endsolid"):
            raise MeshFileError(path, f"line {number}", f"{quoted(line)} is no line of an STL file")
    if not word.startswith(b"endsolid") or whole < len(rows):
        raise MeshFileError(path, "", "is cut off: it does not end with endsolid")
    vertices = finite_rows(path, rows, numbers, "a vertex")
    try:
        return MeshFile(vertices, triangulate(vertices, np.arange(len(vertices)), np.array(sizes, np.int64)))
    except CrossingPolygon as error:
        first = sum(sizes[: error.index])
        raise MeshFileError(path, f"line {numbers[first]}", str(error)) from None
