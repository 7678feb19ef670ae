"""Routes: found, short, clear of walls, and fast? Prints a table and writes JSON.

    python -m benchmarks.navmesh_routes [--levels LEVEL ...] [--json FILE] [--resolution 0.25]
                                        [--samples 4000] [--repeats 7]

On the three shared levels and their 2,000 pairs each, for the body of the shared queries (radius 0.6 m,
height 2.0 m, step 0.9 m, slope 45°): pairs answered "complete", length of the pulled path against the peer's,
clearance along the pulled and the smoothed path, checked on the mesh itself (`mesh_truth`), and the time of a
query in a batch and from Python against Detour's in the same run. Times are the least of all rounds, for each
query (single calls; Detour: median of its passes) or batch of 100, to reduce the effect of other load.
"""

import json
import sys
import time
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from benchmarks.mesh_truth import MeshTruth
from benchmarks.navmesh_levels import Target, ask_peer, run
from benchmarks.shared_data import level_path, queries_path
from navmesh import NodeGraph, Terrain, WalkRules
from navmesh.routes.route import Route
from navmesh.routes.surface_projection import project_to_surface
from pathsmooth import PathSmoothError, Problem, solve

RADIUS = 0.6
BATCH = 100
SHORT = 0.05
"""[m]: samples with less clearance than the radius by more than this count."""


def read_queries(path: Path, length: str = "len3d") -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Starts (q, 3), goals (q, 3), Z up, and the peer's lengths (q,) [m], the column ``length``."""
    rows = np.genfromtxt(path, delimiter=",", names=True)
    starts = np.stack([rows["sx"], -rows["sz"], rows["sy"]], axis=1)
    goals = np.stack([rows["gx"], -rows["gz"], rows["gy"]], axis=1)
    return starts, goals, rows[length]


def batch_seconds(graph: NodeGraph, starts: np.ndarray, goals: np.ndarray) -> np.ndarray:
    """Times of batches of `BATCH` queries each: short enough that other programs seldom get in between."""
    times = []
    for at in range(0, len(starts), BATCH):
        first, last = starts[at : at + BATCH], goals[at : at + BATCH]
        begin = time.perf_counter()
        graph.find_paths(first, last, radius=RADIUS)
        times.append(time.perf_counter() - begin)
    return np.array(times)


def smoothed(route: Route) -> np.ndarray | None:
    """Points (n, 3) on the surface along the route's legs, smoothed with the default stopping rule; None
    where smoothing refuses a leg.

    Smoothing knows no heights: a point of the curve stands for the floor nearest in height to the pulled path
    beside it (nan where there is none).
    """
    parts = []
    for leg in route.legs():
        try:
            corners = solve(Problem.from_corridor(leg.waypoints, leg.centers, leg.radii)).points
        except PathSmoothError:
            return None
        curve = np.concatenate([corners, 0.5 * (corners[1:] + corners[:-1])])
        pulled = project_to_surface(route.graph, leg.waypoints, 0.1)
        curve[:, 2] = pulled[KDTree(pulled[:, :2]).query(curve[:, :2])[1], 2]
        curve[:, 2] = route.graph.project(curve)[1]
        parts.append(curve)
    return np.concatenate(parts)


def clearance_figures(
    mesh: MeshTruth, points: np.ndarray, samples: int, rng: np.random.Generator
) -> tuple[int, float]:
    """Of ``samples`` of the points: how many are off the surface, and the share that is too close to its
    end."""
    points = points[rng.choice(len(points), min(samples, len(points)), replace=False)]
    free = mesh.distance(points, np.full(len(points), RADIUS), directions=48, stride=0.04)
    return int((free <= 0.0).sum()), float((free < RADIUS - SHORT).mean())


def detour_microseconds(name: str) -> tuple[float, float]:
    """Mean and median over the pairs of Detour's time for a query."""
    first = json.loads(ask_peer("query", name, queries_path(name)).splitlines()[0])
    return first["us_mean"], first["us_median"]


