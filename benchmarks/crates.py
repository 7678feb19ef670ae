"""Two crates of about 0.4 m in a row: how many people get over both, and how often they go back first.

    python -m benchmarks.crates [--seeds 30] [--seed 0] [--seconds 150] [--json FILE]

Each seed gives three levels, in a corridor or on a plane: "stairs", a crate with another one on it, 4 to 12 m
behind its edge; "ramps", a crate with a ramp down, and another one 0.5 to 12 m behind that; "leaps", a crate
and another one 0.5 to 3 m behind it. A person is sent onto the second crate. Only levels with a route there
count.
"""

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

import navmesh
from benchmarks.getting_nowhere import box, follow
from runtime import World
from runtime.planning.rules import person_walk_rules

KINDS = "stairs", "ramps", "leaps"


def crates(rng: np.random.Generator, kind: str) -> tuple[navmesh.Terrain, np.ndarray, np.ndarray]:
    """A level of that kind, where a person starts and where it is to go (3,) [m]."""
    corridor = bool(rng.random() < 0.5)
    room = rng.uniform(2.0, 6.0) if corridor else 24.0
    wide = room if corridor else rng.uniform(4.0, 10.0)
    low, high = 0.5 * (room - wide), 0.5 * (room + wide)
    first, (one, other), last = rng.uniform(9, 15), rng.uniform(0.35, 0.45, 2), rng.uniform(5, 8)
    if kind == "stairs":
        second, top = first + rng.uniform(4.0, 12.0), one + other
        parts = [box(first, low, -0.2, second + last, high, one)]
    elif kind == "ramps":
        down, top = first + rng.uniform(1.0, 4.0), other
        ends = down + one / np.tan(np.radians(rng.uniform(8, 18)))
        second = ends + rng.uniform(0.5, 12.0)
        sides = [(down, -0.2), (down, one), (ends, 0.0), (ends, -0.2)]
        corners = np.array([[x, y, z] for y in (low, high) for x, z in sides])
        parts = [box(first, low, -0.2, down, high, one), trimesh.convex.convex_hull(corners)]
    else:
        ends, top = first + rng.uniform(1.0, 12.0), one
        second = ends + rng.uniform(0.5, 3.0)
        parts = [box(first, low, -0.2, ends, high, one)]
    length = second + last + 3.0
    parts += [box(second, low, -0.2, second + last, high, top), box(0, 0, -1, length, room, 0)]
    if corridor:
        parts += [box(0, -0.3, -1, length, 0, 3), box(0, room, -1, length, room + 0.3, 3)]
    mesh = trimesh.util.concatenate(parts)
    start = np.array([rng.uniform(1.0, first - 4.0), 0.5 * room, 0.0])
    goal = np.array([second + last - 1.0, 0.5 * room, top])
    return navmesh.Terrain.from_arrays(np.asarray(mesh.vertices, np.float64), mesh.faces), start, goal


def run(seeds: int, seed: int, seconds: float) -> list[dict[str, Any]]:
    """What became of each person."""
    results = []
    for number in range(seed, seed + seeds):
        for index, kind in enumerate(KINDS):
            rng = np.random.default_rng([number, index])
            terrain, start, goal = crates(rng, kind)
            world = World(navmesh.NodeGraph.build(terrain, person_walk_rules()), seed=number)
            agent = world.spawn("human", start)
            if agent.go_to(goal, speed=float(rng.choice([1.4, 2.0, 3.3]))) != "blocked":
                results.append({"seed": number, "kind": kind, **follow(world, agent, seconds)})
    return results


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=30)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=150.0, help="simulated, for each person")
    parser.add_argument("--json", type=Path, help="write what became of each person here")
    options = parser.parse_args()
    results = run(options.seeds, options.seed, options.seconds)
    for kind in KINDS:
        each = [result for result in results if result["kind"] == kind]
        if each:
            arrived, back = sum(r["arrived"] for r in each), [r["goings_back"] for r in each]
            print(
                f"{kind}: {arrived} of {len(each)} people arrive, {np.mean(back):.2f} goings back each, "
                f"{max(back)} at most; {sum(r['falls'] for r in each)} falls; "
                f"{np.mean([r['seconds'] for r in each]):.1f} s each, at most "
                f"{max(r['longest_silence'] for r in each):.1f} s without headway or event"
            )
    if options.json:
        options.json.write_text(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
