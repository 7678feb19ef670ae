"""Levels in named chunks: put together, taken apart, changed."""

import bisect
import math
from collections.abc import Collection, Mapping
from numbers import Real

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.level.solids import closed_parts
from navmesh.level.terrain import Chunk, Terrain, coded_materials

__all__ = ["change_chunks", "check_changes", "chunks_by_square", "chunks_of", "join_chunks", "split_terrain"]


def _check_name(name: object) -> None:
    if not isinstance(name, str):
        raise NavmeshError(f"chunk {name!r}: expected a name that is a text, not a {type(name).__name__}")


def join_chunks(chunks: Mapping[str, Terrain], name: str = "terrain") -> Terrain:
    """One terrain of named ``chunks``: the same whatever their order. Raises `NavmeshError` for none."""
    if not isinstance(chunks, Mapping):
        raise NavmeshError(f"chunks: expected Terrains by name, as in {{'hall': terrain}}, not {chunks!r}")
    for key, chunk in chunks.items():
        _check_name(key)
        if not isinstance(chunk, Terrain):
            raise NavmeshError(f"chunk {key!r} is a {type(chunk).__name__}; expected a Terrain")
    if not chunks:
        raise NavmeshError(f"{name}: no chunks; a level needs at least one")
    names = sorted(chunks)
    painted = any(chunk.materials for chunk in chunks.values())
    counts = [len(chunks[key].vertices) for key in names]
    shift = np.concatenate(([0], np.cumsum(counts)))
    faces = [chunks[key].faces + np.int32(at) for key, at in zip(names, shift[:-1], strict=True)]
    return Terrain(
        np.concatenate([chunks[key].vertices for key in names]),
        np.concatenate(faces).astype(np.int32),
        name,
        tuple(Chunk(key, len(chunks[key].vertices), len(chunks[key].faces)) for key in names),
        *_materials([chunks[key].material_of_faces for key in names] if painted else []),
    )


def chunks_of(terrain: Terrain) -> dict[str, Terrain]:
    """The chunks of ``terrain`` by name."""
    found, vertex, face = {}, 0, 0
    for chunk in terrain.chunks:
        vertices = terrain.vertices[vertex : vertex + chunk.vertices]
        faces = terrain.faces[face : face + chunk.faces] - np.int32(vertex)
        own = slice(face, face + chunk.faces)
        found[chunk.name] = Terrain(vertices, faces, chunk.name, (), *_materials_of(terrain, own))
        vertex, face = vertex + chunk.vertices, face + chunk.faces
    return found


def split_terrain(terrain: Terrain, side: float) -> dict[str, Terrain]:
    """``terrain`` in chunks by squares of ``side`` [m], called "ix,iy": each has the triangles with their
    middle in its square. Raises `NavmeshError` for a side that is not above 0."""
    number = isinstance(side, Real) and not isinstance(side, bool)
    if not (number and math.isfinite(side) and side > 0.0):
        raise NavmeshError(f"side = {side!r}: expected a length [m] above 0")
    middle = terrain.vertices[terrain.faces].mean(axis=1)
    return chunks_by_square(terrain, np.floor(middle[:, :2] / side).astype(np.int64))


def chunks_by_square(terrain: Terrain, square: np.ndarray) -> dict[str, Terrain]:
    """``terrain`` in chunks called "ix,iy", by the ``square`` (f, 2) int64 of each triangle."""
    squares, owner = np.unique(square, axis=0, return_inverse=True)
    found = {}
    for k, (ix, iy) in enumerate(squares.tolist()):
        own = owner.reshape(-1) == k
        used, faces = np.unique(terrain.faces[own], return_inverse=True)
        name = f"{ix},{iy}"
        triangles = faces.reshape(-1, 3).astype(np.int32)
        found[name] = Terrain(terrain.vertices[used], triangles, name, (), *_materials_of(terrain, own))
    return found


def check_changes(names: Collection[str], changes: Mapping[str, Terrain | None], level: str) -> list[str]:
    """The names, rising, of the chunks that there are after ``changes`` to a ``level`` with chunks of these
    ``names``. Raises `NavmeshError` for the removal of a chunk that is not there, and when none is left."""
    if not isinstance(changes, Mapping):
        raise NavmeshError(f"changes: expected chunks by name, as in {{'hall': terrain}}, not {changes!r}")
    after = set(names)
    for name, chunk in changes.items():
        _check_name(name)
        if not (chunk is None or isinstance(chunk, Terrain)):
            raise NavmeshError(
                f"chunk {name!r} is a {type(chunk).__name__}; expected a Terrain, or None to remove it"
            )
        if chunk is not None:
            after.add(name)
        elif name in after:
            after.remove(name)
        else:
            known = ", ".join(sorted(names)[:20]) or "none"
            raise NavmeshError(f"there is no chunk {name!r} to remove; there are {known}")
    if not after:
        raise NavmeshError(f"{level}: the change removes all chunks; a level needs at least one")
    return sorted(after)


