"""What a graph update costs relative to a full build. Prints a table and writes JSON.

    python -m benchmarks.navmesh_update [--levels LEVEL ...] [--changes 12] [--json FILE]

Each level is split into chunks of 2 m and of 10 m; random ones are removed and put back. After each change
the same level is also built in full, alternating with the update, and both must be bit-identical. Ratios are
of median processor times.
"""

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.shared_data import LEVELS, level_path
from navmesh import NodeGraph, Terrain, join_chunks, split_terrain

SIDES = (2.0, 10.0)


def timed(make: Callable[[], NodeGraph]) -> tuple[NodeGraph, float]:
    """What ``make`` gives, and the processor time [ms] that it took."""
    begin = time.process_time()
    graph = make()
    return graph, 1e3 * (time.process_time() - begin)


def agree(one: NodeGraph, other: NodeGraph) -> bool:
    """Whether two graphs have the same nodes, radii, links and obstacles, bit for bit."""
    pairs = [
        (getattr(one, name), getattr(other, name))
        for name in ("positions", "radii", "label", "edge_start", "edge_target", "edge_width", "edge_gate")
    ]
    pairs += [(one.surface.nearest, other.surface.nearest), (one.surface.link, other.surface.link)]
    for part in ("obstacles", "links"):
        expected = getattr(other, part).arrays()
        pairs += [(array, expected[name]) for name, array in getattr(one, part).arrays().items()]
    return all(np.array_equal(a, b) for a, b in pairs)


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
    options = parser.parse_args()
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
