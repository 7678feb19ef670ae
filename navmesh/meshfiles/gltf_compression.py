"""Compressed glTF: Draco and meshopt, each through a package of the extra "meshes"."""

from pathlib import Path
from typing import Any, Protocol

import numpy as np

from navmesh.meshfiles.mesh_file import MeshFileError, missing_extra

__all__ = ["DRACO", "MESHOPT", "draco_mesh", "meshopt_bytes"]

DRACO = "KHR_draco_mesh_compression"
MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")
_MODES = ("ATTRIBUTES", "TRIANGLES", "INDICES")
_GROWTH = 4096
"""Times its size that meshopt data may unpack to; a buffer of equal bytes comes to a quarter of it."""


class _Document(Protocol):
    """What is asked of a `navmesh.meshfiles.gltf_document.Document`."""

    path: Path

    def error(self, where: str, problem: str) -> MeshFileError: ...
    def whole(self, within: dict[str, Any], name: str, where: str, default: int | None = None) -> int: ...
    def view(self, index: Any, where: str) -> bytes: ...


def meshopt_bytes(document: _Document, data: bytes, extension: dict[str, Any], where: str) -> bytes:
    """What a compressed bufferView holds."""
    try:
        import meshopt
    except ImportError:
        raise missing_extra(
            document.path, f"{where}: is compressed with meshopt", "meshes", "export without compression"
        ) from None
    count = document.whole(extension, "count", where)
    stride = document.whole(extension, "byteStride", where)
    mode = extension.get("mode")
    if mode not in _MODES:
        raise document.error(where, f"mode = {mode!r}: expected one of {', '.join(_MODES)}")
    if count * stride > _GROWTH * (len(data) + 1):
        raise document.error(where, f"{len(data)} bytes cannot hold {count} times {stride}")
    try:
        rows = meshopt.decode_gltf_buffer(data, count, stride, mode, extension.get("filter"))
    except (ValueError, RuntimeError, TypeError, OverflowError) as error:
        raise document.error(where, f"its meshopt compression is damaged: {error}") from None
    return rows.tobytes()


def draco_mesh(
    document: _Document, extension: dict[str, Any], where: str
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """The attributes (v, k) of a compressed primitive, as stored, by name, and its triangles (f, 3)."""
    try:
        import DracoPy
    except ImportError:
        raise missing_extra(
            document.path, f"{where}: is compressed with Draco", "meshes", "export without compression"
        ) from None
    data = document.view(extension.get("bufferView"), where)
    names = extension.get("attributes")
    if not isinstance(names, dict):
        raise document.error(where, f"{DRACO} without attributes")
    try:
        decoded = DracoPy.decode(data)
        found = {name: decoded.get_attribute_by_unique_id(number) for name, number in names.items()}
        faces = np.asarray(decoded.faces, dtype=np.int64).reshape(-1, 3)
    except Exception as error:
        raise document.error(where, f"its Draco compression is damaged: {error}") from None
    if any(each is None for each in found.values()):
        raise document.error(where, "names attributes that its Draco data does not hold")
    return {name: np.asarray(each["data"]) for name, each in found.items() if each is not None}, faces