def change_chunks(
    terrain: Terrain, changes: Mapping[str, Terrain | None]
) -> tuple[Terrain, list[np.ndarray]]:
    """``terrain`` after ``changes``: chunks by name, to be added or replaced, or None to be removed.

    Returns it and, for each chunk that is another than before, the bounds (2, 3) [m] of what it was and is.
    Raises `NavmeshError` for the removal of a chunk that is not there, and when none is left.
    """
    names = [chunk.name for chunk in terrain.chunks]
    check_changes(names, changes, terrain.name)
    corner = np.concatenate(([0], np.cumsum([chunk.vertices for chunk in terrain.chunks])))
    face = np.concatenate(([0], np.cumsum([chunk.faces for chunk in terrain.chunks])))
    vertices, faces, solid, chunks, changed = [], [], [], [], []
    paints: list[np.ndarray] = []
    painted = bool(terrain.materials) or any(each is not None and each.materials for each in changes.values())
    paint = terrain.material_of_faces if painted else np.empty(0, "U1")
    count, triangles, after = 0, 0, 0  # vertices and faces so far; the first old chunk that is still to come

    def keep(until: int) -> None:
        nonlocal count, triangles, after
        vertices.append(terrain.vertices[corner[after] : corner[until]])
        faces.append(terrain.faces[face[after] : face[until]] + np.int32(count - corner[after]))
        was = terrain.solid[face[after] : face[until]]
        solid.append(np.where(was < 0, -1, was + np.int32(triangles - face[after])))
        if painted:
            paints.append(paint[face[after] : face[until]])
        chunks.extend(terrain.chunks[after:until])
        count, triangles, after = count + len(vertices[-1]), triangles + len(was), until

    for name in sorted(changes):
        at, new = bisect.bisect_left(names, name), changes[name]
        keep(at)
        bounds = []
        if at < len(names) and names[at] == name:
            old = terrain.vertices[corner[at] : corner[at + 1]]
            old_faces = terrain.faces[face[at] : face[at + 1]] - np.int32(corner[at])
            own = slice(face[at], face[at + 1])
            if (
                new is not None
                and np.array_equal(new.vertices, old)
                and np.array_equal(new.faces, old_faces)
                and (not painted or np.array_equal(new.material_of_faces, paint[own]))
            ):
                continue
            after = at + 1
            bounds.append(_bounds(old))
        if new is not None:
            vertices.append(new.vertices)
            faces.append(new.faces + np.int32(count))
            if painted:
                paints.append(new.material_of_faces)
            chunks.append(Chunk(name, len(new.vertices), len(new.faces)))
            own = closed_parts(new.vertices, new.faces, np.zeros(1, np.int64))
            solid.append(np.where(own < 0, -1, own + np.int32(triangles)))
            count, triangles = count + len(new.vertices), triangles + len(new.faces)
            bounds.append(_bounds(new.vertices))
        changed.append(np.stack([np.min(bounds, axis=0)[0], np.max(bounds, axis=0)[1]]))
    keep(len(names))
    if not changed:
        return terrain, []
    after_all = Terrain(
        np.concatenate(vertices), np.concatenate(faces), terrain.name, tuple(chunks), *_materials(paints)
    )
    after_all.__dict__["solid"] = np.concatenate(solid)  # what stays is not worked out anew
    return after_all, changed


def _materials(of_faces: list[np.ndarray]) -> tuple:
    """The materials of parts, by the names of each part's faces, put together: the last fields of a
    `Terrain`. Nothing where no part has any."""
    return coded_materials(np.concatenate(of_faces)) if of_faces else ()


def _materials_of(terrain: Terrain, faces: slice | np.ndarray) -> tuple:
    """The materials of some ``faces`` of a terrain: the last fields of their `Terrain`."""
    return coded_materials(terrain.material_of_faces[faces]) if terrain.materials else ()


def _bounds(vertices: np.ndarray) -> np.ndarray:
    return np.stack([vertices.min(axis=0), vertices.max(axis=0)])
