"""An open world as a folder: the meshes of its chunks, and one file with the coarse graphs of all of it.

Compiled code follows the numbers in these arrays without looking, so all of them are looked at here.
"""

import os
from collections.abc import Mapping
from dataclasses import dataclass, fields
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from annotated_types import Gt, Len

from navmesh.errors import NavmeshError
from navmesh.level.terrain import Terrain
from navmesh.obstacles.kinds import LONGEST_NAME, affordances
from navmesh.obstacles.rules import ObstacleRules
from navmesh.rules import WalkRules
from navmesh.streaming.coarse_graph import CoarseGraph
from navmesh.streaming.footprint import Footprint
from surefoot.files.archive import ArchiveError, read_archive, write_archive
from surefoot.files.schema import Array, Header, Indices, Numbers, Offsets, Schema, Words

__all__ = [
    "CHUNK_FILE",
    "INDEX",
    "WORLD_FILE",
    "Body",
    "WorldIndex",
    "read_chunk",
    "read_index",
    "write_world",
]

INDEX = "world.npz"
"""Name of the file with everything but the meshes."""


class _ChunkHeader(Header):
    """``name``: of the chunk."""

    name: str


class _WorldHeader(Header):
    """``chunks``: name and digest of each. ``radii`` [m]: of the bodies, rising."""

    level: str
    rules: dict[str, float]
    obstacle_rules: dict[str, Any] | None
    radii: Annotated[tuple[Annotated[float, Gt(0.0)], ...], Len(1)]
    chunks: Annotated[tuple[tuple[str, str], ...], Len(1)]


def _body_arrays(header: _WorldHeader) -> dict[str, Array]:
    arrays: dict[str, Array] = {
        "bounds": Numbers(len(header.chunks), 2, 3),
        "extent": Numbers(2, 3),
        "corner": Numbers(3),
    }
    for k in range(len(header.radii)):
        regions, terminals, edges, leaps, runs = (
            f"{name} of body {k}" for name in ("regions", "terminals", "edges", "leaps", "runs")
        )
        arrays |= {
            f"coarse{k}_{name}": array
            for name, array in {
                "part": Indices(regions, into=regions),
                "place": Numbers(terminals, 3),
                "member_start": Offsets(regions, into=f"members of body {k}"),
                "member": Indices(f"members of body {k}", into=terminals),
                "edge_start": Offsets(terminals, into=edges),
                "edge_target": Indices(edges, into=terminals),
                "edge_length": Numbers(edges, low=0.0, dtype="float32"),
                "leap_start": Offsets(terminals, into=leaps),
                "leap_target": Indices(leaps, into=terminals),
                "leap_cost": Numbers(leaps, low=0.0),
                "leap_from": Indices(leaps, into=regions),
                "leap_to": Indices(leaps, into=regions),
                "leap_kind": Words(leaps, longest=LONGEST_NAME, among=affordances),
                "leap_height": Numbers(leaps),
            }.items()
        }
        arrays |= {
            f"footprint{k}_{name}": array
            for name, array in {
                "row_start": Offsets("rows", into=runs),
                "first": Numbers(runs, low=0, high=2**31 - 1, dtype="int32"),
                "last": Numbers(runs, low=0, high=2**31 - 1, dtype="int32"),
                "height": Numbers(runs, dtype="float32"),
                "slope": Numbers(runs, dtype="float32"),
                "region": Indices(runs, into=regions),
            }.items()
        }
    return arrays


def _check_world(header: _WorldHeader, arrays: dict[str, np.ndarray]) -> str | None:
    """What does not hold between the arrays of a world; None where all does."""
    names = [name for name, _ in header.chunks]
    if any(a >= b for a, b in pairwise(names)):
        return "its chunks are not in the order of their names"
    if any(a >= b for a, b in pairwise(header.radii)):
        return "its radii do not rise"
    for name in ("bounds", "extent"):
        box = arrays[name].reshape(-1, 2, 3)
        if (box[:, 0] > box[:, 1]).any():
            return f"{name} has a corner that is not the least"
    for k in range(len(header.radii)):
        place = arrays[f"coarse{k}_place"]
        for start, target, length in (
            ("edge_start", "edge_target", "edge_length"),
            ("leap_start", "leap_target", "leap_cost"),
        ):
            source = np.repeat(np.arange(len(place)), np.diff(arrays[f"coarse{k}_{start}"]))
            straight = np.linalg.norm(place[source] - place[arrays[f"coarse{k}_{target}"]], axis=1)
            short = arrays[f"coarse{k}_{length}"] < straight - 1e-6
            if short.any():
                return f"coarse{k}_{length}[{int(np.argmax(short))}] is less than the straight line"
        if (arrays[f"footprint{k}_last"] < arrays[f"footprint{k}_first"]).any():
            return f"footprint{k} has a run that ends before it begins"
    return None


