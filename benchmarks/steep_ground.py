"""How steep a slope people can walk and run on.

    python -m benchmarks.steep_ground [--degrees 10 20 30] [--starts 5] [--seed 0]

A plane of that slope, 8 m long on the map, lies between two level floors. People go up, down and across it,
told 1.2, 2 and 3.3 m/s, from `--starts` random places. "falls" is the share of runs with a fall; "arrives"
the share that reached the goal within `SECONDS`; "seconds" the median time of these; "ends" how the others
ended; "silent" the longest time [s] without progress or event.
"""

import argparse
import json
import math
from collections import Counter
from pathlib import Path

import numpy as np

import navmesh
from runtime import Fell, World
from runtime.planning.rules import walk_rules

DEGREES = (5.0, 10.0, 15.0, 18.0, 20.0, 22.0, 25.0, 28.0, 31.0, 34.0, 37.0, 40.0)
SPEEDS = (1.2, 2.0, 3.3)  # [m/s]
WAYS = ("up", "down", "across")
SECONDS = 120.0
_LONG, _WIDE, _LEVEL = 8.0, 14.0, 8.0  # [m]
_HEADWAY = 0.25  # [m] that one has to move within the time to count as getting on


def hill(degrees: float) -> navmesh.NodeGraph:
    """A level floor, a slope that rises along x from 0 to `_LONG`, and a level floor."""
    high = _LONG * math.tan(math.radians(degrees))
    xs, zs = (-_LEVEL, 0.0, _LONG, _LONG + _LEVEL), (0.0, 0.0, high, high)
    corners = [(x, y, z) for x, z in zip(xs, zs, strict=True) for y in (0.0, _WIDE)]
    faces = [face for k in (0, 2, 4) for face in ((k, k + 2, k + 3), (k, k + 3, k + 1))]
    terrain = navmesh.Terrain.from_arrays(np.array(corners), np.array(faces))
    return navmesh.NodeGraph.build(terrain, walk_rules(["human"], max_slope_deg=degrees + 1.0))


def walk(graph: navmesh.NodeGraph, degrees: float, way: str, speed: float, seed: int) -> dict:
    """One way of one person."""
    random = np.random.default_rng([seed, WAYS.index(way), round(10 * speed)])
    rise = math.tan(math.radians(degrees))
    y = random.uniform(4.0, _WIDE - 4.0)
    low, high = (-random.uniform(4.0, 6.0), y, 0.0), (_LONG + random.uniform(3.0, 5.0), y, _LONG * rise)
    start, goal = (low, high) if way == "up" else (high, low)
    if way == "across":
        x = random.uniform(3.0, 5.0)
        start, goal = (x, 2.0, x * rise), (x, _WIDE - 2.0, x * rise)
    world = World(graph, seed=seed)
    person = world.spawn("human", start, math.atan2(goal[1] - start[1], goal[0] - start[0]))
    told, told_at, place, silent, events = 0.0, person.go_to(goal, speed=speed), start, 0.0, []
    while world.time < SECONDS and person.moving:
        world.step(0.1)
        news = world.events
        events += news
        if news or np.linalg.norm(person.position - place) > _HEADWAY:
            told, place = world.time, person.position
        silent = max(silent, world.time - told)
    ended = "moving" if person.moving else person.status
    return {
        "degrees": degrees, "way": way, "speed": speed, "seed": seed, "told": told_at,
        "falls": sum(isinstance(event, Fell) for event in events), "ended": ended,
        "seconds": world.time, "silent": silent,
    }  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--degrees", type=float, nargs="+", default=DEGREES)
    parser.add_argument("--starts", type=int, default=5)
    parser.add_argument("--seed", type=int, default=0, help="of the first start")
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    runs = []
    print(
        f"{'slope':>5} {'way':7} {'told':>8} {'falls':>6} {'arrives':>7} {'seconds':>7} {'silent':>6}  ends"
    )
    for degrees in options.degrees:
        graph = hill(degrees)
        for way in WAYS:
            for speed in SPEEDS:
                row = [
                    walk(graph, degrees, way, speed, options.seed + start) for start in range(options.starts)
                ]
                runs += row
                there = [run["seconds"] for run in row if run["ended"] == "arrived"]
                others = Counter(run["ended"] for run in row if run["ended"] != "arrived")
                fell = np.mean([run["falls"] > 0 for run in row])
                print(
                    f"{degrees:4.0f}° {way:7} {speed:4.1f} m/s {fell:6.0%} "
                    f"{len(there) / len(row):7.0%} {np.median(there) if there else math.nan:7.1f} "
                    f"{max(run['silent'] for run in row):6.1f}  "
                    + ", ".join(f"{count} {end}" for end, count in sorted(others.items())),
                    flush=True,
                )
    if options.json:
        options.json.write_text(json.dumps(runs, indent=1) + "\n")


if __name__ == "__main__":
    main()
