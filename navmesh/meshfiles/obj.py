"""Wavefront OBJ: vertices, polygons and the names of their materials; normals, lines and groups are
passed over.

After the format's description of Alias|Wavefront (Advanced Visualizer, appendix B1). Free-form surfaces and
`call` are refused: without them the level would have holes.
"""

import os
import re
from collections.abc import Iterator

import numpy as np

from navmesh.meshfiles.mesh_file import MeshFile, MeshFileError
from navmesh.meshfiles.polygons import CrossingPolygon, triangulate_owned
from navmesh.meshfiles.text import as_lines, finite_rows, quoted, read_bytes, whole_numbers

__all__ = ["read_obj"]

_FACES = (b"f", b"fo")
_NAMES = {b"o", b"g", b"usemtl", b"mtllib", b"usemap", b"maplib", b"shadow_obj", b"trace_obj"}
_BLANK = b" \t\v\f\0"  # ZBrush ends its files with a zero
_REFUSED = {
    b"surf": "a free-form surface",
    b"bzp": "a Bézier patch",
    b"bsp": "a B-spline patch",
    b"cdp": "a Cardinal patch",
    b"call": "another file",
}
_BEHIND = re.compile(rb"/\S*|#.*")
_STATEMENT = re.compile(rb"[A-Za-z_]")


def read_obj(path: str | os.PathLike[str]) -> MeshFile:
    """The polygons of an OBJ file as triangles. Raises `MeshFileError` with the line for what is wrong."""
    points, point_lines = [], []
    rows, lines, before = [], [], []
    named_from: list[tuple[int, str]] = []  # the first face of a material, and its name
    for number, statement in _statements(as_lines(read_bytes(path))):
        word, rest = statement.split(None, 1) if b" " in statement or b"\t" in statement else (statement, b"")
        if word == b"v":
            points.append(rest)
            point_lines.append(number)
        elif word in _FACES:
            rows.append(rest)
            lines.append(number)
            before.append(len(points))
        elif word == b"usemtl":
            named_from.append((len(rows), rest.strip().decode(errors="replace")))
        elif word in _REFUSED:
            problem = (
                f"{quoted(statement)}: {_REFUSED[word]}, which is not read; export polygons, in one file"
            )
            raise MeshFileError(path, f"line {number}", problem)
        elif not _STATEMENT.match(word):
            raise MeshFileError(path, f"line {number}", f"{quoted(statement)} is no statement of an OBJ file")
    vertices = finite_rows(path, points, point_lines, "a vertex")
    for row, line in zip(rows, lines, strict=True):
        if b" /" in row or row.startswith(b"/"):
            raise MeshFileError(path, f"line {line}", f"{quoted(row)}: a blank before a slash")
    bare = _BEHIND.sub(b"", b"\n".join(rows)).split(b"\n") if rows else []
    named, sizes = whole_numbers(
        path, bare, lines, "the numbers of vertices: f 1 2 3, or f 1/1/1 2/2/1 3/3/1"
    )
    corners = _from_zero(path, named, np.repeat(before, sizes), len(vertices), np.repeat(lines, sizes))
    try:
        faces, owner = triangulate_owned(vertices, corners, sizes)
    except CrossingPolygon as error:
        raise MeshFileError(path, f"line {lines[error.index]}", str(error)) from None
    if not named_from:
        return MeshFile(vertices, faces)
    first = np.array([0, *(at for at, _ in named_from), len(rows)])
    names = np.array(["", *(name for _, name in named_from)])
    return MeshFile(vertices, faces, materials=np.repeat(names, np.diff(first))[owner])


def _statements(lines: list[bytes]) -> Iterator[tuple[int, bytes]]:
    """The statements of a file with the number of the line on which each begins. A backslash at the end of a
    line joins the next one to it, unless it is part of a name or a remark."""
    begun, start = b"", 0
    for number, line in enumerate(lines, 1):
        text = line.strip(_BLANK)
        if begun:
            text, number, begun = begun + b" " + text, start, b""
        elif not text or text.startswith(b"#"):
            continue
        if text.endswith(b"\\") and text.split(None, 1)[0] not in _NAMES:
            begun, start = text.rstrip(b"\\"), number
        else:
            yield number, text
    if begun:
        yield start, begun


def _from_zero(
    path: str | os.PathLike[str], named: np.ndarray, before: np.ndarray, count: int, lines: np.ndarray
) -> np.ndarray:
    """Numbers of vertices from 0: in the file they count from 1, negative ones back from the last vertex
    ``before`` the face. A vertex may follow the faces that use it."""
    corners = np.where(named < 0, named + before, named - 1)
    wrong = np.flatnonzero((named == 0) | (corners < 0) | (corners >= count))
    if len(wrong):
        at = int(wrong[0])
        if named[at] == 0:
            problem = "vertex 0; the first vertex of an OBJ file is 1"
        elif named[at] < 0:
            problem = f"vertex {named[at]}; there are {before[at]} vertices before this line"
        else:
            problem = f"vertex {named[at]}; the file has {count} vertices"
        raise MeshFileError(path, f"line {lines[at]}", problem)
    return corners