_REMEDY = "bake the world again"
CHUNK_FILE = Schema(
    kind="surefoot chunk",
    version=1,
    header=_ChunkHeader,
    arrays={
        "vertices": Numbers("vertices", 3),
        "faces": Indices("faces", 3, into="vertices"),
        "materials": Words("materials"),
        "face_material": Indices("painted", into="materials"),
    },
    remedy=_REMEDY,
)
WORLD_FILE = Schema(
    kind="surefoot open world",
    version=1,
    header=_WorldHeader,
    arrays=_body_arrays,
    remedy=_REMEDY,
    check=_check_world,
)


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """What is known of the whole world for one body radius."""

    radius: float
    """[m]."""
    coarse: CoarseGraph
    footprint: Footprint


@dataclass(frozen=True, slots=True, eq=False)
class WorldIndex:
    """All of a world but its meshes."""

    level: str
    """Its name, for messages."""
    rules: WalkRules
    obstacle_rules: ObstacleRules | None
    names: tuple[str, ...]
    """Of its c chunks, rising."""
    digests: tuple[str, ...]
    """`Terrain.digest` of each."""
    bounds: np.ndarray
    """(c, 2, 3) float64 [m] of each."""
    extent: np.ndarray
    """(2, 3) float64 [m]: what `NodeGraph.build` is given."""
    corner: np.ndarray
    """(3,) float64 [m]: the corner of the grid."""
    bodies: tuple[Body, ...]
    """By rising radius."""


def _chunk_path(folder: Path, number: int) -> Path:
    return folder / f"chunk-{number:05d}.npz"


def _arrays_of(part: CoarseGraph | Footprint, prefix: str) -> dict[str, np.ndarray]:
    return {prefix + field.name: getattr(part, field.name) for field in fields(part)}


def write_world(folder: Path, index: WorldIndex, chunks: Mapping[str, Terrain]) -> None:
    """Write ``index`` and its ``chunks`` into ``folder``, which is there."""
    for number, name in enumerate(index.names):
        chunk = chunks[name]
        arrays = {
            "vertices": chunk.vertices,
            "faces": chunk.faces,
            "materials": np.array(chunk.materials, dtype=np.str_),
            "face_material": chunk.face_material,
        }
        write_archive(
            _chunk_path(folder, number), CHUNK_FILE.kind, CHUNK_FILE.version, {"name": name}, arrays
        )
    arrays = {"bounds": index.bounds, "extent": index.extent, "corner": index.corner}
    for k, body in enumerate(index.bodies):
        arrays |= _arrays_of(body.coarse, f"coarse{k}_") | _arrays_of(body.footprint, f"footprint{k}_")
    rules = index.obstacle_rules
    header = {
        "level": index.level,
        "rules": index.rules.to_dict(),
        "obstacle_rules": None if rules is None else rules.to_dict(),
        "radii": [body.radius for body in index.bodies],
        "chunks": [list(each) for each in zip(index.names, index.digests, strict=True)],
    }
    write_archive(folder / INDEX, WORLD_FILE.kind, WORLD_FILE.version, header, arrays)


def read_index(folder: str | os.PathLike[str]) -> WorldIndex:
    """The index of the world in ``folder``. Raises `NavmeshError` where there is none, `ArchiveError` for one
    that is damaged or of another version."""
    path = Path(folder)
    if not (path / INDEX).is_file():
        raise NavmeshError(f"{path}: no open world there; expected a folder that bake_open_world has written")
    header, arrays = read_archive(path / INDEX, WORLD_FILE)
    try:
        rules = WalkRules.from_dict(header.rules)
        found = header.obstacle_rules
        obstacle_rules = None if found is None else ObstacleRules.from_dict(found)
    except ValueError as error:
        raise ArchiveError(f"{path / INDEX}: the world's rules: {error}; {_REMEDY}") from None

    def part(prefix: str) -> dict[str, np.ndarray]:
        return {name.removeprefix(prefix): arrays[name] for name in arrays if name.startswith(prefix)}

    bodies = [
        Body(radius, CoarseGraph(**part(f"coarse{k}_")), Footprint(**part(f"footprint{k}_")))
        for k, radius in enumerate(header.radii)
    ]
    return WorldIndex(
        level=header.level,
        rules=rules,
        obstacle_rules=obstacle_rules,
        names=tuple(name for name, _ in header.chunks),
        digests=tuple(digest for _, digest in header.chunks),
        bounds=arrays["bounds"],
        extent=arrays["extent"],
        corner=arrays["corner"],
        bodies=tuple(bodies),
    )


def read_chunk(folder: str | os.PathLike[str], index: WorldIndex, number: int) -> Terrain:
    """The mesh of a chunk. Raises `ArchiveError` where it is missing, damaged, or not the one of the
    index."""
    path = _chunk_path(Path(folder), number)
    _, arrays = read_archive(path, CHUNK_FILE)
    faces, materials = arrays["faces"], tuple(arrays["materials"].tolist())
    if not len(faces):
        raise ArchiveError(f"{path}: has no triangles; {_REMEDY}")
    if len(arrays["face_material"]) != (len(faces) if materials else 0):
        raise ArchiveError(f"{path}: its triangles do not have one material each; {_REMEDY}")
    chunk = Terrain(arrays["vertices"], faces, index.names[number], (), materials, arrays["face_material"])
    if chunk.digest != index.digests[number]:
        raise ArchiveError(f"{path}: is not the chunk {index.names[number]!r} of its world; {_REMEDY}")
    return chunk
