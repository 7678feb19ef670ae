"""glTF 2.0 as a document: its JSON, the bytes of its buffers, the numbers of its accessors.

After the specification of the Khronos Group (glTF 2.0, sections 3.6 and 4, and the extensions named here).
"""

import base64
import binascii
import json
import os
import struct
import urllib.parse
from pathlib import Path
from typing import Any

import numpy as np

from navmesh.meshfiles.gltf_compression import MESHOPT, meshopt_bytes
from navmesh.meshfiles.mesh_file import MeshFileError
from navmesh.meshfiles.text import read_bytes
from surefoot.files.inputs import note_input

__all__ = ["Document"]

_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_MOST_ZEROS = 10_000_000
"""Elements of an accessor that has no data but zeros: more of them are damage."""
_READ = {
    "KHR_mesh_quantization", "KHR_draco_mesh_compression", "EXT_mesh_gpu_instancing", "KHR_node_visibility",
    *MESHOPT,
}  # fmt: skip
_WITHOUT_GEOMETRY = (
    "KHR_materials_", "KHR_texture_", "EXT_texture_", "EXT_materials_", "KHR_lights_", "EXT_lights_",
    "KHR_animation_", "KHR_xmp", "KHR_techniques_webgl", "KHR_node_hoverability", "KHR_node_selectability",
    "EXT_mesh_features", "EXT_structural_metadata", "MSFT_texture_", "MSFT_packing_", "MSFT_lod",
    "GODOT_single_root",
)  # fmt: skip


