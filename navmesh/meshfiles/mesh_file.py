"""What every reader of mesh files gives, and how it refuses a file."""

import os
from dataclasses import dataclass

import numpy as np

from navmesh.errors import NavmeshError

__all__ = ["MeshFile", "MeshFileError", "flattened", "missing_extra"]


@dataclass(frozen=True)
class MeshFile:
    """Triangles as a file has them, with what it says about its axes and units."""

    vertices: np.ndarray
    """(v, 3) float64 in the file's axes and units."""
    faces: np.ndarray
    """(f, 3) integers into `vertices`; (0, 3) for a file without a surface."""
    up: str = "z"
    """Axis that points up, where the caller names none."""
    scale: float = 1.0
    """Metres per unit, where the caller names none."""
    materials: np.ndarray | None = None
    """(f,) str: the name of each triangle's material, "" for none; None where the file names none."""


class MeshFileError(NavmeshError):
    """A mesh file is damaged, or holds what this release does not read."""

    def __init__(self, path: str | os.PathLike[str], where: str, problem: str) -> None:
        self.path, self.problem = path, f"{where}: {problem}" if where else problem
        super().__init__(f"{path}: cannot be read as a mesh: {self.problem}")


def missing_extra(path: str | os.PathLike[str], what: str, extra: str, instead: str) -> MeshFileError:
    """The error for a file that a package of an ``extra`` reads, which is not installed."""
    return MeshFileError(path, "", f"{what}; in Surefoot's folder: pip install -e '.[{extra}]', or {instead}")


def flattened(parts: list[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    """The vertices (v, 3) and faces (f, 3) of ``parts``, one after the other."""
    counts = np.cumsum([0] + [len(vertices) for vertices, _ in parts])
    vertices = np.concatenate([np.empty((0, 3)), *(vertices for vertices, _ in parts)])
    faces = [each + before for (_, each), before in zip(parts, counts, strict=False)]
    return vertices, np.concatenate([np.empty((0, 3), np.int64), *faces])
