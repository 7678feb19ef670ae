"""What blocking and opening doors costs, and whether routes are those of a level with walls there.

    python -m benchmarks.navmesh_zones [--cities 4 16 33] [--doors 1000] [--turns 2000] [--seed 0]
    python -m benchmarks.navmesh_zones --compare 20 [--rooms 4] [--first 1000]

The first prints for each city: the time to divide the graph at so many doors over that of building it; the
time to block or open one, median, 99th percentile and worst; and the time of a query from Python, by itself
and right after a door was turned, and of turning the door with that query. Half of the doors stand alone, the
others are pairs of wings. The other turns doors of random apartments and compares routes with those of a
level that is built with walls in the place of what is blocked: status, length, how near a partial route gets.
"""

import argparse
import time
from collections import Counter
from itertools import pairwise

import numpy as np

from benchmarks.apartments import apartment, with_walls
from benchmarks.large_levels import large_level
from navmesh import NodeGraph, Terrain

RADIUS = 0.3  # [m]
RADII = (0.2, 0.3, 0.45)  # [m]
_LONG = 0.5  # [m] of routes whose lengths are compared


def doors_in(graph: NodeGraph, count: int, rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Outlines (4, 3) [m] of ``count`` doors of 1 to 2 m by 0.2 m, beside places of the graph."""
    places = graph.random_points(rng, count, radius=1.2)
    found = {}
    for place in places[: count // 2]:
        angle, wide = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(1.0, 2.0)
        along = np.array([np.cos(angle), np.sin(angle), 0.0])
        across = 0.1 * np.array([-along[1], along[0], 0.0])
        wings = 2 if rng.random() < 1.0 / 3.0 else 1
        for k in range(wings):
            low, high = (place + (share / wings - 0.5) * wide * along for share in (k, k + 1))
            found[f"door {len(found)}"] = np.array([low - across, high - across, high + across, low + across])
    return found


def turning(city: int, doors: int, turns: int, seed: int) -> str:
    """One line of figures of a city."""
    rng = np.random.default_rng(seed)
    level = large_level("city", city, seed)
    build = np.inf
    for _ in range(2 if city <= 8 else 1):
        begin = time.perf_counter()
        base = NodeGraph.build(level, obstacle_rules=None)
        build = min(build, time.perf_counter() - begin)
    outlines = doors_in(base, doors, rng)
    begin = time.perf_counter()
    graph = base.with_zones(outlines)
    divide = time.perf_counter() - begin
    names = list(outlines)
    ends = graph.random_points(rng, 400, radius=RADIUS, reachable_from=graph.positions[graph.radii.argmax()])
    near = list(pairwise(ends))
    for start, goal in near[:20]:
        graph.find_path(start, goal, RADIUS)
    turned, alone, after, both = [], [], [], []
    for turn in range(turns):
        name = names[rng.integers(len(names))]
        start, goal = near[turn % len(near)]
        act = graph.open if graph.zones[name] else graph.block
        begin = time.perf_counter()
        act(name)
        middle = time.perf_counter()
        graph.find_path(start, goal, RADIUS)
        end = time.perf_counter()
        graph.find_path(start, goal, RADIUS)
        alone.append(time.perf_counter() - end)
        turned.append(middle - begin)
        after.append(end - middle)
        both.append(end - begin)
    middle, far, worst = (1e6 * float(np.quantile(turned, q)) for q in (0.5, 0.99, 1.0))
    one, other, sum_ = (1e6 * float(np.median(each)) for each in (alone, after, both))
    return (
        f"city {city:<3} {len(names):>5}  {divide / build:10.2f}  {middle:6.0f} {far:6.0f} {worst:6.0f}"
        f"  {one:8.0f} {other:8.0f} {sum_:8.0f}"
    )


def compared(rooms: int, seed: int, told: Counter, ratios: list[float]) -> None:
    """Add to ``told`` and ``ratios`` what comes of routes in an apartment in four states of its doors."""
    level = apartment(rooms, seed)
    base = NodeGraph.build(level.terrain, obstacle_rules=None)
    graph = base.with_zones(level.doors)
    rng = np.random.default_rng(seed)
    for share in (0.0, 0.3, 0.6, 1.0):
        shut = [name for name in level.doors if rng.random() < share]
        graph.open(*level.doors)
        graph.block(*shut)
        built = walled(base, level.terrain, [level.doors[name] for name in shut])
        for radius in RADII:
            places = built.positions[built.radii >= radius]
            places = places[graph.clearance_at(places) >= radius]  # not inside of what is blocked
            starts, goals = places[rng.integers(len(places), size=(2, 60))]
            one, other = built.find_paths(starts, goals, radius), graph.find_paths(starts, goals, radius)
            for i in range(len(starts)):
                told["same status" if one.status[i] == other.status[i] else "another status"] += 1
                if one.status[i] == other.status[i] == "complete" and one.length[i] > _LONG:
                    ratios.append(float(other.length[i] / one.length[i]))
                if one.status[i] == other.status[i] == "partial":
                    ends = (routes.waypoints_of(i)[-1] for routes in (one, other))
                    away = [np.linalg.norm(end - goals[i]) for end in ends]
                    told["partial, as near" if abs(away[0] - away[1]) < 0.1 else "partial, elsewhere"] += 1


def walled(base: NodeGraph, terrain: Terrain, outlines: list[np.ndarray]) -> NodeGraph:
    """The level built with walls along ``outlines``."""
    if not outlines:
        return base
    return NodeGraph.build(with_walls(terrain, outlines), obstacle_rules=None, extent=base.extent)


def main() -> None:
    parser = argparse.ArgumentParser(description="Blocking and opening doors.")
    parser.add_argument("--cities", type=int, nargs="+", default=[4, 16, 33], help="sizes of cities")
    parser.add_argument("--doors", type=int, default=1000, help="about so many in each")
    parser.add_argument("--turns", type=int, default=2000, help="times that one is blocked or opened")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--compare", type=int, help="apartments to compare routes in")
    parser.add_argument("--rooms", type=int, default=4, help="along each side of an apartment")
    parser.add_argument("--first", type=int, default=1000, help="seed of the first apartment")
    options = parser.parse_args()
    if options.compare:
        told: Counter = Counter()
        ratios: list[float] = []
        for seed in range(options.first, options.first + options.compare):
            compared(options.rooms, seed, told, ratios)
        print(", ".join(f"{count} {what}" for what, count in sorted(told.items())))
        length = np.array(ratios)
        print(
            f"length over that with walls, of {len(length)}: mean {length.mean():.4f}, more than 1.02: "
            f"{100 * (length > 1.02).mean():.1f} %, less than 0.98: {100 * (length < 0.98).mean():.1f} %, "
            f"least {length.min():.2f}, greatest {length.max():.2f}"
        )
        return
    turning(2, 20, 20, options.seed)  # loads the compiled code
    print("level    zones  divide/build  turn [us]: median, 99 %, worst; query [us], after a turn, with it")
    for city in options.cities:
        print(turning(city, options.doors, options.turns, options.seed), flush=True)


if __name__ == "__main__":
    main()
