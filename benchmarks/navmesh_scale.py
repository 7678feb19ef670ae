"""How time and memory of graph, routes and updates grow with the level, beside Recast and Detour.

    python -m benchmarks.navmesh_scale [--levels "city 4" "hills 300" ...] [--pairs 2000] [--json FILE]
    python -m benchmarks.navmesh_scale --levels "city 4" "city 8" "city 16" "city 33" --pairs 0 --changes 0 \
        --plot docs/pictures/navmesh-scale.png

Levels are those of `benchmarks.large_levels`; each is measured in a process of its own. The body is that of
the peers' benchmark (height 2.0 m, step 0.9 m, slope 45°, radius 0.6 m). Columns: time to build without and
with obstacles, over Recast's where it is there, and without by two threads, over one; the most memory that
the build takes and what the finished graph holds; size of the file; a query in a batch (over Detour's) and
from Python; a goal that cannot be reached over one that can; an update of a chunk of 10 m (over Recast's
rebuild of a tile of 9.6 m), and that update with the first query on the new graph, of the same radius as
those before, both by processor time; length of the routes over Detour's any-angle search. With ``--pairs 0``
and ``--changes 0`` only the build is measured. ``--plot`` draws its time and memory against the area.
"""

import argparse
import json
import math
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import trimesh

from benchmarks.large_levels import LARGE_LEVELS, large_level
from benchmarks.navmesh_levels import ask_peer
from benchmarks.navmesh_routes import RADIUS, batch_seconds, read_queries
from benchmarks.scale_plot import draw_growth
from benchmarks.shared_data import shared_folder, why_absent
from navmesh import NodeGraph, Terrain, WalkRules, join_chunks, split_terrain

LEVELS = ("city 4", "city 8", "city 16", "hills 300", "clutter 60")
RULES = WalkRules(max_slope=math.radians(45), max_step=0.9, headroom=2.0)
COLUMNS = (
    "triangles", "km2", "build [ms]", "with obstacles [ms]", "two threads", "most; held [MB]", "file [MB]",
    "batch [us]", "single [us]", "unreachable [us]", "update [ms]", "update and first query [ms]",
    "length: mean, > 1 % longer, > 10 %",
)  # fmt: skip
CHUNK = 10.0  # [m]
MEGABYTE = 1e6


def milliseconds(act: Callable[[], Any], repeats: int) -> float:
    """The least time of ``repeats`` calls."""
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        act()
        times.append(time.perf_counter() - begin)
    return 1e3 * min(times)


def resident() -> float:
    """Memory of this process [MB]."""
    return psutil.Process().memory_info().rss / MEGABYTE


def forget_most() -> None:
    """Let `most_resident` count from now on, where the system can."""
    with suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


