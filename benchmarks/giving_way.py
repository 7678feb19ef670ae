"""Whether dogs, people and walkers give way to each other.

    python -m benchmarks.giving_way [--starts 10] [--scenes crossing] [--pairs dog-dog] [--without]
        [--walk planned]

Scenes: two that meet head-on, two whose paths cross, one and two from each side of a door 1.2 m wide, three
sent to one place, and three that chase a point that moves at 1.2 m/s and then stops (told twice a second
where it is); each from `--starts` random starts, for every pair of kinds. "overlap" is the deepest of any two
discs (three for a dog) in any tick, as a share of the smaller radius; "touching" the starts with any overlap;
"at rest" those with any at the end; "falls" count whether or not the person got up.

With `--without` only walkers give way, for comparison.
"""

import argparse
import itertools
import json
from pathlib import Path

import numpy as np

import navmesh
from runtime import Agent, Fell, World
from runtime.bodies.kinds.kind import WALKS
from runtime.planning.rules import person_walk_rules

KINDS = {"dog": ("dog", 1.4), "person": ("human", 1.4), "runner": ("human", 3.0), "walker": ("walker", 1.4)}
PAIRS = [
    ("dog", "dog"), ("dog", "person"), ("person", "person"), ("dog", "walker"), ("person", "walker"),
    ("dog", "runner"), ("runner", "runner"),
]  # fmt: skip
SECONDS = 60.0


def floor(
    *parts: tuple[float, float, float, float], rules: navmesh.WalkRules | None = None
) -> navmesh.NodeGraph:
    """The graph of a level floor of rectangles x0, y0, x1, y1 [m], by default for people who walk."""
    corners, faces = [], []
    for x0, y0, x1, y1 in parts:
        n = len(corners)
        corners += [(x0, y0, 0.0), (x1, y0, 0.0), (x1, y1, 0.0), (x0, y1, 0.0)]
        faces += [(n, n + 1, n + 2), (n, n + 2, n + 3)]
    terrain = navmesh.Terrain.from_arrays(np.array(corners), np.array(faces))
    return navmesh.NodeGraph.build(terrain, person_walk_rules() if rules is None else rules)


HALL = [(0.0, 0.0, 30.0, 10.0)]
DOOR = [(0.0, 0.0, 14.8, 10.0), (14.8, 4.4, 15.2, 5.6), (15.2, 0.0, 30.0, 10.0)]


def ways(scene: str, random: np.random.Generator) -> list[tuple[np.ndarray, np.ndarray]]:
    """(start, goal) of each body, in turn of the pair's kinds."""
    jitter = random.uniform(-1.0, 1.0, (4, 2))
    if scene in ("one goal", "chase"):
        angles = random.uniform(0.0, 2.0 * np.pi) + np.radians([0.0, 120.0, 240.0]) + 0.8 * jitter[:3, 0]
        around = (
            np.column_stack([np.cos(angles), 0.35 * np.sin(angles)]) * (9.0 + 2.0 * jitter[:3, 1])[:, None]
        )
        return [(np.array([15.0, 5.0]) + each, np.array([15.0, 5.0])) for each in around]
    near, far = np.array([4.0, 5.0]), np.array([26.0, 5.0])
    if scene == "head-on":
        return [
            (near + jitter[0] * [1.0, 0.2], far),
            (far + jitter[1] * [1.0, 0.2], near),
        ]
    if scene == "crossing":
        return [
            (np.array([11.0, 5.0]) + jitter[0] * [1.0, 0.3], np.array([22.0, 5.0])),
            (np.array([15.0, 1.0]) + jitter[1] * 0.3, np.array([15.0, 9.2])),
        ]
    both = [(near + jitter[0] * [3.0, 2.0], far), (far + jitter[1] * [3.0, 2.0], near)]
    if scene == "doorway":
        return both
    up, down = np.array([0.0, 2.5]), np.array([0.0, 1.5])
    return [*both, (near + up + jitter[2], far + down), (far - up + jitter[3], near - down)]


