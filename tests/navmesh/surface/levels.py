"""Graphs of small levels with known answers, and random levels."""

import math
from dataclasses import fields

import numpy as np

from navmesh import NodeGraph, WalkRules
from navmesh.surface.surface import Surface
from tests.navmesh.shapes import box, plane, quad, terrain

RULES = WalkRules(max_step=0.4, headroom=2.0, resolution=0.25)


def build(*meshes, rules: WalkRules = RULES) -> NodeGraph:
    return NodeGraph.build(terrain(*meshes), rules, obstacle_rules=None)


def arrays_of(surface: Surface) -> dict[str, np.ndarray]:
    """All that a surface holds, by name, its floors unpacked."""
    kept = {field.name: getattr(surface, field.name) for field in fields(surface) if field.name != "floor"}
    return kept | {name: getattr(surface, name) for name in ("nearest", "height", "gradient")}


def parts(graph: NodeGraph, radius: float, *points) -> list[int]:
    """For each point the first node of its part of the graph: equal numbers are connected."""
    return [int(min(graph.reachable_nodes(p, radius), default=-1)) for p in points]


def random_level(seed: int) -> list:
    """A floor with boxes, ramps, ledges, shelves and thin walls strewn over it."""
    rng = np.random.default_rng(seed)
    level = [plane(0, 10, 0, 10)]
    for _ in range(rng.integers(3, 9)):
        x, y = rng.uniform(0.5, 8, 2)
        a, b = rng.uniform(0.05, 3, 2)
        kind = rng.integers(5)
        if kind == 0:
            level.append(box(x, x + a, y, y + b, 0, rng.uniform(0.1, 3)))
        elif kind == 1:
            low = rng.uniform(0.3, 2.5)
            level.append(box(x, x + a, y, y + b, low, low + 0.2))
        elif kind == 2:
            rise = rng.uniform(0.1, 1.5) * a
            level.append(quad((x, y, 0), (x + a, y, rise), (x + a, y + b, rise), (x, y + b, 0)))
        elif kind == 3:
            level.append(quad((x, y, 0), (x + a, y + b, 0), (x + a, y + b, 1.5), (x, y, 1.5)))
        else:
            level.append(plane(x, x + a, y, y + b, rng.uniform(2.2, 4)))
    angle = rng.uniform(0, 2 * math.pi)
    turn = np.array(
        [[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]]
    )
    return [(v @ turn.T, f) for v, f in level]