def most_resident() -> float:
    """The most memory that this process has had since `forget_most` [MB]."""
    with suppress(OSError):
        for line in Path("/proc/self/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return float(line.split()[1]) * 1024 / MEGABYTE
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / MEGABYTE


def peer_lines(mode: str, level: Path, *arguments: object) -> list[dict[str, Any]]:
    """What the peer prints; nothing where it gives up."""
    try:
        return [json.loads(line) for line in ask_peer(mode, level, *arguments).splitlines()]
    except subprocess.CalledProcessError:
        return []


def build_figures(terrain: Terrain) -> tuple[NodeGraph, dict[str, float]]:
    """The graph with obstacles, and what building it took. Compiled code has been loaded before."""
    before = resident()
    forget_most()
    graph = NodeGraph.build(terrain, RULES)
    figures = {"peak_mb": most_resident() - before, "held_mb": resident() - before}
    repeats = 5 if len(graph.surface) < 2_000_000 else 2

    def build(threads: int) -> NodeGraph:
        return NodeGraph.build(terrain, RULES, obstacle_rules=None, threads=threads)

    figures["build_ms"] = milliseconds(lambda: build(1), repeats)
    figures["two_threads_ms"] = milliseconds(lambda: build(2), repeats)
    figures["obstacles_ms"] = milliseconds(lambda: NodeGraph.build(terrain, RULES), repeats)
    return graph, figures


def unreachable_figures(graph: NodeGraph, count: int, rng: np.random.Generator) -> dict[str, float]:
    """Time of a query [µs] to goals that can be reached and to goals that cannot."""
    wide = np.flatnonzero(graph.radii >= RADIUS)
    starts = graph.positions[rng.choice(wide, count)]
    goals = graph.positions[rng.choice(wide, count)]
    status = graph.find_paths(starts, goals, radius=RADIUS).status
    apart, joined = np.isin(status, ("partial", "no_path")), status == "complete"
    figures = {}
    for name, chosen in (("reachable_us", joined), ("unreachable_us", apart)):
        figures[name] = math.nan
        if chosen.any():
            seconds = milliseconds(lambda c=chosen: graph.find_paths(starts[c], goals[c], radius=RADIUS), 3)
            figures[name] = 1e3 * seconds / int(chosen.sum())
    return figures


def update_figures(terrain: Terrain, changes: int, rng: np.random.Generator) -> dict[str, float]:
    """Median processor time [ms] of removing a chunk and putting it back, of both that and the first query on
    the new graph, and of the same query asked again. Chunks of which nothing is seen on the floor do not
    count."""
    chunks = split_terrain(terrain, CHUNK)
    graph = NodeGraph.build(join_chunks(chunks, terrain.name), RULES, obstacle_rules=None)
    names = sorted(chunks)
    start, goal = graph.positions[rng.choice(np.flatnonzero(graph.radii >= RADIUS), 2)]
    graph.find_path(start, goal, radius=RADIUS)
    times: list[tuple[float, float, float]] = []
    for name in rng.permutation(names):
        if len(times) == 2 * changes:
            break
        for change in (None, chunks[name]):
            begin, surface = time.process_time(), graph.surface
            graph = graph.update({name: change})
            updated = time.process_time()
            graph.find_path(start, goal, radius=RADIUS)
            asked = time.process_time()
            graph.find_path(start, goal, radius=RADIUS)
            if graph.surface is not surface:
                times.append((updated - begin, asked - begin, time.process_time() - asked))
    median = 1e3 * np.median(times[2:], axis=0)
    return dict(zip(("update_ms", "update_and_query_ms", "next_query_ms"), median.tolist(), strict=True))


def measure(kind: str, size: int, seed: int, pairs: int, changes: int) -> dict[str, Any]:
    """All figures of a level, in this process."""
    rng = np.random.default_rng(seed)
    small = large_level("city", 2)
    unreachable_figures(NodeGraph.build(small, RULES), 50, rng)  # loads the compiled code
    terrain = large_level(kind, size, seed)
    width = np.ptp(terrain.vertices[:, :2], axis=0) / 1e3
    figures: dict[str, Any] = {"triangles": len(terrain.faces), "km2": float(width.prod())}
    graph, built = build_figures(terrain)
    figures |= {"cells": len(graph.surface), "nodes": len(graph), **built}
    with tempfile.TemporaryDirectory() as folder:
        graph.save(Path(folder) / "graph.npz")
        figures["file_mb"] = (Path(folder) / "graph.npz").stat().st_size / MEGABYTE
        if pairs:
            figures |= unreachable_figures(graph, pairs, rng)
        if shared_folder() is not None:
            y_up = terrain.vertices[:, [0, 2, 1]] * (1.0, 1.0, -1.0)
            level, queries = Path(folder) / "level.obj", Path(folder) / "pairs.csv"
            trimesh.Trimesh(y_up, terrain.faces, process=False).export(level)
            figures |= peer_figures(graph, level, queries, pairs)
    del graph
    if changes:
        figures |= update_figures(terrain, changes, rng)
    return figures


def peer_figures(graph: NodeGraph, level: Path, queries: Path, pairs: int) -> dict[str, Any]:
    """The peer's times, and ours for the same pairs; fewer figures where it gives up."""
    figures: dict[str, Any] = {}
    for solo in peer_lines("solo", level, 5):
        figures["recast_ms"] = solo["build_ms_min"]
    if not pairs:
        return figures
    for tiled in peer_lines("tiled", level):
        figures["recast_tile_ms"] = tiled["rebuild_ms_median"]
    if not peer_lines("gen", level, queries, pairs, 7):
        return figures
    starts, goals, lengths = read_queries(queries, "len3d_anyangle")
    routes = graph.find_paths(starts, goals, radius=RADIUS)
    times = []
    for start, goal in zip(starts, goals, strict=True):
        begin = time.perf_counter()
        graph.find_path(start, goal, radius=RADIUS)
        times.append(time.perf_counter() - begin)
    detour = peer_lines("query", level, queries)[0]
    batch = np.min([batch_seconds(graph, starts, goals) for _ in range(3)], axis=0).sum() / len(starts)
    complete = routes.status == "complete"
    ratio = routes.length[complete] / lengths[complete]
    return figures | {
        "batch_us": 1e6 * float(batch),
        "single_us": 1e6 * float(np.median(times)),
        "single_p95_us": 1e6 * float(np.quantile(times, 0.95)),
        "detour_us": detour["us_mean"],
        "detour_p95_us": detour["us_p95"],
        "complete": float(complete.mean()),
        "length": float(ratio.mean()),
        "longer_1": float((ratio > 1.01).mean()),
        "longer_10": float((ratio > 1.10).mean()),
    }


def row(name: str, figures: dict[str, Any]) -> str:
    """One line of the table."""

    def over(key: str, peer: str) -> str:
        value, by = figures.get(key), figures.get(peer)
        if value is None:
            return "-"
        return f"{value:.4g} ({value / by:.2f})" if by else f"{value:.4g}"

    cells = [
        f"{figures['triangles']:,}",
        f"{figures['km2']:.3f}",
        over("build_ms", "recast_ms"),
        over("obstacles_ms", "recast_ms"),
        over("two_threads_ms", "build_ms"),
        f"{figures['peak_mb']:.0f}; {figures['held_mb']:.0f}",
        f"{figures['file_mb']:.1f}",
        over("batch_us", "detour_us"),
        over("single_us", ""),
        over("unreachable_us", "reachable_us"),
        over("update_ms", "recast_tile_ms"),
        over("update_and_query_ms", ""),
    ]
    if "length" in figures:
        longer = f"{100 * figures['longer_1']:.1f} %, {100 * figures['longer_10']:.1f} %"
        cells.append(f"{figures['length']:.4f}, {longer}")
    return f"{name:12} " + " | ".join(cells)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--levels", nargs="+", default=LEVELS, metavar='"KIND SIZE"')
    parser.add_argument("--pairs", type=int, default=2000)
    parser.add_argument("--changes", type=int, default=6, help="chunks removed and put back")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path, help="write every figure here")
    parser.add_argument("--plot", type=Path, help="draw time and memory of the builds here (PNG)")
    parser.add_argument("--one", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        kind, size = options.one.split()
        print(json.dumps(measure(kind, int(size), options.seed, options.pairs, options.changes)))
        return
    for name in options.levels:
        if name.split()[0] not in LARGE_LEVELS:
            parser.error(f"--levels {name!r}: expected a kind ({', '.join(LARGE_LEVELS)}) and a size")
    if shared_folder() is None:
        print(f"without Recast and Detour: {why_absent()}")
    print(f"{'level':12} {' | '.join(COLUMNS)}")
    report = {}
    for name in options.levels:
        settings = ["--seed", options.seed, "--pairs", options.pairs, "--changes", options.changes]
        command = [sys.executable, "-m", "benchmarks.navmesh_scale", *map(str, settings), "--one", name]
        printed = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
        report[name] = json.loads(printed.splitlines()[-1])
        print(row(name, report[name]), flush=True)
    if options.json:
        options.json.write_text(json.dumps(report, indent=1))
    if options.plot:
        draw_growth(report, options.plot)


if __name__ == "__main__":
    main()
