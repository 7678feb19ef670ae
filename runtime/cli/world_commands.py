"""What ``surefoot bake --open-world`` does once its arguments are parsed."""

import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import navmesh
from navmesh.streaming.world_folder import INDEX
from runtime.cli.commands import Result, print_values, ready
from runtime.errors import RuntimeInputError
from runtime.planning.rules import obstacle_rules, person_walk_rules
from surefoot.files.whole_folder import check_folder_target

__all__ = ["bake_world", "refuse_tags"]


def refuse_tags(level: Path, tags: Path | None) -> None:
    """Raise `RuntimeInputError` where there are corrections of ``level``'s obstacles: open worlds have
    none."""
    beside = navmesh.tags_path(level)
    authored = tags or (beside if beside.is_file() else None)
    if authored is not None:
        raise RuntimeInputError(
            f"{authored}: an open world cannot have corrections of its obstacles; "
            "bake without --open-world, or move the file away"
        )


def bake_world(
    level: Path,
    output: Path,
    up: str | None,
    scale: float | None,
    radii: Sequence[float],
    side: float,
    rules: Mapping[str, float | None],
    threads: int = 1,
) -> Result:
    """Cut ``level`` into chunks and write it as an open world for bodies of ``radii`` [m] to the folder
    ``output``."""
    check_folder_target(output, INDEX)
    progress = ready()
    walk_rules = person_walk_rules(**rules)
    with progress.stage(f"baking the open world of {level.name}"):
        begun = time.perf_counter()
        terrain = navmesh.Terrain.load(level, up=up, scale=scale)
        navmesh.bake_open_world(terrain, output, radii, side, walk_rules, obstacle_rules({}), threads)
        seconds = time.perf_counter() - begun
    world = navmesh.OpenWorld(output)
    values = {
        "level": str(level),
        "output": str(output),
        "size": (terrain.bounds[1] - terrain.bounds[0]).round(2).tolist(),
        "triangles": len(terrain.faces),
        "chunks": len(world.chunks),
        "radii": list(world.radii),
        "seconds": round(seconds, 3),
        "terrain_digest": terrain.digest,
    }
    return Result(values, True, lambda: print_values(values))
