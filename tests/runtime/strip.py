"""An open world that is a strip of floors behind one another, and one that no way leads to."""

from functools import cache
from pathlib import Path
from tempfile import mkdtemp

import navmesh
from runtime.planning.rules import obstacle_rules, person_walk_rules
from tests.runtime.changing_level import quad

__all__ = ["END", "ISLAND", "LENGTH", "START", "strip", "strip_folder"]

LENGTH, SIDE = 120.0, 10.0  # [m]
START, END, ISLAND = (4.0, 5.0, 0.0), (116.0, 5.0, 0.0), (45.0, 95.0, 0.0)


@cache
def strip_folder() -> Path:
    """Where it is baked."""
    count = int(LENGTH / SIDE)
    chunks = {f"{k:02}": quad(SIDE * k, 0.0, SIDE * (k + 1), 10.0) for k in range(count)}
    chunks["island"] = quad(40.0, 90.0, 50.0, 100.0)
    folder = Path(mkdtemp()) / "strip.world"
    return navmesh.bake_open_world(chunks, folder, (0.3, 0.5), 20.0, person_walk_rules(), obstacle_rules({}))


def strip(*around: tuple[float, float, float], radius: float = 25.0) -> navmesh.OpenWorld:
    """The world with everything loaded that is to be around places."""
    world = navmesh.OpenWorld(strip_folder(), radius)
    world.keep_around(around or [START], changes=100)
    return world
