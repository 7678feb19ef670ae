"""glTF files made by hand, for tests."""

import json
import struct
from typing import Any

import numpy as np

from navmesh import Terrain

KINDS = {"b": 5120, "B": 5121, "h": 5122, "H": 5123, "I": 5125, "f": 5126}
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
SQUARE = np.array([[0, 0, 0], [4, 0, 0], [4, 0, -4], [0, 0, -4]], np.float32)  # a floor, Y up
TWO = [0, 1, 2, 0, 2, 3]


class Gltf:
    """A glTF file that grows: `array` adds numbers, `json` is its content."""

    def __init__(self, **top: Any) -> None:
        self.data = b""
        self.json: dict[str, Any] = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [], "meshes": [],
            "accessors": [], "bufferViews": [], "buffers": [],
        } | top  # fmt: skip

    def view(self, data: bytes, **more: Any) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)} | more
        self.data += data
        self.json["bufferViews"].append(view)
        return len(self.json["bufferViews"]) - 1

    def accessor(self, kind: str, count: int, width: int, **more: Any) -> int:
        accessor = {"componentType": KINDS[kind], "count": count, "type": TYPES[width]} | more
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def array(self, values: Any, stride: int = 0, **more: Any) -> int:
        """An accessor of ``values`` (n,) or (n, k), each element ``stride`` bytes after the last."""
        array = np.asarray(values)
        rows = array.reshape(len(array), -1)
        size = rows.shape[1] * rows.itemsize
        padded = b"".join(row.tobytes().ljust(stride or size, b"\0") for row in rows)
        view = self.view(padded, **({"byteStride": stride} if stride else {}))
        return self.accessor(
            array.dtype.char.replace("L", "I"), len(rows), rows.shape[1], bufferView=view, **more
        )

    def mesh(self, points: Any, indices: Any = None, **primitive: Any) -> int:
        """A mesh of one primitive; ``points`` are an array or an accessor's number."""
        at = points if isinstance(points, int) else self.array(np.asarray(points, np.float32))
        made: dict[str, Any] = {"attributes": {"POSITION": at} | primitive.pop("attributes", {})} | primitive
        if indices is not None:
            made["indices"] = (
                indices if isinstance(indices, int) else self.array(np.asarray(indices, np.uint16))
            )
        self.json["meshes"].append({"primitives": [made]})
        return len(self.json["meshes"]) - 1

    def node(self, **node: Any) -> int:
        self.json["nodes"].append(node)
        return len(self.json["nodes"]) - 1

    def require(self, name: str) -> None:
        for each in ("extensionsUsed", "extensionsRequired"):
            self.json.setdefault(each, []).append(name)

    def glb(self) -> bytes:
        self.json["buffers"] = self.json["buffers"] or [{"byteLength": len(self.data)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        data = self.data + b"\0" * (-len(self.data) % 4)
        size = 12 + 8 + len(text) + 8 + len(data)
        return b"".join([
            b"glTF", struct.pack("<II", 2, size), struct.pack("<I", len(text)), b"JSON", text,
            struct.pack("<I", len(data)), b"BIN\0", data,
        ])  # fmt: skip


def load(tmp_path, file, name="level.glb", **options):
    path = tmp_path / name
    path.write_bytes(file.glb() if isinstance(file, Gltf) else file)
    return Terrain.load(path, **options)


def square(**node):
    file = Gltf()
    file.node(mesh=file.mesh(SQUARE, TWO), **node)
    return file
