"""Polygon files (PLY), text and binary: faces of any number of corners, and triangle strips.

After Greg Turk's description of the format (Stanford, 1994).
"""

import os
import re
from dataclasses import dataclass, field

import numpy as np

from navmesh.meshfiles.mesh_file import MeshFile, MeshFileError
from navmesh.meshfiles.polygons import CrossingPolygon, triangulate
from navmesh.meshfiles.strips import strip_faces
from navmesh.meshfiles.text import numbers, read_bytes

__all__ = ["read_ply"]

_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "int64": "i8", "uint64": "u8",
    "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
_FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_CORNERS = ("vertex_indices", "vertex_index")
_END = re.compile(rb"[\r\n]end_header[ \t]*(\r\n|\n|\r|$)")


@dataclass(frozen=True)
class _Property:
    kind: str
    """Of its values, as NumPy names it."""
    counted: str = ""
    """Of the count before a list's values; "" for a single value."""


@dataclass
class _Element:
    name: str
    count: int
    properties: dict[str, _Property] = field(default_factory=dict)
    at: dict[str, np.ndarray] = field(default_factory=dict)
    """(count,) where the value, or the first of a list, of each property stands in the body."""
    sizes: dict[str, np.ndarray] = field(default_factory=dict)
    """(count,) how long the lists are."""


class _Body:
    """The numbers behind the header, each at a position: text counts numbers, binary bytes."""

    def __init__(self, values: np.ndarray, order: str) -> None:
        self._values, self._order = values, order
        self.end = len(values)

    def width(self, kind: str) -> int:
        return np.dtype(kind).itemsize if self._order else 1

    def take(self, at: np.ndarray, kind: str) -> np.ndarray:
        """The values of ``kind`` at positions (n,), all of which lie within the body."""
        if not self._order:
            return self._values[at]
        taken = self._values[at[:, None] + np.arange(self.width(kind))]
        return np.ascontiguousarray(taken).view(self._order + kind)[:, 0]


def read_ply(path: str | os.PathLike[str]) -> MeshFile:
    """The faces of a PLY file as triangles. Raises `MeshFileError`."""
    content = read_bytes(path)
    end = _END.search(content)
    if not content.startswith(b"ply") or end is None:
        raise MeshFileError(path, "", "expected a PLY file: 'ply', a header and 'end_header'")
    elements, order = _header(path, content[: end.start()])
    if order:
        body = _Body(np.frombuffer(content, np.uint8, offset=end.end()), order)
    else:
        values = numbers(content[end.end() :], np.float64)
        if values is None:
            raise MeshFileError(path, "", "something behind its header is not a number")
        body = _Body(values, order)
    at = 0
    for element in elements:
        at = _walk(path, element, body, at)
    if at < body.end and (not order or content[len(content) - body.end + at :].strip(b"\0\r\n\t ")):
        raise MeshFileError(path, "", "holds more than its header says; write it anew")
    named = {element.name: element for element in elements}
    vertices = _vertices(path, named, body)
    corners, sizes = _lists(path, named.get("face"), body)
    if len(corners) and not 0 <= corners.min() <= corners.max() < len(vertices):
        wrong = int(np.flatnonzero((corners < 0) | (corners >= len(vertices)))[0])
        face = int(np.searchsorted(np.cumsum(sizes), wrong, side="right"))
        raise MeshFileError(path, f"face {face}", f"names vertex {corners[wrong]}; there are {len(vertices)}")
    try:
        faces = triangulate(vertices, corners, sizes)
    except CrossingPolygon as error:
        raise MeshFileError(path, f"face {error.index}", str(error)) from None
    strips, lengths = _lists(path, named.get("tristrips"), body)
    return MeshFile(vertices, np.concatenate([faces, strip_faces(strips, lengths)]))


def _header(path: str | os.PathLike[str], head: bytes) -> tuple[list[_Element], str]:
    """The elements, and the byte order of the body ("" for text)."""
    lines = [line.split() for line in head.decode("latin-1").splitlines()[1:]]
    elements: list[_Element] = []
    order: str | None = None
    for number, words in enumerate(lines, 2):
        match words:
            case ["format", name, "1.0"] if name in _FORMATS:
                order = _FORMATS[name]
            case ["element", name, count] if count.isdecimal():
                elements.append(_Element(name, int(count)))
            case ["property", "list", counted, kind, name] if elements and {counted, kind} <= set(_TYPES):
                elements[-1].properties[name] = _Property(_TYPES[kind], _TYPES[counted])
            case ["property", kind, name] if elements and kind in _TYPES:
                elements[-1].properties[name] = _Property(_TYPES[kind])
            case [] | ["comment" | "obj_info", *_]:
                pass
            case _:
                raise MeshFileError(path, f"line {number}", f"{' '.join(words)!r} is no line of a PLY header")
    if order is None:
        raise MeshFileError(path, "", f"its header names no format; expected one of {', '.join(_FORMATS)}")
    return elements, order


