"""What a graph update costs relative to a full build. Prints a table and writes JSON.

    python -m benchmarks.navmesh_update [--levels LEVEL ...] [--changes 12] [--json FILE]
    python -m benchmarks.navmesh_update --random 10000 [--every 100] [--seed 0]

Each level is split into chunks of 2 m and of 10 m; random ones are removed and put back. After each change
the same level is also built in full, alternating with the update, and both must be bit-identical. Ratios are
of median processor times.

With ``--random``, so many random changes (chunks that go, come back or move, one to three at a time) are made
to small generated levels, with obstacles; every so often the hash of the graph is compared with that of one
built anew.
"""

import argparse
import hashlib
import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.large_levels import large_level
from benchmarks.shared_data import LEVELS, level_path
from navmesh import NodeGraph, Terrain, join_chunks, split_terrain

SIDES = (2.0, 10.0)
GENERATED = (("city", 2, 5.0), ("hills", 60, 6.0), ("clutter", 30, 4.0))
GRAPH = ("positions", "radii", "label", "edge_start", "edge_target", "edge_width", "edge_gate")
SURFACE = ("nearest", "link", "clearance", "height")


def timed(make: Callable[[], NodeGraph]) -> tuple[NodeGraph, float]:
    """What ``make`` gives, and the processor time [ms] that it took."""
    begin = time.process_time()
    graph = make()
    return graph, 1e3 * (time.process_time() - begin)


def agree(one: NodeGraph, other: NodeGraph) -> bool:
    """Whether two graphs have the same nodes, radii, links and obstacles, bit for bit."""
    pairs = [(getattr(one, name), getattr(other, name)) for name in GRAPH]
    pairs += [(getattr(one.surface, name), getattr(other.surface, name)) for name in SURFACE]
    for part in ("obstacles", "links"):
        expected = getattr(other, part).arrays()
        pairs += [(array, expected[name]) for name, array in getattr(one, part).arrays().items()]
    return all(np.array_equal(a, b) for a, b in pairs)


def digest(graph: NodeGraph) -> str:
    """SHA-256 of all that `agree` compares."""
    checksum = hashlib.sha256()
    parts = [getattr(graph, name) for name in GRAPH]
    parts += [getattr(graph.surface, name) for name in SURFACE]
    parts += [*graph.obstacles.arrays().values(), *graph.links.arrays().values()]
    for array in parts:
        checksum.update(np.ascontiguousarray(array).tobytes())
    return checksum.hexdigest()


def random_changes(kind: str, size: int, side: float, changes: int, every: int, seed: int) -> tuple[int, int]:
    """How many of the comparisons after random changes found the same graph, and how many there were."""
    rng = np.random.default_rng((size, seed))
    chunks = split_terrain(large_level(kind, size, seed), side)
    names = sorted(chunks)
    low, high = join_chunks(chunks).bounds
    graph = NodeGraph.build(join_chunks(chunks), extent=[low - 1.0, high + 1.0])
    there, same, compared = dict(chunks), 0, 0
    for turn in range(1, changes + 1):
        change: dict[str, Terrain | None] = {}
        for name in map(str, rng.choice(names, rng.integers(1, 4), replace=False)):
            if name in there and rng.random() < 0.4 and len(there) > len(names) // 2:
                change[name] = None
                del there[name]
                continue
            shift = rng.uniform(-0.5, 0.5, 3) if rng.random() < 0.5 else np.zeros(3)
            change[name] = Terrain.from_arrays(chunks[name].vertices + shift, chunks[name].faces)
            there[name] = chunks[name]
        graph = graph.update(change)
        if turn % every == 0:
            compared += 1
            same += digest(graph) == digest(NodeGraph.build(graph.terrain, extent=graph.extent))
    return same, compared


def measure(level: str, side: float, changes: int, rng: np.random.Generator) -> dict[str, Any]:
    """All figures of a level in chunks of ``side`` [m]."""
    chunks = split_terrain(Terrain.load(level_path(level), up="y"), side)
    graph = NodeGraph.build(join_chunks(chunks, level))
    updates, builds, same = [], [], True
    names = sorted(chunks)
    for k in range(-1, changes):
        name = names[rng.integers(len(names))]
        for change in (None, chunks[name]):
            graph, update = timed(lambda to=change, key=name: graph.update({key: to}))  # noqa: B023
            whole, build = timed(lambda: NodeGraph.build(graph.terrain, extent=graph.extent))  # noqa: B023
            same &= agree(graph, whole)
            if k >= 0:  # the first pays for compiling
                updates.append(update)
                builds.append(build)
    return {
        "chunks": len(chunks),
        "agree": bool(same),
        "update_ms": float(np.median(updates)),
        "build_ms": float(np.median(builds)),
        "ratio": float(np.median(updates) / np.median(builds)),
        "worst_ratio": float(np.max(updates) / np.median(builds)),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description="An update of the graph against a build of the whole.")
    parser.add_argument("--levels", nargs="+", choices=LEVELS, default=list(LEVELS))
    parser.add_argument("--changes", type=int, default=12, help="chunks removed and put back")
    parser.add_argument("--json", type=Path, help="write every figure here")
    parser.add_argument("--random", type=int, help="random changes to generated levels")
    parser.add_argument("--every", type=int, default=100, help="changes between two comparisons")
    parser.add_argument("--seed", type=int, default=0, help="of levels and changes of --random")
    options = parser.parse_args()
    if options.random:
        for kind, size, side in GENERATED:
            changes = options.random // len(GENERATED)
            same, compared = random_changes(kind, size, side, changes, options.every, options.seed)
            print(
                f"{kind} {size} in chunks of {side:g} m, seed {options.seed}, {changes} changes: "
                f"{same} of {compared} hashes are the same",
                flush=True,
            )
        return
    report: dict[str, Any] = {}
    print(f"{'level':12} {'chunks':>14}  {'update':>8} {'build':>8}  ratio (worst)  the same graph")
    for level in options.levels:
        for side in SIDES:
            row = measure(level, side, options.changes, np.random.default_rng(0))
            report[f"{level} {side:g}"] = row
            times = f"{row['update_ms']:5.1f} ms {row['build_ms']:5.1f} ms"
            ratio = f"{row['ratio']:.2f} ({row['worst_ratio']:.2f})"
            same = "yes" if row["agree"] else "NO"
            print(f"{level:12} {row['chunks']:>5} of {side:3g} m  {times}  {ratio}    {same}", flush=True)
    if options.json:
        options.json.write_text(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
