"""What blocking and opening doors costs, and whether routes are those of a level with walls there.

    python -m benchmarks.navmesh_zones [--rooms 8 24] [--cities 4 16] [--zones 300] [--seed 0]
    python -m benchmarks.navmesh_zones --compare 20 [--sides 4] [--first 1000]

The first prints for each level: the time to divide the graph over that of building it; the time to block and
to open one zone while all others are open, the first time and later; and that of a query from Python, by
itself and right after a zone was turned. ``--rooms``: floors of so many rooms a side, all doors of which are
zones. ``--cities``: cities with zones of 1 to 2 m by 0.2 m in their streets and squares, up to ``--zones`` of
them. The other turns doors of random apartments and compares routes with those of a level that is built with
walls in the place of what is blocked: status, length, how near a partial route gets; and, with all doors
open, with those of the graph without zones, which must be the same.
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
    """Outlines (4, 3) [m] of at most ``count`` doors of 1 to 2 m by 0.2 m, beside places of the graph."""
    places = graph.random_points(rng, count, radius=1.2)
    found = {}
    for place in places:
        if len(found) + 2 > count:
            break
        angle, wide = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(1.0, 2.0)
        along = np.array([np.cos(angle), np.sin(angle), 0.0])
        across = 0.1 * np.array([-along[1], along[0], 0.0])
        wings = 2 if rng.random() < 1.0 / 3.0 else 1
        for k in range(wings):
            low, high = (place + (share / wings - 0.5) * wide * along for share in (k, k + 1))
            found[f"door {len(found)}"] = np.array([low - across, high - across, high + across, low + across])
    return found


def turning(
    name: str, level: Terrain, outlines: dict[str, np.ndarray] | int, rng: np.random.Generator
) -> str:
    """One line of figures of a level, with zones ``outlines``, or so many beside places of it."""
    begin = time.perf_counter()
    base = NodeGraph.build(level, obstacle_rules=None)
    build = time.perf_counter() - begin
    if isinstance(outlines, int):
        outlines = doors_in(base, outlines, rng)
    begin = time.perf_counter()
    graph = base.with_zones(outlines)
    divide = time.perf_counter() - begin
    ends = graph.random_points(rng, 400, radius=RADIUS, reachable_from=graph.positions[base.radii.argmax()])
    near = list(pairwise(ends))
    for start, goal in near[:20]:
        graph.find_path(start, goal, RADIUS)
    names = list(outlines)
    times: dict[str, list[float]] = {"first": [], "later": [], "alone": [], "after first": [], "after": []}
    for turn in range(2 * len(names)):
        zone = names[turn % len(names)]
        for act in (graph.block, graph.open):
            start, goal = near[rng.integers(len(near))]
            begin = time.perf_counter()
            act(zone)
            middle = time.perf_counter()
            graph.find_path(start, goal, RADIUS)
            end = time.perf_counter()
            graph.find_path(start, goal, RADIUS)
            alone = time.perf_counter() - end
            first = turn < len(names)
            times["alone"].append(alone)
            times["first" if first else "later"].append(middle - begin)
            times["after first" if first else "after"].append(end - middle - alone)
    side = np.sqrt(np.prod(np.ptp(level.bounds, axis=0)[:2]))
    told = [1e6 * float(np.median(times[each])) for each in ("first", "later")]
    told += [1e6 * float(np.quantile(times["later"], 0.9))]
    told += [1e6 * float(np.median(times[each])) for each in ("alone", "after first", "after")]
    return f"{name:10} {side:6.0f} {len(names):6}  {divide / build:8.2f}  " + "".join(
        f"{t:8.0f}" for t in told
    )


def compared(rooms: int, seed: int, told: Counter, ratios: list[float]) -> None:
    """Add to ``told`` and ``ratios`` what comes of routes in an apartment in four states of its doors."""
    level = apartment(rooms, seed)
    base = NodeGraph.build(level.terrain, obstacle_rules=None)
    graph = base.with_zones(level.doors)
    rng = np.random.default_rng(seed)
    for share in (0.3, 0.6, 1.0, 0.0):  # all open at last, when there has been something to mend
        shut = [name for name in level.doors if rng.random() < share]
        graph.open(*level.doors)
        graph.block(*shut)
        built = walled(base, level.terrain, [level.doors[name] for name in shut])
        for radius in RADII:
            places = built.positions[built.radii >= radius]
            places = places[graph.clearance_at(places) >= radius]  # not inside of what is blocked
            starts, goals = places[rng.integers(len(places), size=(2, 60))]
            one, other = built.find_paths(starts, goals, radius), graph.find_paths(starts, goals, radius)
            if not shut:
                same = np.array_equal(one.waypoints, other.waypoints) and (one.status == other.status).all()
                told["all open: " + ("the same routes" if same else "other routes")] += len(starts)
                continue
            for i in range(len(starts)):
                before, after = one.status[i], other.status[i]
                told["same status" if before == after else f"{before}, with zones {after}"] += 1
                if before == after == "complete" and one.length[i] > _LONG:
                    ratios.append(float(other.length[i] / one.length[i]))
                if before == after == "partial":
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
    parser.add_argument("--rooms", type=int, nargs="*", default=[8, 24], help="rooms a side of floors")
    parser.add_argument("--cities", type=int, nargs="*", default=[4, 16], help="sizes of cities")
    parser.add_argument("--zones", type=int, default=300, help="at most so many in a city")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--compare", type=int, help="apartments to compare routes in")
    parser.add_argument("--sides", type=int, default=4, help="rooms a side of these apartments")
    parser.add_argument("--first", type=int, default=1000, help="seed of the first apartment")
    options = parser.parse_args()
    if options.compare:
        told: Counter = Counter()
        ratios: list[float] = []
        for seed in range(options.first, options.first + options.compare):
            compared(options.sides, seed, told, ratios)
        print(", ".join(f"{count} {what}" for what, count in sorted(told.items())))
        length = np.array(ratios)
        print(
            f"length over that with walls, of {len(length)}: mean {length.mean():.4f}, more than 1.02: "
            f"{100 * (length > 1.02).mean():.1f} %, less than 0.98: {100 * (length < 0.98).mean():.1f} %, "
            f"least {length.min():.2f}, greatest {length.max():.2f}"
        )
        return
    rng = np.random.default_rng(options.seed)
    small = apartment(2, options.seed)
    turning("", small.terrain, small.doors, rng)  # loads the compiled code
    print(
        "level      side m  zones  div/build  turn [us]: first, later, 90 %;  query [us], more after a turn: "
        "first, later"
    )
    for rooms in options.rooms:
        level = apartment(rooms, options.seed)
        print(turning(f"rooms {rooms}", level.terrain, level.doors, rng), flush=True)
    for city in options.cities:
        level = large_level("city", city, options.seed)
        print(turning(f"city {city}", level, options.zones, rng), flush=True)


if __name__ == "__main__":
    main()
