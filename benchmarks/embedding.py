"""What a world's step costs on top of the sum of its parts.

    python -m benchmarks.embedding [--agents 100] [--repeats 15] [--json embedding.json]

A hundred agents move over a floor. From one saved moment, alternately, the world is stepped by frames of 1/60
s with its events read, and its bodies are ticked directly as often: each person, the herd, each animal, and
giving way. CPU time, fastest of the repeats, to exclude other load. Both must end with the same hash.
"blended" is the world's step with every pose read in every frame.
"""

import argparse
import json
import time
from pathlib import Path

import numpy as np

import navmesh
from runtime import Agent, World
from runtime.traffic.traffic import EVERY

SIDE = 60.0  # [m]
FRAMES = 30
LIMIT = 0.10
MIXES = {"people": ("human",), "dogs": ("dog",), "both": ("human", "dog")}


def populate(graph: navmesh.NodeGraph, bodies: tuple[str, ...], count: int) -> World:
    """A world with ``count`` agents that have been on their way for a second."""
    world = World(graph, seed=1)
    for number in range(count):
        start, goal = world.random.uniform(2.0, SIDE - 2.0, (2, 2))
        facing = float(np.arctan2(*(goal - start)[::-1]))
        agent = world.spawn(bodies[number % len(bodies)], (*start, 0.0), facing)
        agent.go_to((*goal, 0.0), speed=1.2)
    world.step(1.0)
    return world


def step_world(world: World) -> None:
    for _ in range(FRAMES):
        world.step(1 / 60)
        _ = world.events


def step_and_draw(world: World) -> None:
    for _ in range(FRAMES):
        world.step(1 / 60)
        for agent in world.agents.values():
            _ = agent.blended_pose


def tick_parts(world: World, agents: list[Agent], ticks: int) -> None:
    """What a world's step is made of, without the world's own doing."""
    begun = round(world.time / 0.01)
    humans = [agent.human for agent in agents if agent.body == "human"]
    animals = [agent.animal for agent in agents if agent.body != "human"]
    herds = {id(animal.herd): animal.herd for animal in animals}.values()
    for tick in range(begun, begun + ticks):
        if tick % EVERY == 0:
            world._traffic.direct(tick)
        for human in humans:
            human.tick()
        for herd in herds:
            herd.tick()
        for animal in animals:
            animal.tick()


def measure(world: World, repeats: int) -> dict[str, float]:
    """Milliseconds for each frame."""
    saved, ticks = world.save(), round(FRAMES / 60 / 0.01)
    agents = list(world.agents.values())
    ways = {
        "parts": lambda: tick_parts(world, agents, ticks),
        "world": lambda: step_world(world),
        "blended": lambda: step_and_draw(world),
    }
    best = dict.fromkeys(ways, np.inf)
    for _ in range(repeats):
        ends = set()
        for name, run in ways.items():
            world.restore(saved)
            begun = time.process_time()
            run()
            best[name] = min(best[name], time.process_time() - begun)
            ends.add(tuple(agent.state_hash() for agent in agents))
        if len(ends) != 1:
            raise SystemExit("the world and its parts did not do the same")
    return {name: 1e3 * seconds / FRAMES for name, seconds in best.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--agents", type=int, default=100)
    parser.add_argument("--repeats", type=int, default=15)
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    corners = SIDE * np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    graph = World(navmesh.Terrain.from_arrays(corners, np.array([[0, 1, 2], [0, 2, 3]]))).graph
    results = {}
    print(f"{options.agents} agents, milliseconds of CPU for each frame of 1/60 s")
    print(f"{'':8} {'parts':>8} {'world':>8} {'over':>7} {'held':>5} {'blended':>8}")
    for name, bodies in MIXES.items():
        row = measure(populate(graph, bodies, options.agents), options.repeats)
        over = row["world"] / row["parts"] - 1.0
        results[name] = {**row, "over": over}
        held = "yes" if over <= LIMIT else "no"
        print(f"{name:8} {row['parts']:8.3f} {row['world']:8.3f} {over:7.1%} {held:>5} {row['blended']:8.3f}")
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
