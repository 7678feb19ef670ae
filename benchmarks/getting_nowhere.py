"""Agents that get nowhere without an event, on random levels of boxes, gaps, platforms, walls and slopes.

    python -m benchmarks.getting_nowhere [--levels 20] [--seed 0] [--people 2] [--seconds 120] [--json FILE]

On each level people are sent between random connected places. The table counts who arrives, is stuck at the
end, falls, and falls while going back for a run-up. "Silent": agents without progress for more than 10 s (and
`SLACK`) without an event: no less is left of their path, or they stay within 1 m.
"""

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

import navmesh
from runtime import Arrived, Departed, Event, Fell, Hindered, RuntimeInputError, World
from runtime.planning.rules import person_walk_rules
from runtime.world.agent import Agent

SIZE = 44.0
"""[m] of a level's sides."""
SLACK = 1.0
"""[s] over 10 s that count as in time: agents look twice a second."""
_STEP = 0.1  # [s]
_TRIES = 60
_BACK = "for another run-up to"  # is in the event's reason when a person has just turned round


def random_level(rng: np.random.Generator) -> navmesh.Terrain:
    """A floor with a gap across it, walls, platforms, boxes and a slope, at random places and of random
    sizes."""
    gap, wide = rng.uniform(14.0, 30.0), rng.uniform(0.5, 1.6)
    boxes = [box(0, 0, -0.3, gap, SIZE, 0), box(gap + wide, 0, -0.3, SIZE, SIZE, 0)]
    boxes.append(box(gap - 1, 0, -4, gap + wide + 1, SIZE, -3.8))
    for _ in range(rng.integers(3, 7)):
        x, y, z = rng.uniform(2, SIZE - 10), rng.uniform(2, SIZE - 10), rng.uniform(0.3, 0.7)
        boxes.append(box(x, y, 0, x + rng.uniform(2, 8), y + rng.uniform(2, 8), z))
    for _ in range(rng.integers(2, 5)):
        x, y, z = rng.uniform(2, SIZE - 4), rng.uniform(0, SIZE - 14), rng.uniform(0.6, 2.5)
        boxes.append(box(x, y, 0, x + rng.uniform(0.15, 0.4), y + rng.uniform(4, 14), z))
    for _ in range(rng.integers(4, 10)):
        x, y = rng.uniform(1, SIZE - 3, 2)
        boxes.append(box(x, y, 0, x + rng.uniform(0.4, 2), y + rng.uniform(0.4, 2), rng.uniform(0.4, 2)))
    x, y, high, slope = (
        rng.uniform(2, 10),
        rng.uniform(2, SIZE - 8),
        rng.uniform(0.5, 1.8),
        rng.uniform(8, 19),
    )
    run = high / np.tan(np.radians(slope))
    ends = [(x, 0.0), (x + run, high), (x + run + 3, high), (x + run + 3, 0.0)]
    corners = np.array([[px, py, z] for py in (y, y + 4) for px, z in ends])
    boxes.append(trimesh.convex.convex_hull(corners))
    mesh = trimesh.util.concatenate(boxes)
    return navmesh.Terrain.from_arrays(np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces))


def box(x0: float, y0: float, z0: float, x1: float, y1: float, z1: float) -> trimesh.Trimesh:
    """From its low to its high corner [m]."""
    return trimesh.creation.box(bounds=[(x0, y0, z0), (x1, y1, z1)])


class Watch:
    """For how long an agent has got nowhere without a word; ``longest`` [s]."""

    def __init__(self) -> None:
        self.longest = 0.0
        self._since, self._left = 0.0, np.inf
        self._places: list[np.ndarray] = []

    def look(self, agent: Agent, now: float, told: bool) -> None:
        """After a step; ``told``: whether there was an event of it."""
        left = agent.driver.left
        self._places = [*self._places[-round(10.0 / _STEP) :], agent.position]
        apart = np.linalg.norm(np.array(self._places) - agent.position, axis=1).max()
        stays = len(self._places) > 10.0 / _STEP and apart < 1.0 and agent.status != "scrambling"
        if told:
            self._since, self._left, self._places = now, left, []
        elif left < self._left - 0.25 and not stays:
            self._since, self._left = now, left
        self.longest = max(self.longest, now - self._since)


