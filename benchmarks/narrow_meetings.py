"""Whether bodies that meet in a passage too narrow for both walk through each other, and whether they get
past.

    python -m benchmarks.narrow_meetings [--starts 20] [--seed 0] [--kinds dog,dog cat,horse ...]

Two or three bodies are sent through a passage from both sides. It is wide enough for one and not two, and 1
to 12 m long; it joins two rooms ("rooms"), or has ends without room to pass ("closed"). "overlap" is the
deepest of any two bodies in any tick, as a share of the smaller radius (people sway: theirs need not be 0);
"ended" counts the bodies that arrived, that are stuck and said why, and that are neither after `SECONDS`;
"silent" is the longest time [s] that one on its way stood without an event.
"""

import argparse
import json
from collections import Counter
from pathlib import Path

import numpy as np

from benchmarks.giving_way import floor, overlap
from runtime import World
from runtime.bodies.registry import kind_of
from runtime.planning.rules import walk_rules

KINDS = (
    "dog,dog", "cat,cat", "horse,horse", "dog,cat", "dog,horse", "dog,human", "horse,human", "human,human",
    "dog,dog,dog", "dog,cat,human",
)  # fmt: skip
SECONDS = 150.0
_STANDS = 0.1  # [m] that one has to move not to be standing


def passage(kinds: tuple[str, ...], random: np.random.Generator) -> tuple[World, bool]:
    """A world with those who are about to meet, and whether the passage lies between two rooms."""
    radius = max(kind_of(kind).radius(kind) for kind in kinds)
    width = 2.0 * radius + random.uniform(0.05, 1.5 * min(kind_of(kind).radius(kind) for kind in kinds))
    rooms, length = bool(random.random() < 0.7), random.uniform(1.0, 12.0)
    side = 10.0 if rooms else 0.5 * max(24.0 - length, 0.0)
    low = 4.0 - 0.5 * width, 4.0 + 0.5 * width
    wide = (0.0, 8.0) if rooms else low
    ends = side, side + length
    graph = floor(
        (0.0, wide[0], ends[0], wide[1]),
        (ends[0], low[0], ends[1], low[1]),
        (ends[1], wide[0], side + ends[1], wide[1]),
        rules=walk_rules(kinds),
    )
    world = World(graph, seed=int(random.integers(1000)))
    for k, kind in enumerate(kinds):
        beside = random.uniform(-1.5, 1.5, 2) if rooms else np.zeros(2)
        far = 3.0 * (k // 2)  # those behind another one
        x = ends[0] - random.uniform(2.5, 4.0) - far
        x = max(x, 2.0)
        goal = ends[1] + random.uniform(4.0, 7.0)
        facing = 0.0
        if k % 2:
            x, goal, facing = side + ends[1] - x, side + ends[1] - goal, np.pi
        agent = world.spawn(kind, (x, 4.0 + beside[0], 0.0), facing)
        agent.go_to((goal, 4.0 + beside[1], 0.0), speed=random.uniform(0.8, 1.6))
    return world, rooms


def meet(kinds: tuple[str, ...], seed: int) -> dict:
    """One meeting."""
    world, rooms = passage(kinds, np.random.default_rng([seed, len(kinds), 41]))
    agents = list(world.agents.values())
    told, silent, deepest = dict.fromkeys(world.agents, 0.0), 0.0, 0.0
    places = {agent.name: agent.position for agent in agents}
    while world.time < SECONDS and any(agent.moving for agent in agents):
        world.step(0.05)
        deepest = max(deepest, overlap(world))
        for event in world.events:
            told[event.agent] = world.time
        for agent in agents:
            moved = np.linalg.norm(agent.position - places[agent.name]) > _STANDS
            if moved or not agent.moving:
                told[agent.name], places[agent.name] = world.time, agent.position
            silent = max(silent, world.time - told[agent.name])
    ended = Counter("moving" if agent.moving else agent.status for agent in agents)
    return {
        "seed": seed,
        "rooms": rooms,
        "overlap": deepest,
        "silent": silent,
        "seconds": world.time,
        "ended": ended,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--starts", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0, help="of the first start")
    parser.add_argument("--kinds", nargs="+", default=KINDS)
    parser.add_argument("--each", action="store_true", help="print every start")
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    results = {}
    print(f"{'kinds':16} {'passage':7} {'starts':>6} {'overlap':>8} {'touching':>8} {'silent':>6}  ended")
    for kinds in options.kinds:
        runs = []
        for k in range(options.starts):
            runs.append(meet(tuple(kinds.split(",")), options.seed + k))
            if options.each:
                print(kinds, runs[-1], flush=True)
        for rooms in (True, False):
            some = [run for run in runs if run["rooms"] == rooms]
            if some:
                ended = sum((run["ended"] for run in some), Counter())
                touching = sum(run["overlap"] > 0.0 for run in some)
                print(
                    f"{kinds:16} {'rooms' if rooms else 'closed':7} {len(some):6} "
                    f"{max(run['overlap'] for run in some):8.2f} {touching:8} "
                    f"{max(run['silent'] for run in some):6.1f}  "
                    + ", ".join(f"{count} {end}" for end, count in sorted(ended.items())),
                    flush=True,
                )
        results[kinds] = runs
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
