"""FBX, through ufbx (the extra "meshes"): axes and units are the file's.

Hidden nodes, and all but the finest of the levels of detail in a group, are left out; skins and blend shapes
are as the file leaves them.
"""

import importlib.util
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from navmesh.meshfiles.mesh_file import MeshFile, MeshFileError, flattened, missing_extra
from navmesh.meshfiles.polygons import CrossingPolygon, triangulate
from navmesh.meshfiles.text import read_bytes

__all__ = ["read_fbx"]

_UP = {(0, 2, 4): "y", (0, 4, 3): "z"}
"""The usual axes (right, up, front), as ufbx numbers them: x, -x, y, -y, z, -z, unknown."""
_UNKNOWN = 6
_ASIDE = re.compile(rb'"[^"]*"|;[^\n]*')


def read_fbx(path: str | os.PathLike[str]) -> MeshFile:
    """The polygons of an FBX file as triangles. Raises `MeshFileError`."""
    if importlib.util.find_spec("ufbx") is None:
        raise missing_extra(path, "FBX is read by the package ufbx", "meshes", "export the level as glTF")
    _check_whole(path)
    read = _through_ufbx(path)
    ends = {name: np.cumsum(read[f"{name}_counts"])[:-1] for name in ("points", "corners", "sizes")}
    pieces = {name: np.split(read[name], ends[name]) for name in ends}
    parts = []
    for name, turned, points, corners, sizes in zip(
        read["names"], read["mirrored"], pieces["points"], pieces["corners"], pieces["sizes"], strict=False
    ):
        if len(corners) and corners.max() >= len(points):
            raise MeshFileError(
                path, f"mesh {str(name)!r}", f"a polygon names vertex {corners.max()} of {len(points)}"
            )
        if not np.isfinite(points).all():
            raise MeshFileError(path, f"mesh {str(name)!r}", "a vertex is not finite")
        try:
            faces = triangulate(points, corners, sizes)
        except CrossingPolygon as error:
            raise MeshFileError(path, f"mesh {str(name)!r}, polygon {error.index}", str(error)) from None
        parts.append((points, faces[:, :: -1 if turned else 1]))
    vertices, faces = flattened(parts)
    axes = tuple(read["axes"].tolist())
    scale = float(read["unit"])
    if axes in _UP or _UNKNOWN in axes:
        return MeshFile(vertices, faces, _UP.get(axes, "y"), scale)
    rows = np.zeros((3, 3))
    for row, axis, sign in ((0, axes[0], 1.0), (2, axes[1], 1.0), (1, axes[2], -1.0)):
        rows[row, axis // 2] = sign * (-1.0 if axis % 2 else 1.0)
    return MeshFile(vertices @ rows.T, faces[:, :: -1 if np.linalg.det(rows) < 0.0 else 1], "z", scale)


def _through_ufbx(path: str | os.PathLike[str]) -> dict[str, np.ndarray]:
    """What `fbx_process` finds in a file."""
    with tempfile.TemporaryDirectory(prefix="surefoot-") as folder:
        result = Path(folder) / "fbx.npz"
        script = Path(__file__).with_name("fbx_process.py")
        done = subprocess.run(
            [sys.executable, "-P", script, os.fspath(path), result],
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode == 1 and done.stdout:
            raise MeshFileError(path, "", done.stdout.strip())
        if done.returncode != 0:
            last = done.stderr.strip().rpartition("\n")[2]
            raise MeshFileError(path, "", f"ufbx ends with code {done.returncode} at it {last}".strip())
        with np.load(result, allow_pickle=False) as arrays:
            return dict(arrays)


def _check_whole(path: str | os.PathLike[str]) -> None:
    """Refuses a text that ends within a block: ufbx takes what there is."""
    content = read_bytes(path)
    if content.startswith(b"Kaydara FBX Binary"):
        return
    bare = _ASIDE.sub(b"", content)
    unclosed = bare.count(b"{") - bare.count(b"}")
    if unclosed > 0:
        raise MeshFileError(path, "", f"is cut off: {unclosed} blocks are not closed")