def _walk(path: str | os.PathLike[str], element: _Element, body: _Body, start: int) -> int:
    """Find where the properties of an ``element`` stand, and its end."""
    least = sum(body.width(each.counted or each.kind) for each in element.properties.values())
    if element.count * least > body.end - start:
        raise _cut_off(path, element)
    if element.count == 0:
        return start
    lengths = _lengths(path, element, body, start)
    record = least + sum(
        body.width(each.kind) * lengths[name] for name, each in element.properties.items() if each.counted
    )
    if start + element.count * record <= body.end:
        records = start + record * np.arange(element.count)
        alike = True
        for name, each in element.properties.items():
            if each.counted:
                alike = alike and bool((body.take(records, each.counted) == lengths[name]).all())
                element.sizes[name] = np.full(element.count, lengths[name])
                records = records + body.width(each.counted)
            element.at[name] = records
            records = records + body.width(each.kind) * (lengths[name] if each.counted else 1)
        if alike:
            return start + element.count * record
    at = {name: [0] * element.count for name in element.properties}
    sizes = {name: [0] * element.count for name, each in element.properties.items() if each.counted}
    for number in range(element.count):
        lengths = _lengths(path, element, body, start)
        for name, each in element.properties.items():
            if each.counted:
                sizes[name][number] = lengths[name]
                start += body.width(each.counted)
            at[name][number] = start
            start += body.width(each.kind) * lengths.get(name, 1)
    if start > body.end:
        raise _cut_off(path, element)
    element.at = {name: np.array(each, dtype=np.int64) for name, each in at.items()}
    element.sizes = {name: np.array(each, dtype=np.int64) for name, each in sizes.items()}
    return start


def _lengths(path: str | os.PathLike[str], element: _Element, body: _Body, start: int) -> dict[str, int]:
    """How long the lists of the record at ``start`` are."""
    lengths: dict[str, int] = {}
    for name, each in element.properties.items():
        if each.counted:
            if start + body.width(each.counted) > body.end:
                raise _cut_off(path, element)
            count = body.take(np.array([start]), each.counted)[0]
            if not 0 <= count <= body.end or count != int(count):
                raise MeshFileError(path, f"element {element.name}", f"a list of {count} values")
            lengths[name] = int(count)
            start += body.width(each.counted)
        start += body.width(each.kind) * lengths.get(name, 1)
    return lengths


def _cut_off(path: str | os.PathLike[str], element: _Element) -> MeshFileError:
    return MeshFileError(path, "", f"is cut off: its {element.count} of {element.name!r} are not all there")


def _vertices(path: str | os.PathLike[str], named: dict[str, _Element], body: _Body) -> np.ndarray:
    vertex = named.get("vertex")
    if vertex is None or not {"x", "y", "z"} <= set(vertex.properties):
        raise MeshFileError(path, "", "its header names no element vertex with x, y and z")
    if vertex.count == 0:
        return np.empty((0, 3))
    found = [body.take(vertex.at[axis], vertex.properties[axis].kind) for axis in "xyz"]
    vertices = np.stack(found, axis=1).astype(np.float64)
    broken = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(broken):
        raise MeshFileError(path, f"vertex {broken[0]}", f"{vertices[broken[0]].tolist()} is not finite")
    return vertices


def _lists(
    path: str | os.PathLike[str], element: _Element | None, body: _Body
) -> tuple[np.ndarray, np.ndarray]:
    """The numbers of vertices that an element lists, one after the other, and how many each has."""
    if element is None or element.count == 0:
        return np.empty(0, np.int64), np.empty(0, np.int64)
    name = next((each for each in _CORNERS if each in element.sizes), None)
    if name is None:
        raise MeshFileError(path, f"element {element.name}", f"has no list {' or '.join(_CORNERS)}")
    sizes, kind = element.sizes[name], element.properties[name].kind
    before = np.repeat(np.cumsum(sizes) - sizes, sizes)
    at = np.repeat(element.at[name], sizes) + (np.arange(sizes.sum()) - before) * body.width(kind)
    found = body.take(at, kind)
    if (found != np.floor(found)).any() or (np.abs(found.astype(np.float64)) > 2**53).any():
        raise MeshFileError(path, f"element {element.name}", f"{name} that are not whole numbers")
    return found.astype(np.int64), sizes
