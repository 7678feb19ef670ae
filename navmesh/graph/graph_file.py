"""Baked graphs as files: what an archive of a graph holds, and what has to hold between its arrays.

Compiled code follows the numbers in these arrays without looking, so all of them are looked at here.
"""

from __future__ import annotations

import os
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from annotated_types import Ge, Gt, Le, Len

from navmesh.graph.links import Links
from navmesh.graph.packed_surface import PACKED_SURFACE, columns_of, pack_surface, unpack_surface
from navmesh.level.terrain import Chunk, Terrain
from navmesh.obstacles.kinds import LONGEST_NAME, affordances
from navmesh.obstacles.obstacles import Obstacles
from navmesh.obstacles.rules import ObstacleRules
from navmesh.obstacles.tagging import TagFile
from navmesh.obstacles.tags import Tags
from navmesh.rules import WalkRules
from surefoot.files.archive import ArchiveError, read_archive, write_archive
from surefoot.files.schema import Array, Flags, Header, Indices, Numbers, Offsets, Schema, Words

if TYPE_CHECKING:
    from navmesh.graph.node_graph import NodeGraph

__all__ = ["GRAPH_FILE", "read_graph", "write_graph"]

_Side = Annotated[int, Ge(1), Le(400_000_000)]
_Count = Annotated[int, Ge(0), Le(2**31 - 1)]
_UNIT = 1e-6  # by which a direction's length may be off 1
_SLACK = 1e-6  # [m] by which the places of a file may be off the grid


class _GraphHeader(Header):
    """``terrain``: digest of it. ``level``: its name. ``shape``: columns in x and y."""

    terrain: str
    level: str
    rules: dict[str, float]
    resolution: Annotated[float, Gt(0.0)]
    shape: tuple[_Side, _Side]
    chunks: Annotated[tuple[tuple[str, _Count, _Count], ...], Len(1)]
    obstacle_rules: dict[str, Any] | None
    tags: Tags | None


_GRAPH: dict[str, Array] = {
    "positions": Numbers("nodes", 3),
    "radii": Numbers("nodes", low=0.0),
    "node_cell": Indices("nodes", into="cells"),
    "label": Indices("cells", into="nodes", none=True),
    "edge_start": Offsets("nodes", into="edges"),
    "edge_target": Indices("edges", into="nodes"),
    "edge_width": Numbers("edges", low=0.0),
    "edge_gate": Numbers("edges", 2),
    "edge_cells": Indices("edges", 2, into="cells"),
}
_OBSTACLES: dict[str, Array] = {
    "affordance": Words("obstacles", longest=LONGEST_NAME, among=affordances),
    "position": Numbers("obstacles", 3),
    "normal": Numbers("obstacles", 3, low=-1.0 - _UNIT, high=1.0 + _UNIT),
    "height": Numbers("obstacles"),
    "depth": Numbers("obstacles", low=0.0),
    "width": Numbers("obstacles", low=0.0),
    "rim": Numbers("obstacles", 2, 3),
    "rim_height": Numbers("obstacles", 2),
    "run_up": Numbers("obstacles", low=0.0),
    "landing": Numbers("obstacles", low=0.0),
    "rise": Numbers("obstacles"),
    "tag": Words("obstacles"),
    "authored": Flags("obstacles"),
}
_LINKS: dict[str, Array] = {
    "start": Numbers("links", 3),
    "edge": Numbers("links", 3),
    "end": Numbers("links", 3),
    "start_cell": Indices("links", into="cells"),
    "end_cell": Indices("links", into="cells"),
    "obstacle": Indices("links", into="obstacles"),
    "affordance": Words("links", longest=LONGEST_NAME, among=affordances),
    "height": Numbers("links"),
    "run_up": Numbers("links", low=0.0),
    "radius": Numbers("links", low=0.0),
    "cost": Numbers("links", low=0.0),
}
_TERRAIN: dict[str, Array] = {
    "vertices": Numbers("vertices", 3),
    "faces": Indices("faces", 3, into="vertices"),
    "materials": Words("materials"),
    "face_material": Indices("painted", into="materials"),
}
_PARTS = {
    "surface_": PACKED_SURFACE,
    "": _GRAPH,
    "obstacles_": _OBSTACLES,
    "links_": _LINKS,
    "terrain_": _TERRAIN,
}


def _check(header: _GraphHeader, arrays: dict[str, np.ndarray]) -> str | None:
    """What does not hold between the arrays of a graph; None where all does."""
    for problem in (_check_terrain, _check_nodes, _check_links):
        if found := problem(header, arrays):
            return found
    return None


def _check_terrain(header: _GraphHeader, arrays: dict[str, np.ndarray]) -> str | None:
    vertices, faces = len(arrays["terrain_vertices"]), len(arrays["terrain_faces"])
    names = [name for name, _, _ in header.chunks]
    if not faces or sum(each[1] for each in header.chunks) != vertices:
        return "its chunks are not made of the terrain's vertices"
    if sum(each[2] for each in header.chunks) != faces or any(a >= b for a, b in pairwise(names)):
        return "its chunks are not made of the terrain's triangles, or not in the order of their names"
    materials = arrays["terrain_materials"].tolist()
    if len(arrays["terrain_face_material"]) != (faces if materials else 0):
        return "its triangles do not have one material each"
    if sorted(set(materials)) != materials:
        return "its materials are not in the order of their names"
    count, owned = [each[1] for each in header.chunks], [each[2] for each in header.chunks]
    last = np.repeat(np.cumsum(count), owned)[:, None]
    used = arrays["terrain_faces"]
    if ((used < last - np.repeat(count, owned)[:, None]) | (used >= last)).any():
        return "a chunk has triangles with vertices of another one"
    return None


