"""The offline step: a level becomes a folder from which `OpenWorld` loads chunks."""

import os
from collections.abc import Mapping, Sequence
from math import isfinite
from numbers import Real
from pathlib import Path

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.graph.node_graph import NodeGraph
from navmesh.graph.open_to_body import checked_radius
from navmesh.level.chunks import chunks_of, join_chunks
from navmesh.level.terrain import Terrain
from navmesh.obstacles.rules import ObstacleRules
from navmesh.rules import WalkRules
from navmesh.streaming.coarse_graph import coarse_graph_of
from navmesh.streaming.cutting import cut_level
from navmesh.streaming.footprint import footprint_of
from navmesh.streaming.world_folder import INDEX, Body, WorldIndex, write_world
from navmesh.threads import checked_threads
from surefoot.files.whole_folder import check_folder_target, whole_folder

__all__ = ["LEAST_SIDE", "bake_open_world"]

LEAST_SIDE = 10.0
"""[m] of the squares that a level is cut into."""
_OBSTACLE_RULES = ObstacleRules()


def bake_open_world(
    level: Terrain | Mapping[str, Terrain],
    folder: str | os.PathLike[str],
    radii: Sequence[float] = (0.3,),
    side: float = 60.0,
    rules: WalkRules | None = None,
    obstacle_rules: ObstacleRules | None = _OBSTACLE_RULES,
    threads: int = 1,
) -> Path:
    """Write an open world to ``folder``, for `navmesh.OpenWorld`: the chunks of ``level`` and a coarse graph
    of the whole for a body of each of ``radii`` [m].

    A `Terrain` that is not made of chunks is cut into squares of ``side`` [m], at least `LEAST_SIDE`; chunks
    are taken as they are. ``side`` is that of the coarse graph's squares, too. ``rules``, ``obstacle_rules``
    and ``threads`` as for `NodeGraph.build`: the fine graph of the whole is built once, here, so it has to
    fit into memory. The folder appears whole or not at all; one that holds an open world is replaced. Returns
    its path. Raises `NavmeshError` for arguments of a wrong kind, `SurefootError` for a folder that cannot be
    written or holds anything else.
    """
    bodies = _checked_radii(radii)
    threads = checked_threads(threads)
    check_folder_target(folder, INDEX)
    chunks = _chunks(level, _checked_side(side))
    name = level.name if isinstance(level, Terrain) else "level"
    graph = NodeGraph.build(join_chunks(chunks, name), rules, obstacle_rules, threads=threads)
    names = sorted(chunks)
    index = WorldIndex(
        level=name,
        rules=graph.rules,
        obstacle_rules=obstacle_rules,
        names=tuple(names),
        digests=tuple(chunks[each].digest for each in names),
        bounds=np.stack([chunks[each].bounds for each in names]),
        extent=graph.extent,
        corner=graph.surface.origin,
        bodies=tuple(_body(graph, radius, float(side), threads) for radius in bodies),
    )
    with whole_folder(folder, INDEX) as temporary:
        write_world(temporary, index, chunks)
    return Path(folder)


def _body(graph: NodeGraph, radius: float, side: float, threads: int) -> Body:
    coarse, region = coarse_graph_of(graph, radius, side, threads)
    return Body(radius, coarse, footprint_of(graph, radius, region))


def _chunks(level: Terrain | Mapping[str, Terrain], side: float) -> dict[str, Terrain]:
    if not isinstance(level, Terrain | Mapping):
        raise NavmeshError(f"level: expected a Terrain, or Terrains by name, not a {type(level).__name__}")
    if isinstance(level, Mapping):
        return chunks_of(join_chunks(level))  # which checks them
    if [chunk.name for chunk in level.chunks] == ["level"]:
        return cut_level(level, side)
    return chunks_of(level)


def _checked_radii(radii: Sequence[float]) -> list[float]:
    try:
        found = sorted({checked_radius(radius) for radius in radii})
    except TypeError:
        raise NavmeshError(f"radii: expected radii of bodies [m], as in (0.3, 0.6), not {radii!r}") from None
    if not found:
        raise NavmeshError("radii: none; expected at least one radius of a body [m]")
    return found


def _checked_side(side: float) -> float:
    number = isinstance(side, Real) and not isinstance(side, bool)
    if not (number and isfinite(side) and side >= LEAST_SIDE):
        raise NavmeshError(f"side = {side!r}: expected a length [m] of at least {LEAST_SIDE:g}")
    return float(side)
