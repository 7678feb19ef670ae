"""Routes between random places of the example levels, as they were.

``python -m tests.navmesh.routes.pinned_routes`` writes them anew, for a change that is meant to change them.
Pinned is what a user sees of a route: its status, its length to the millimetre, and the obstacles on its way.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

import navmesh

LEVELS = Path(__file__).resolve().parents[3] / "examples" / "levels"
PINNED = Path(__file__).with_suffix(".json")
NAMES = ("courtyard", "roofs")
_PAIRS, _RADII = 60, (0.2, 0.35, 0.6)
_SKILLS = {"jump": (0.1, 0.7), "vault": (0.6, 1.0), "drop": (0.9, 2.0), "gap": (0.4, 1.8)}


def routes(name: str) -> list[list[Any]]:
    """Of one level: [status, length [m], tags of the obstacles] for each query."""
    graph = navmesh.NodeGraph.build(navmesh.Terrain.load(LEVELS / f"{name}.obj", up="z"))
    rng = np.random.default_rng(20261126)
    roomy = graph.positions[graph.radii > max(_RADII)]
    places = roomy[rng.integers(len(roomy), size=(_PAIRS, 2))]
    told = []
    for number, (start, goal) in enumerate(places):
        skills = _SKILLS if number % 2 else None
        route = graph.find_path(start, goal, radius=_RADII[number % len(_RADII)], skills=skills)
        tags = [str(graph.obstacles.tag[link.obstacle]) for link in route.links]
        told.append([route.status, round(route.length, 3), tags])
    return told


if __name__ == "__main__":
    lines = [f'"{name}": [\n' + ",\n".join(map(json.dumps, routes(name))) + "\n]" for name in NAMES]
    PINNED.write_text("{\n" + ",\n".join(lines) + "\n}\n")
