"""An open world: what it holds in memory, what a chunk and a query cost, and how long its routes are.

    python -m benchmarks.open_world [--levels "city 33"] [--walks 6] [--queries 1000] [--json FILE]

Levels are those of `benchmarks.large_levels`, cut into chunks of ``--side`` m, for a body with a radius of
``--body`` m and without obstacles. Each is baked in a process of its own, which also draws pairs of places
that are joined and finds their fine routes on the whole graph; then another process loads what is around a
player (``--window`` m). Printed are: memory that is held by the whole graph, by the coarse graph alone, and
with the window loaded; processor time of loading and of dropping a chunk and of the first query on the new
graph; time of a coarse query, and of one with its start loaded; coarse lengths over fine ones; and the
lengths of walks over fine ones. A walk goes 40 m at a time along its route and asks for another, with the
window kept around it.
"""

import argparse
import gc
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.large_levels import LARGE_LEVELS, large_level
from benchmarks.navmesh_scale import resident
from navmesh import NodeGraph, OpenWorld, bake_open_world, join_chunks, split_terrain
from navmesh.streaming.cutting import cut_level
from surefoot.freed_memory import give_back

__all__ = ["along", "baked_figures", "held_figures"]

STEP = 40.0  # [m] that a walk goes before it asks again
LEAST = 60.0  # [m] between the ends of the pairs whose lengths are compared


def held_now() -> float:
    """Memory of this process [MB], without what it has freed."""
    gc.collect()
    give_back()
    return resident()


def along(line: np.ndarray, far: float) -> np.ndarray:
    """The place (3,) ``far`` [m] along a ``line`` (k, 3) [m], or its end."""
    at = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    return np.array([np.interp(far, at, line[:, axis]) for axis in range(3)])


def baked_figures(options: argparse.Namespace, folder: Path) -> dict[str, Any]:
    """Bake the level into ``folder``, and find the routes on the whole graph; in a process of its own."""
    kind, size = options.one.split()
    NodeGraph.build(large_level("city", 2), obstacle_rules=None)  # loads the compiled code
    terrain = large_level(kind, int(size), options.seed)
    width = np.ptp(terrain.vertices[:, :2], axis=0) / 1e3
    before = held_now()
    graph = NodeGraph.build(join_chunks(cut_level(terrain, options.side)), obstacle_rules=None)
    graph.find_path(graph.positions[0], graph.positions[1], options.body)
    held = held_now() - before
    rng = np.random.default_rng(options.seed)
    count = max(options.queries, options.walks)
    starts, goals = graph.random_points(rng, 4 * count, options.body).reshape(2, -1, 3)
    routes = graph.find_paths(starts, goals, options.body)
    apart = np.linalg.norm(starts - goals, axis=1) >= LEAST
    kept = np.flatnonzero((routes.status == "complete") & apart)[:count]
    lengths = routes.length[kept].tolist()
    del graph, routes
    begin = time.process_time()
    bake_open_world(terrain, folder, (options.body,), options.side, obstacle_rules=None)
    baked = time.process_time() - begin
    return {
        "km2": float(width.prod()),
        "bake_s": baked,
        "whole_mb": held,
        "folder_mb": sum(each.stat().st_size for each in folder.iterdir()) / 1e6,
        "starts": starts[kept].tolist(),
        "goals": goals[kept].tolist(),
        "lengths": lengths,
    }


def walk(world: OpenWorld, start: np.ndarray, goal: np.ndarray, radius: float) -> tuple[float, list[float]]:
    """Length [m] of a walk from ``start`` to ``goal``, and processor times [ms] of the routes on the way,
    each asked a second time."""
    at, walked, times = start, 0.0, []
    while True:
        while world.keep_around(at, 8):
            pass
        world.route(at, goal, radius)  # the first on this graph
        begin = time.process_time()
        route = world.route(at, goal, radius)
        times.append(1e3 * (time.process_time() - begin))
        if route.fine is None:
            raise RuntimeError(f"no way on from {at} to {goal}: {route}")
        if not len(route.beyond) and route.fine.length <= STEP:
            return walked + route.fine.length, times
        far = min(STEP, route.fine.length)
        at, walked = along(route.fine.waypoints, far), walked + far


