"""A level's mesh: triangles in metres, Z up."""

import hashlib
import os
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from navmesh.errors import NavmeshError
from surefoot.words import several

__all__ = ["DEFAULT_MATERIAL", "Chunk", "Terrain", "coded_materials"]

_AXES = {"x": (1, 2, 0), "y": (0, 2, 1), "z": (0, 1, 2)}
_SIGNS = {"x": (1.0, 1.0, 1.0), "y": (1.0, -1.0, 1.0), "z": (1.0, 1.0, 1.0)}


DEFAULT_MATERIAL = "default"
"""The material of triangles that have none, where others have one."""


def _none() -> np.ndarray:
    return np.empty(0, np.int32)


class Chunk(NamedTuple):
    """A named part of a terrain: the next ``vertices`` and ``faces`` of its arrays."""

    name: str
    vertices: int
    faces: int


@dataclass(frozen=True, eq=False)
class Terrain:
    """Triangles of a level. Make one with `load` or `from_arrays`, which check their input, or of named
    chunks with `navmesh.join_chunks`.

    Degenerate and duplicate triangles, open edges, overlaps and unreferenced vertices are tolerated.
    """

    vertices: np.ndarray
    """(v, 3) float64 [m], Z up, every coordinate finite."""
    faces: np.ndarray
    """(f, 3) int32 into `vertices`, f ≥ 1, counter-clockwise seen from outside (from above for a floor)."""
    name: str = "terrain"
    """What error messages call it: the file's name."""
    chunks: tuple[Chunk, ...] = ()
    """What it is made of, by rising name; a level that was loaded whole is one chunk, called "level"."""

    materials: tuple[str, ...] = ()
    """Names of the materials that its triangles have, in alphabetical order; none where no triangle has
    one."""
    face_material: np.ndarray = field(default_factory=_none, repr=False)
    """(f,) int32 into `materials`; (0,) where there are none."""

    def __post_init__(self) -> None:
        if not self.chunks:
            whole = (Chunk("level", len(self.vertices), len(self.faces)),)
            object.__setattr__(self, "chunks", whole)

    def __repr__(self) -> str:
        size = " x ".join(f"{length:.1f}" for length in np.ptp(self.bounds, axis=0))
        return f"<Terrain {Path(self.name).name}: {several(len(self.faces), 'triangle')}, {size} m>"

    @cached_property
    def digest(self) -> str:
        """SHA-256 of vertices, faces and materials (hexadecimal): names the geometry that a baked graph was
        made from."""
        checksum = hashlib.sha256(np.ascontiguousarray(self.vertices).tobytes())
        checksum.update(np.ascontiguousarray(self.faces).tobytes())
        if self.materials:
            checksum.update("\n".join(self.materials).encode())
            checksum.update(np.ascontiguousarray(self.face_material).tobytes())
        return checksum.hexdigest()

    @cached_property
    def bounds(self) -> np.ndarray:
        """(2, 3) float64 [m]: least and greatest coordinates of the vertices that triangles use."""
        used = np.zeros(len(self.vertices), dtype=bool)
        used[self.faces] = True
        points = self.vertices if used.all() else self.vertices[used]
        axes = [points[:, k] for k in range(3)]  # one by one takes a fifth of the time
        return np.array([[axis.min() for axis in axes], [axis.max() for axis in axes]])

    @cached_property
    def solid(self) -> np.ndarray:
        """(f,) int32: for each triangle the first one of the closed part of its chunk that it belongs to
        (`navmesh.level.solids`), or -1."""
        from navmesh.level.solids import closed_parts

        first = np.cumsum([0, *(chunk.faces for chunk in self.chunks[:-1])])
        return closed_parts(self.vertices, self.faces, first)

    @property
    def material_of_faces(self) -> np.ndarray:
        """(f,) str: the material of each triangle, "default" where it has none."""
        if not self.materials:
            return np.full(len(self.faces), DEFAULT_MATERIAL)
        return np.array(self.materials)[self.face_material]

    @classmethod
    def from_arrays(
        cls,
        vertices: Any,
        faces: Any,
        *,
        up: str = "z",
        scale: float = 1.0,
        name: str = "terrain",
        materials: Any = None,
    ) -> "Terrain":
        """A terrain from ``vertices`` (v, 3) and ``faces`` (f, 3) in the file's units and axes.

        ``up`` is the axis of the input that points up: "z" keeps (x, y, z), "y" makes it (x, -z, y),
        "x" makes it (y, z, x). ``scale`` [m per unit] is above 0. ``materials`` (f,) str names the material
        of each triangle; "" means "default", and names are cut to 64 characters. Raises `NavmeshError` for
        wrong shapes, coordinates that are not finite, indices out of range, and when there is no triangle.
        """
        if up not in _AXES:
            raise NavmeshError(f"{name}: up = {up!r}: expected one of 'x', 'y', 'z'")
        if not np.isfinite(scale) or scale <= 0:
            raise NavmeshError(f"{name}: scale = {scale!r}: expected metres per unit, above 0")
        try:
            points = np.asarray(vertices, dtype=np.float64)
            triangles = np.asarray(faces)
        except (TypeError, ValueError) as error:
            raise NavmeshError(f"{name}: vertices and faces must be arrays of numbers: {error}") from error
        if triangles.size == 0:
            raise NavmeshError(f"{name}: no triangles; a level needs at least one")
        if points.ndim != 2 or points.shape[1] != 3:
            raise NavmeshError(f"{name}: vertices have shape {points.shape}, expected (v, 3)")
        if triangles.ndim != 2 or triangles.shape[1] != 3 or not np.issubdtype(triangles.dtype, np.integer):
            raise NavmeshError(
                f"{name}: faces are {triangles.dtype} {triangles.shape}, expected integers (f, 3)"
            )
        outside = (triangles < 0) | (triangles >= len(points))
        if outside.any():
            at = int(np.flatnonzero(outside.any(axis=1))[0])
            raise NavmeshError(
                f"{name}: triangle {at} names vertices {triangles[at].tolist()}, there are {len(points)}"
            )
        broken = ~np.isfinite(points).all(axis=1)
        if broken.any():
            at = int(np.flatnonzero(broken)[0])
            raise NavmeshError(
                f"{name}: {int(broken.sum())} vertices are not finite; the first is vertex {at}: "
                f"{points[at].tolist()}"
            )
        moved = points[:, _AXES[up]] * (np.asarray(_SIGNS[up]) * float(scale))
        moved = np.ascontiguousarray(moved)
        if not np.isfinite(moved).all() or np.abs(moved).max(initial=0.0) > 1e9:
            raise NavmeshError(f"{name}: coordinates reach beyond 1e9 m after scaling by {scale:g}")
        names, coded = (), _none()
        if materials is not None:
            given = np.asarray(materials)
            if given.shape != (len(triangles),) or given.dtype.kind != "U":
                raise NavmeshError(
                    f"{name}: materials are {given.dtype} {given.shape}, expected a name for each of the "
                    f"{len(triangles)} triangles"
                )
            names, coded = coded_materials(given)
        indices = np.ascontiguousarray(triangles, dtype=np.int32)
        return cls(moved, indices, name, materials=names, face_material=coded)

    @classmethod
    def load(
        cls, path: str | os.PathLike[str], *, up: str | None = None, scale: float | None = None
    ) -> "Terrain":
        """Read a mesh file: OBJ, PLY, STL, OFF, glTF, FBX or USD (docs/guides/meshes.md).

        Scenes are flattened: every instance with its transform. ``up`` and ``scale`` as in `from_arrays`; by
        default what the file or its format says, which is y and metres for glTF, and z and 1 where neither
        says anything. Vertices that no triangle uses are left out. Raises `NavmeshError` that names the file
        when it is missing, not a mesh, damaged, or holds no usable triangle.
        """
        from navmesh.meshfiles import read_mesh

        mesh = read_mesh(path)
        used = np.zeros(len(mesh.vertices), dtype=bool)
        used[mesh.faces] = True
        faces = (np.cumsum(used) - 1)[mesh.faces]
        return cls.from_arrays(
            mesh.vertices[used],
            faces,
            up=mesh.up if up is None else up,
            scale=mesh.scale if scale is None else scale,
            name=str(path),
            materials=mesh.materials,
        )


def coded_materials(names: np.ndarray) -> tuple[tuple[str, ...], np.ndarray]:
    """The materials among ``names`` (f,) str, in alphabetical order, and for each name its place among them,
    (f,) int32; nothing where all are "default"."""
    named = np.where(names == "", DEFAULT_MATERIAL, names).astype("<U64")
    found, coded = np.unique(named, return_inverse=True)
    if found.tolist() == [DEFAULT_MATERIAL]:
        return (), _none()
    return tuple(found.tolist()), coded.reshape(-1).astype(np.int32)