def play(
    graph: navmesh.NodeGraph,
    pair: tuple[str, str],
    scene: str,
    seed: int,
    without: bool,
    walk: str = "learned",
) -> dict:
    world, random = World(graph, seed=seed, walk=walk), np.random.default_rng([seed, 7])
    if without:
        world._traffic.direct = lambda tick: None
    agents = []
    for kind, (start, goal) in zip(itertools.cycle(pair), ways(scene, random)):
        body, speed = KINDS[kind]
        facing = float(np.arctan2(*(goal - start)[::-1]))
        agents.append(world.spawn(body, (*start, 0.0), facing))
        agents[-1].go_to((*goal, 0.0), speed=speed)
    corners = np.vstack([agents[0].position[:2], random.uniform((2.0, 1.0), (28.0, 9.0), (3, 2))])
    deepest, ticks = 0.0, 0
    while world.time < SECONDS and (any(agent.moving for agent in agents) or scene == "chase"):
        if scene == "chase" and ticks % 50 == 0:
            send_after(agents, along(corners, 1.2 * world.time))
        ticks += 1
        world.step(0.01)
        deepest = max(deepest, overlap(world))
    falls = sum(isinstance(event, Fell) for event in world.events)
    ended = [agent.status for agent in agents]
    return {
        "overlap": deepest,
        "at rest": overlap(world),
        "ended": ended,
        "falls": falls,
        "seconds": world.time,
    }


def along(corners: np.ndarray, length: float) -> np.ndarray:
    """(2,) the point of a line through ``corners`` (k, 2) at an arc length, its end behind that."""
    arcs = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    return np.array([np.interp(length, arcs, corners[:, axis]) for axis in range(2)])


def send_after(agents: list[Agent], place: np.ndarray) -> None:
    """Tell those who are farther than a metre from ``place`` (2,) to go there."""
    for agent in agents:
        if np.linalg.norm(agent.position[:2] - place) > 1.0:
            agent.go_to((*place, 0.0), speed=2.0)


def overlap(world: World) -> float:
    """The deepest of any two bodies, as a share of the smaller radius."""
    discs, owner = [], []
    for population in world._populations:
        rows = population.in_the_way()
        each = len(rows) // max(len(population.followers()), 1) if population.followers() else 1
        discs += list(rows)
        owner += [(id(population), k // each) for k in range(len(rows))]
    table = np.array(discs)
    whose = np.array([list(dict.fromkeys(owner)).index(each) for each in owner])
    away = np.linalg.norm(table[:, None, :2] - table[None, :, :2], axis=2)
    least = np.minimum(table[:, None, 5], table[None, :, 5])
    deep = (table[:, None, 5] + table[None, :, 5] - away) / least
    return float(max(deep[whose[:, None] != whose[None]].max(), 0.0))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--starts", type=int, default=10)
    parser.add_argument("--scenes", default="head-on,crossing,doorway,doorway of four")
    parser.add_argument("--pairs", default=",".join("-".join(pair) for pair in PAIRS))
    parser.add_argument("--without", action="store_true")
    parser.add_argument("--walk", default=WALKS[0], choices=WALKS, help="as of World")
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    graphs = {False: floor(*HALL), True: floor(*DOOR)}
    results = []
    head = f"{'all arrive':>10} {'touching':>9} {'overlap':>8} {'at rest':>7} {'falls':>5} {'seconds':>8}"
    print(f"{'scene':16} {'pair':15} {head}")
    for scene in options.scenes.split(","):
        for pair in options.pairs.split(","):
            kinds = tuple(pair.split("-"))
            runs = [
                play(graphs[scene.startswith("door")], kinds, scene, seed, options.without, options.walk)
                for seed in range(options.starts)
            ]
            arrived = sum(all(end == "arrived" for end in run["ended"]) for run in runs)
            row = {
                "scene": scene, "pair": pair, "arrived": arrived, "starts": options.starts,
                "touching": sum(run["overlap"] > 0.0 for run in runs),
                "at rest": sum(run["at rest"] > 0.01 for run in runs),
                "overlap": max(run["overlap"] for run in runs),
                "falls": sum(run["falls"] for run in runs),
                "seconds": float(np.mean([run["seconds"] for run in runs])),
            }  # fmt: skip
            results.append(row)
            many = f"{arrived:4} of {options.starts:2} {row['touching']:9} {row['overlap']:8.2f}"
            rest = f"{row['at rest']:7} {row['falls']:5} {row['seconds']:8.1f}"
            print(f"{scene:16} {pair:15} {many} {rest}", flush=True)
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