class Document:
    """A glTF file. Every method refuses what is damaged or not read, with a `MeshFileError`."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        content = read_bytes(path)
        text, self._binary = self._chunks(content) if content.startswith(b"glTF") else (content, None)
        try:
            self.json = json.loads(text.decode("utf-8-sig"))
        except (ValueError, RecursionError) as error:
            raise self.error("", f"its JSON is damaged: {error}") from None
        if not isinstance(self.json, dict) or not isinstance(self.json.get("asset"), dict):
            raise self.error("", "expected a glTF file, with an asset and its version")
        version = str(self.json["asset"].get("version", ""))
        if not version.startswith("2."):
            raise self.error("", f"glTF of version {version or 'none'}; version 2 is read: export it anew")
        self.required = set(self.items("extensionsRequired", of=str))
        """The extensions without which the file cannot be read."""
        for name in sorted(self.required):
            if name not in _READ and not name.startswith(_WITHOUT_GEOMETRY):
                raise self.error(
                    "", f"it requires the extension {name}, which is not read; export without it"
                )
        self._buffers: dict[int, bytes] = {}
        self._views: dict[int, bytes] = {}

    def error(self, where: str, problem: str) -> MeshFileError:
        """What is wrong ``where`` in the file."""
        return MeshFileError(self.path, where, problem)

    def items(self, name: str, within: Any = None, of: type = dict) -> list[Any]:
        """The list called ``name``, of the file or ``within`` an object of it; empty if there is none."""
        found = (self.json if within is None else within).get(name, [])
        if not isinstance(found, list) or not all(isinstance(each, of) for each in found):
            raise self.error(name, f"expected a list of {'numbers' if of is int else of.__name__}")
        return found

    def item(self, name: str, index: Any, where: str) -> dict[str, Any]:
        """Element ``index`` of the file's list ``name``, that ``where`` refers to."""
        found = self.items(name)
        if not isinstance(index, int) or isinstance(index, bool) or not 0 <= index < len(found):
            raise self.error(where, f"refers to {name}[{index!r}]; there are {len(found)}")
        return found[index]

    def whole(self, within: dict[str, Any], name: str, where: str, default: int | None = None) -> int:
        """The whole number called ``name``, at least 0."""
        value = within.get(name, default)
        if not isinstance(value, int) or isinstance(value, bool) or value < 0:
            raise self.error(where, f"{name} = {value!r}: expected a whole number of at least 0")
        return value

    def extension(self, within: dict[str, Any], name: str) -> dict[str, Any] | None:
        """What extension ``name`` says about an object."""
        found = within.get("extensions")
        value = found.get(name) if isinstance(found, dict) else None
        return value if isinstance(value, dict) else None

    def numbers(self, index: Any, kind: str, where: str) -> np.ndarray:
        """(n, k) the elements of an accessor of ``kind`` ("SCALAR", "VEC3", …): integers as they are, float64
        for floating point and for integers that are normalized."""
        accessor = self.item("accessors", index, where)
        place = f"accessors[{index}]"
        if accessor.get("type") != kind:
            raise self.error(place, f"is {accessor.get('type')!r}; {where} needs {kind!r}")
        component = self._component(accessor, place)
        count, width = self.whole(accessor, "count", place), _WIDTHS[kind]
        if "bufferView" in accessor:
            offset = self.whole(accessor, "byteOffset", place, 0)
            found = self._rows(accessor["bufferView"], offset, component, count, width, place)
        elif count > _MOST_ZEROS:
            raise self.error(place, f"has {count} elements and no data")
        else:
            found = np.zeros((count, width), component)
        if "sparse" in accessor:
            found = self._replaced(found, accessor["sparse"], place)
        return self.meant(found, accessor)

    @staticmethod
    def meant(found: np.ndarray, accessor: dict[str, Any]) -> np.ndarray:
        """The values that an accessor's stored ones stand for."""
        if found.dtype.kind == "f":
            return found.astype(np.float64)
        if accessor.get("normalized") is True:
            return np.maximum(found / float(np.iinfo(found.dtype).max), -1.0)
        return found

    def _component(self, accessor: dict[str, Any], place: str) -> str:
        component = accessor.get("componentType")
        if not isinstance(component, int) or component not in _COMPONENTS:
            raise self.error(place, f"componentType = {component!r}: expected one of {list(_COMPONENTS)}")
        return _COMPONENTS[component]

    def _rows(self, view: Any, offset: int, component: str, count: int, width: int, place: str) -> np.ndarray:
        data = self.view(view, place)
        size = np.dtype(component).itemsize
        stride = self.whole(self.item("bufferViews", view, place), "byteStride", place, size * width)
        if stride < size * width:
            raise self.error(place, f"byteStride = {stride}: one element takes {size * width} bytes")
        if count and offset + stride * (count - 1) + size * width > len(data):
            raise self.error(place, f"{count} elements reach beyond the {len(data)} bytes of its bufferView")
        return np.ndarray((count, width), component, data, offset if count else 0, (stride, size))

    def _replaced(self, found: np.ndarray, sparse: Any, place: str) -> np.ndarray:
        """The elements of an accessor with those that it lists as ``sparse`` in their places."""
        indices, values = self._member(sparse, "indices", place), self._member(sparse, "values", place)
        count = self.whole(sparse, "count", place)
        kind, offset = self._component(indices, place), self.whole(indices, "byteOffset", place, 0)
        at = self._rows(indices.get("bufferView"), offset, kind, count, 1, place)[:, 0]
        if at.dtype.kind != "u" or (at >= len(found)).any():
            raise self.error(place, f"sparse indices that are not below {len(found)}")
        kind, offset = found.dtype.str, self.whole(values, "byteOffset", place, 0)
        replaced = found.copy()
        replaced[at] = self._rows(values.get("bufferView"), offset, kind, count, found.shape[1], place)
        return replaced

    def _member(self, within: Any, name: str, place: str) -> dict[str, Any]:
        """The object called ``name`` within a sparse accessor."""
        found = within.get(name) if isinstance(within, dict) else None
        if not isinstance(found, dict):
            raise self.error(place, f"sparse without {name}")
        return found

    def view(self, index: Any, where: str) -> bytes:
        """The bytes of a bufferView, decompressed."""
        view = self.item("bufferViews", index, where)
        if index not in self._views:
            place = f"bufferViews[{index}]"
            compressed = self._compressed(view, place)
            self._views[index] = self._slice(compressed or view, place)
            if compressed is not None:
                self._views[index] = meshopt_bytes(self, self._views[index], compressed, place)
        return self._views[index]

    def _compressed(self, view: dict[str, Any], place: str) -> dict[str, Any] | None:
        """What says how a bufferView is compressed; None if it is not, or if the file has it plain, too."""
        for name in MESHOPT:
            found = self.extension(view, name)
            if found is not None:
                buffer = self.item("buffers", view.get("buffer"), place)
                plain = "uri" in buffer or (view.get("buffer") == 0 and self._binary is not None)
                return found if name in self.required or not plain else None
        return None

    def _slice(self, view: dict[str, Any], place: str) -> bytes:
        buffer = self._buffer(view.get("buffer"), place)
        begin, length = self.whole(view, "byteOffset", place, 0), self.whole(view, "byteLength", place)
        if begin + length > len(buffer):
            raise self.error(
                place, f"{length} bytes from {begin} on reach beyond the {len(buffer)} of its buffer"
            )
        return buffer[begin : begin + length]

    def _buffer(self, index: Any, where: str) -> bytes:
        buffer = self.item("buffers", index, where)
        if index not in self._buffers:
            place, uri = f"buffers[{index}]", buffer.get("uri")
            content = self._binary if uri is None and index == 0 else self.fetched(uri, place)
            length = self.whole(buffer, "byteLength", place)
            if content is None or len(content) < length:
                raise self.error(place, f"is cut off: {len(content or b'')} bytes, {length} were to come")
            self._buffers[index] = content[:length]
        return self._buffers[index]

    def fetched(self, uri: Any, place: str) -> bytes:
        """The bytes that a URI names: in the URI itself, or in a file beside the glTF file."""
        if not isinstance(uri, str):
            raise self.error(place, f"uri = {uri!r}: expected a file's name")
        if uri.startswith("data:"):
            head, _, body = uri.partition(",")
            try:
                return (
                    base64.b64decode(body)
                    if head.endswith(";base64")
                    else urllib.parse.unquote_to_bytes(body)
                )
            except binascii.Error as error:
                raise self.error(place, f"its base64 is damaged: {error}") from None
        if urllib.parse.urlsplit(uri).scheme not in ("", "file") or "\0" in uri:
            raise self.error(place, f"{uri!r} is not beside the file; only files are read")
        file = self.path.parent / urllib.parse.unquote(uri)
        if not file.is_file():
            raise self.error(place, f"{str(file)!r} is missing; keep it beside the file")
        note_input(file)
        return read_bytes(file)

    def _chunks(self, content: bytes) -> tuple[bytes, bytes | None]:
        """The JSON and the binary chunk of a GLB file."""
        if len(content) < 20:
            raise self.error("", f"is cut off: a GLB file has at least 20 bytes, this one {len(content)}")
        version, length = struct.unpack_from("<II", content, 4)
        if version != 2:
            raise self.error("", f"GLB of version {version}; version 2 is read: export it anew")
        if length > len(content):
            raise self.error("", f"is cut off: {len(content)} bytes, {length} were to come")
        chunks: list[tuple[bytes, bytes]] = []
        at = 12
        while at + 8 <= length:
            size = struct.unpack_from("<I", content, at)[0]
            if at + 8 + size > length:
                raise self.error("", "is cut off within a chunk")
            chunks.append((content[at + 4 : at + 8], content[at + 8 : at + 8 + size]))
            at += 8 + size
        if not chunks or chunks[0][0] != b"JSON":
            raise self.error("", "a GLB file without JSON as its first chunk")
        return chunks[0][1], next((data for kind, data in chunks[1:] if kind == b"BIN\0"), None)