def held_figures(options: argparse.Namespace, folder: Path, baked: dict[str, Any]) -> dict[str, Any]:
    """What an `OpenWorld` of the ``folder`` costs; in a process of its own."""
    small = NodeGraph.build(join_chunks(split_terrain(large_level("city", 2), 10.0)), obstacle_rules=None)
    small.update({"0,0": None}).find_path(small.positions[0], small.positions[1], options.body)
    starts, goals = np.array(baked["starts"]), np.array(baked["goals"])
    before = held_now()
    world = OpenWorld(folder, options.window)
    figures: dict[str, Any] = {"coarse_mb": held_now() - before, "chunks": len(world.chunks)}
    world.route(starts[0], goals[0], options.body)  # loads the compiled code
    begin = time.process_time()
    coarse = [world.route(a, b, options.body) for a, b in zip(starts, goals, strict=True)]
    figures["coarse_us"] = 1e6 * (time.process_time() - begin) / len(starts)
    ratio = np.array([route.length for route in coarse]) / baked["lengths"]
    figures["coarse_ratio"] = [float(np.mean(ratio)), *np.quantile(ratio, (0.05, 0.95)).tolist()]
    figures["coarse_complete"] = float(np.mean([route.status == "complete" for route in coarse]))
    centre = 0.5 * (starts.min(axis=0) + starts.max(axis=0))
    middle = starts[np.argmin(np.linalg.norm(starts - centre, axis=1))]
    while world.keep_around(middle, 8):
        pass
    figures["held_mb"] = held_now() - before
    figures["loaded"] = len(world.loaded)
    times: dict[str, list[float]] = {"load_ms": [], "drop_ms": [], "first_query_ms": []}
    for step in range(1, 6):
        at = middle + np.array([20.0 * step, 0.0, 0.0])
        while True:
            begin = time.process_time()
            changes = world.keep_around(at)
            changed = time.process_time()
            if not changes:
                break
            world.route(middle, goals[0], options.body)
            times["load_ms" if None not in changes.values() else "drop_ms"].append(1e3 * (changed - begin))
            times["first_query_ms"].append(1e3 * (time.process_time() - changed))
    figures |= {name: float(np.median(each)) for name, each in times.items() if each}
    figures["load_worst_ms"] = max(times["load_ms"])
    found = [walk(world, a, b, options.body) for a, b in zip(starts, goals[: options.walks], strict=False)]
    ratio = np.array([walked for walked, _ in found]) / baked["lengths"][: len(found)]
    figures["walk_ratio"] = [float(ratio.mean()), float(ratio.max())]
    figures["walked_m"] = float(sum(walked for walked, _ in found))
    figures["route_ms"] = float(np.median([each for _, times in found for each in times]))
    figures["after_walks_mb"] = held_now() - before
    return figures


def row(name: str, figures: dict[str, Any]) -> str:
    """The figures of a level, in lines."""
    f = figures
    mean, low, high = f["coarse_ratio"]
    walked, worst = f["walk_ratio"]
    return (
        f"{name}: {f['km2']:.2f} km2, {f['chunks']} chunks; baked in {f['bake_s']:.0f} s, "
        f"folder {f['folder_mb']:.1f} MB\n"
        f"  held: whole graph {f['whole_mb']:.0f} MB; coarse graph {f['coarse_mb']:.0f} MB; with "
        f"{f['loaded']} chunks loaded {f['held_mb']:.0f} MB, after the walks {f['after_walks_mb']:.0f} MB\n"
        f"  a chunk: load {f['load_ms']:.0f} ms (worst {f['load_worst_ms']:.0f}), drop "
        f"{f['drop_ms']:.0f} ms, first route after {f['first_query_ms']:.0f} ms\n"
        f"  a route: coarse {f['coarse_us']:.0f} us; partly loaded {f['route_ms']:.1f} ms\n"
        f"  coarse over fine length: mean {mean:.3f}, 5 to 95 %: {low:.2f} to {high:.2f}; complete "
        f"{100 * f['coarse_complete']:.1f} %\n"
        f"  walked over fine length: mean {walked:.3f}, worst {worst:.3f} ({f['walked_m']:.0f} m)"
    )


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--levels", nargs="+", default=["city 33"], metavar='"KIND SIZE"')
    parser.add_argument("--side", type=float, default=60.0, help="of the chunks [m]")
    parser.add_argument("--window", type=float, default=250.0, help="around the player [m]")
    parser.add_argument("--body", type=float, default=0.3, help="radius [m]")
    parser.add_argument("--walks", type=int, default=6)
    parser.add_argument("--queries", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path, help="write every figure here")
    parser.add_argument("--one", help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--baked", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        if options.baked:
            print(json.dumps(held_figures(options, options.folder, json.loads(options.baked.read_text()))))
        else:
            print(json.dumps(baked_figures(options, options.folder)))
        return
    for name in options.levels:
        if name.split()[0] not in LARGE_LEVELS:
            parser.error(f"--levels {name!r}: expected a kind ({', '.join(LARGE_LEVELS)}) and a size")
    report = {}
    names = ("side", "window", "body", "walks", "queries", "seed")
    settings = [f"--{name}={getattr(options, name)}" for name in names]
    for name in options.levels:
        with tempfile.TemporaryDirectory() as place:
            folder, baked = Path(place) / "world", Path(place) / "baked.json"
            command = [sys.executable, "-m", "benchmarks.open_world", *settings, "--one", name]
            command += ["--folder", str(folder)]
            baked.write_text(_last_line(command))
            held = json.loads(_last_line([*command, "--baked", str(baked)]))
            figures = json.loads(baked.read_text())
            report[name] = {
                key: each for key, each in figures.items() if key not in ("starts", "goals", "lengths")
            }
            report[name] |= held
        print(row(name, report[name]), flush=True)
    if options.json:
        options.json.write_text(json.dumps(report, indent=1))


def _last_line(command: list[str]) -> str:
    """What a ``command`` printed last."""
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()[-1]


if __name__ == "__main__":
    main()