def _check_nodes(header: _GraphHeader, arrays: dict[str, np.ndarray]) -> str | None:
    """Discs lie within the grid, each about its own cell; no edge leads from a node to itself."""
    if not len(arrays["radii"]):
        return "has no nodes"
    high = np.array(header.shape) * header.resolution
    at, radii = (arrays["positions"] - arrays["surface_origin"])[:, :2], arrays["radii"][:, None]
    out = ((at - radii < -_SLACK) | (at + radii > high + _SLACK)).any(axis=1)
    if out.any():
        return f"the disc of node {int(np.argmax(out))} reaches beyond the grid"
    # the middle of a passage is at most a cell from its cell's centre, and beyond it where no link leads on
    if problem := _apart(header, arrays, "positions", arrays["node_cell"], 0.5 * header.resolution + _SLACK):
        return problem
    source = np.repeat(np.arange(len(radii), dtype=np.int32), np.diff(arrays["edge_start"]))
    itself = source == arrays["edge_target"]
    return f"edge_target[{int(np.argmax(itself))}] leads to its own node" if itself.any() else None


def _check_links(header: _GraphHeader, arrays: dict[str, np.ndarray]) -> str | None:
    off = np.abs(np.linalg.norm(arrays["obstacles_normal"][:, :2], axis=1) - 1.0) > _UNIT
    if off.any():
        return f"obstacles_normal[{int(np.argmax(off))}] is no horizontal direction"
    for end in ("start", "end"):
        if problem := _apart(header, arrays, f"links_{end}", arrays[f"links_{end}_cell"]):
            return problem
    return None


def _apart(
    header: _GraphHeader, arrays: dict[str, np.ndarray], name: str, cells: np.ndarray, beyond: float = _SLACK
) -> str | None:
    """Whether a place of the array ``name`` (k, 3) is more than ``beyond`` [m] outside of the square of its
    cell (k,)."""
    h = header.resolution
    columns = columns_of(arrays["surface_count"], cells)
    squares = np.stack(np.divmod(columns, header.shape[1]), axis=1) * h
    off = (arrays[name] - arrays["surface_origin"])[:, :2] - squares
    out = ((off < -beyond) | (off > h + beyond)).any(axis=1)
    return f"{name}[{int(np.argmax(out))}] is not in its cell" if out.any() else None


GRAPH_FILE = Schema(
    kind="surefoot navigation graph",
    version=8,
    header=_GraphHeader,
    arrays={prefix + name: array for prefix, part in _PARTS.items() for name, array in part.items()},
    remedy="bake it again",
    check=_check,
)


def write_graph(path: str | os.PathLike[str], graph: NodeGraph) -> None:
    """Write ``graph`` to ``path``, whole or not at all."""
    parts = {"": graph, "obstacles_": graph.obstacles, "links_": graph.links, "terrain_": graph.terrain}
    arrays = {
        prefix + name: np.asarray(getattr(part, name))
        for prefix, part in parts.items()
        for name in _PARTS[prefix]
    }
    arrays |= {f"surface_{name}": array for name, array in pack_surface(graph.surface).items()}
    arrays["terrain_materials"] = np.array(graph.terrain.materials, dtype=np.str_)
    header = {
        "terrain": graph.terrain.digest,
        "level": graph.terrain.name,
        "rules": graph.rules.to_dict(),
        "resolution": graph.surface.resolution,
        "shape": list(graph.surface.shape),
        "chunks": [list(chunk) for chunk in graph.terrain.chunks],
        "obstacle_rules": None if graph.obstacle_rules is None else graph.obstacle_rules.to_dict(),
        "tags": None if graph.tags is None else graph.tags.tags.model_dump(mode="json", exclude_none=True),
    }
    write_archive(path, GRAPH_FILE.kind, GRAPH_FILE.version, header, arrays)


def read_graph(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The fields of the graph that `write_graph` wrote, as `NodeGraph` takes them.

    Raises `ArchiveError` for a file that is missing, damaged, or of another version, and for one with
    anything in it that no graph has.
    """
    header, arrays = read_archive(path, GRAPH_FILE)
    part = {prefix: {name: arrays[prefix + name] for name in names} for prefix, names in _PARTS.items()}
    terrain = Terrain(
        vertices=part["terrain_"]["vertices"],
        faces=part["terrain_"]["faces"],
        name=header.level,
        chunks=tuple(Chunk(*chunk) for chunk in header.chunks),
        materials=tuple(part["terrain_"]["materials"].tolist()),
        face_material=part["terrain_"]["face_material"],
    )
    if terrain.digest != header.terrain:
        raise ArchiveError(f"{path}: the navigation graph's terrain is damaged; bake it again")
    try:
        rules = WalkRules.from_dict(header.rules)
        obstacle_rules = header.obstacle_rules
        found = None if obstacle_rules is None else ObstacleRules.from_dict(obstacle_rules)
    except ValueError as error:
        raise ArchiveError(f"{path}: the navigation graph's rules: {error}; bake it again") from None
    if rules.resolution != header.resolution:
        raise ArchiveError(
            f"{path}: the navigation graph's resolution is not that of its rules; bake it again"
        )
    try:
        surface = unpack_surface(part["surface_"], header.resolution, header.shape)
    except ValueError as error:
        raise ArchiveError(f"{path}: the navigation graph's surface: {error}; bake it again") from None
    return {
        "terrain": terrain,
        "rules": rules,
        "surface": surface,
        **part[""],
        "obstacles": Obstacles(**part["obstacles_"]),
        "links": Links(**part["links_"]),
        "obstacle_rules": found,
        "tags": None if header.tags is None else TagFile(header.tags),
    }