def measure(name: str, rules: WalkRules, samples: int, repeats: int, rng: np.random.Generator) -> dict:
    """All figures of one level."""
    terrain = Terrain.load(level_path(name), up="y")
    graph = NodeGraph.build(terrain, rules, obstacle_rules=None)
    starts, goals, peer_length = read_queries(queries_path(name))
    routes = graph.find_paths(starts, goals, radius=RADIUS)
    complete = routes.status == "complete"
    ratio = routes.length[complete] / peer_length[complete]
    figures: dict = {
        "complete_share": float(complete.mean()),
        "length_ratio_mean": float(ratio.mean()),
        "length_ratio_p95": float(np.quantile(ratio, 0.95)),
        "length_ratio_above_1.10": float((ratio > 1.10).mean()),
        "nodes_expanded_mean": float(routes.expanded.mean()),
        "waypoints_mean": float(np.diff(routes.waypoint_start).mean()),
    }

    first = np.array([routes.waypoints[i] for i in routes.waypoint_start[:-1][complete]])
    last = np.array([routes.waypoints[i - 1] for i in routes.waypoint_start[1:][complete]])
    moved = np.concatenate([(first - starts[complete])[:, :2], (last - goals[complete])[:, :2]])
    figures["ends_moved_share"] = float((np.hypot(*moved.T) > 1e-9).mean())
    figures["ends_moved_most_m"] = float(np.hypot(*moved.T).max())

    mesh = MeshTruth(terrain, rules)
    found = [routes[i] for i in np.flatnonzero(complete).tolist()]
    points = np.concatenate([route.on_surface(0.1) for route in found])
    off, short = clearance_figures(mesh, points, samples, rng)
    figures |= {"samples_off_surface": off, "samples_short_share": short}
    curves = [curve for curve in map(smoothed, found) if curve is not None]
    off, short = clearance_figures(mesh, np.concatenate(curves), samples, rng)
    figures |= {"smoothed_off_surface": off, "smoothed_short_share": short}
    figures["smoothing_refused"] = len(found) - len(curves)

    batch = []
    single = np.full((repeats, len(starts)), np.inf)
    peer = np.empty((repeats, 2))
    for k in range(repeats):  # in turn, so that other load on the machine hits both
        peer[k] = detour_microseconds(name)
        batch += [batch_seconds(graph, starts, goals) for _ in range(3)]
        for i in range(len(starts)):
            begin = time.perf_counter()
            graph.find_path(starts[i], goals[i], RADIUS)
            single[k, i] = time.perf_counter() - begin
    figures["batch_us"] = float(np.min(batch, axis=0).sum() / len(starts) * 1e6)
    figures["detour_us"] = float(peer[:, 0].min())
    figures["batch_ratio"] = figures["batch_us"] / figures["detour_us"]
    figures["single_us_median"] = float(np.median(single.min(axis=0)) * 1e6)
    figures["single_us_p95"] = float(np.quantile(single.min(axis=0), 0.95) * 1e6)
    return figures


TARGETS: list[Target] = [
    ("pairs complete below 99.5 %", "complete_share", lambda share: share >= 0.995),
    ("mean length above 1.01", "length_ratio_mean", lambda ratio: ratio <= 1.01),
    ("95th percentile above 1.04", "length_ratio_p95", lambda ratio: ratio <= 1.04),
    ("over 2 % above 1.10", "length_ratio_above_1.10", lambda share: share <= 0.02),
    ("over 0.5 % too close", "samples_short_share", lambda share: share <= 0.005),
    ("off the surface", "samples_off_surface", lambda samples: samples == 0),
    ("smoothed: over 0.5 % too close", "smoothed_short_share", lambda share: share <= 0.005),
    ("smoothed: off the surface", "smoothed_off_surface", lambda samples: samples == 0),
    ("batch above 3 times Detour", "batch_ratio", lambda ratio: ratio <= 3.0),
    ("single call above 15 µs", "single_us_median", lambda time: time <= 15.0),
]


if __name__ == "__main__":
    title = f"Routes for a body of {RADIUS} m"
    sys.exit(run(__doc__, title, measure, TARGETS, samples=4_000, samples_of="points of paths measured"))
