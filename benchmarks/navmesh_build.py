"""Correctness and build time of the graph. Prints a table and writes JSON.

    python -m benchmarks.navmesh_build [--levels LEVEL ...] [--json FILE] [--resolution 0.25]
                                       [--samples 20000] [--repeats 7]

On the three shared levels, with the body of the shared queries (height 2.0 m, step 0.9 m, slope 45°): what
the discs include and leave out, checked on the mesh itself (`mesh_truth`), connections against a flood fill
of the clearance field, the error of small radii, and the build time against Recast in the same run.
"""

import json
import math
import sys
import time

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from benchmarks.mesh_truth import MeshTruth
from benchmarks.navmesh_levels import Target, ask_peer, run
from benchmarks.shared_data import level_path
from navmesh import NodeGraph, Terrain, WalkRules

RADII = (0.15, 0.3, 0.6, 0.9, 1.2)


def components(count: int, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Number (count,) of the connected component of each of ``count`` things joined by pairs a-b."""
    matrix = coo_array((np.ones(len(a), dtype=bool), (a, b)), shape=(count, count))
    return connected_components(matrix, directed=False)[1]


def lost_connections(graph: NodeGraph, radius: float) -> int:
    """Connections that the graph lacks for a body of ``radius``, against a flood fill of the clearance field.

    Parts of the graph, beyond the first, among the nodes that own the cells of one flooded part, and cells
    whose own node is too small. Whether it has some that the mesh lacks is asked by
    `benchmarks.narrow_doors`: a door may be passed between the centres of cells, which no flood fill sees.
    """
    surface = graph.surface
    wide = surface.clearance >= radius
    link = surface.link
    a, d = np.nonzero(link >= 0)
    b = link[a, d]
    keep = wide[a] & wide[b]
    flood = components(len(surface), a[keep], b[keep])
    source = np.repeat(np.arange(len(graph)), np.diff(graph.edge_start))
    passes = (graph.edge_width >= radius) & (graph.radii[source] >= radius)
    passes &= graph.radii[graph.edge_target] >= radius
    search = components(len(graph), source[passes], graph.edge_target[passes])
    cells = np.flatnonzero(wide)
    owner = graph.label[cells]
    orphans = (owner < 0) | (graph.radii[owner] < radius)
    owned = np.unique(np.stack([flood[cells], search[owner]])[:, ~orphans], axis=1)
    return owned.shape[1] - len(np.unique(owned[0])) + int(orphans.sum())


def uncovered_cells(graph: NodeGraph) -> int:
    """Cells with enough clearance for a node that lie in no disc that reaches them over links."""
    surface, owner = graph.surface, graph.label
    offset = (surface.centers() - graph.positions[owner])[:, :2]
    covered = (owner >= 0) & (np.hypot(*offset.T) <= graph.radii[owner] + 1e-9)
    return int((~covered & (surface.clearance >= graph.rules.min_radius)).sum())


def recast_milliseconds(name: str, repeats: int) -> float:
    """Least time of Recast's whole build of a level."""
    return float(json.loads(ask_peer("solo", name, repeats))["build_ms_min"])


def build_milliseconds(terrain: Terrain, rules: WalkRules, repeats: int, obstacles: bool) -> float:
    """Least time of the whole build from arrays in memory, with or without the search for obstacles."""
    best = math.inf
    for _ in range(repeats):
        begin = time.perf_counter()
        if obstacles:
            NodeGraph.build(terrain, rules)
        else:
            NodeGraph.build(terrain, rules, obstacle_rules=None)
        best = min(best, time.perf_counter() - begin)
    return best * 1e3


def measure(name: str, rules: WalkRules, samples: int, repeats: int, rng: np.random.Generator) -> dict:
    """All figures of one level."""
    terrain = Terrain.load(level_path(name), up="y")
    graph = NodeGraph.build(terrain, rules, obstacle_rules=None)
    NodeGraph.build(terrain, rules)
    mesh = MeshTruth(terrain, rules)
    figures: dict = {"cells": len(graph.surface), "nodes": len(graph), "edges": len(graph.edge_target) // 2}

    node = rng.choice(np.flatnonzero(graph.radii > rules.resolution), samples)
    angle = rng.random(samples) * 2 * np.pi
    length = (graph.radii[node] - rules.resolution) * np.sqrt(rng.random(samples))
    way = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    reached = mesh.reached(graph.positions[node], way, length)
    figures["unwalkable_share"] = float((reached < length - 1e-9).mean())

    small = np.flatnonzero(graph.radii < 0.5)
    small = rng.permutation(small)[: max(50, samples // 40)]
    error = graph.radii[small] - mesh.distance(graph.positions[small], graph.radii[small] + 0.5)
    figures["radius_error_mean_m"] = float(np.abs(error).mean())
    figures["radius_error_bias_m"] = float(error.mean())
    figures["radius_error_p99_m"] = float(np.quantile(np.abs(error), 0.99))

    figures["uncovered_cells"] = uncovered_cells(graph)
    figures["connections_lost"] = {f"{radius:g}": lost_connections(graph, radius) for radius in RADII}

    ours, peer, full = math.inf, math.inf, math.inf
    for _ in range(repeats):  # in turn, so that other load on the machine hits both
        peer = min(peer, recast_milliseconds(name, 3))
        ours = min(ours, build_milliseconds(terrain, rules, 3, obstacles=False))
        full = min(full, build_milliseconds(terrain, rules, 1, obstacles=True))
    figures |= {"build_ms": ours, "recast_ms": peer, "build_ratio": ours / peer}
    figures |= {"build_with_obstacles_ms": full, "build_with_obstacles_ratio": full / peer}
    return figures


TARGETS: list[Target] = [
    ("unwalkable samples above 0.1 %", "unwalkable_share", lambda share: share <= 0.001),
    ("radius error above 0.05 m", "radius_error_mean_m", lambda error: error <= 0.05),
    ("uncovered cells", "uncovered_cells", lambda cells: cells == 0),
    ("connections lost", "connections_lost", lambda lost: not any(lost.values())),
    ("slower than Recast", "build_ratio", lambda ratio: ratio <= 1.0),
]


if __name__ == "__main__":
    sys.exit(
        run(__doc__, "Building the graph", measure, TARGETS, samples=20_000, samples_of="points in discs")
    )