def send_somebody(world: World, rng: np.random.Generator, seconds: float) -> dict[str, Any] | None:
    """How it goes with a person between two random places; None where no way was found."""
    graph = world.graph
    roomy = np.flatnonzero(graph.radii > 0.5)
    for _ in range(_TRIES):
        start, goal = graph.positions[rng.choice(roomy, 2)]
        if not 8.0 < float(np.linalg.norm(goal - start)) < 30.0:
            continue
        agent = world.spawn("human", start, float(rng.uniform(-np.pi, np.pi)))
        if agent.go_to(goal, speed=float(rng.choice([1.4, 2.0, 3.3]))) != "blocked":
            return follow(world, agent, seconds)
        agent.remove()
    return None


def follow(world: World, agent: Agent, seconds: float) -> dict[str, Any]:
    """Watch an agent that has just been told to go somewhere for at most ``seconds``, then remove it: what
    became of it."""
    begun, watch = world.time, Watch()
    events: list[Event] = [each for each in world.events if each.agent == agent.name]
    back = backwards = 0
    watch.look(agent, 0.0, True)
    while agent.moving and world.time - begun < seconds:
        goes_back = agent.human.follower.interrupted is not None
        world.step(_STEP)
        new = world.events
        events += new
        back += sum(isinstance(each, Fell) for each in new)
        backwards += goes_back and any(isinstance(each, Fell) for each in new)
        watch.look(agent, world.time - begun, bool(new))
    result = {
        "status": "on its way" if agent.moving else agent.status,
        "skills": next(list(each.skills) for each in events if isinstance(each, Departed)),
        "seconds": round(world.time - begun, 1),
        "arrived": any(isinstance(each, Arrived) for each in events),
        "hindered": sum(isinstance(each, Hindered) for each in events),
        "goings_back": sum(isinstance(each, Hindered) and _BACK in each.reason for each in events),
        "falls": back,
        "falls_going_back": backwards,
        "longest_silence": round(watch.longest, 1),
        "silent": watch.longest > 10.0 + SLACK,
    }
    agent.remove()
    return result


def run(levels: int, seed: int, people: int, seconds: float) -> list[dict[str, Any]]:
    """What happened on ``levels`` random ones, each with its seed."""
    results = []
    for number in range(seed, seed + levels):
        rng = np.random.default_rng(number)
        world = World(navmesh.NodeGraph.build(random_level(rng), person_walk_rules()), seed=number)
        for _ in range(people):
            try:
                result = send_somebody(world, rng, seconds)
            except RuntimeInputError as error:
                raise SystemExit(f"level {number}: {error}") from None
            if result is not None:
                results.append({"level": number, **result})
    return results


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--levels", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--people", type=int, default=2, help="on each level")
    parser.add_argument("--seconds", type=float, default=120.0, help="simulated, for each")
    parser.add_argument("--json", type=Path, help="write every way here")
    options = parser.parse_args()
    results = run(options.levels, options.seed, options.people, options.seconds)
    counts = {
        "over obstacles": sum(bool(each["skills"]) for each in results),
        **{
            name: sum(each["status"] == name for each in results)
            for name in ("arrived", "stuck", "on its way")
        },
        **{
            name.replace("_", " "): sum(each[name] for each in results)
            for name in ("falls", "falls_going_back")
        },
        "silent": sum(each["silent"] for each in results),
    }
    print(f"{len(results)} ways: " + ", ".join(f"{name} {count}" for name, count in counts.items()))
    if options.json:
        options.json.write_text(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
