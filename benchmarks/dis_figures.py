"""Remote figures against their originals: how far off they are drawn, how many packets that takes, and what
corrections do to what is drawn."""

from contextlib import suppress
from dataclasses import dataclass

import numpy as np

import navmesh
from runtime import RuntimeInputError, World
from runtime.dis import Exchange, Options, Place
from runtime.dis.incoming import remote_name

__all__ = ["FRAME", "Original", "Seen", "original", "seen"]

FRAME = 1.0 / 60.0
"""[s] between frames."""
ORIGIN = (48.137, 11.575, 520.0)
SENDER = ("127.0.0.1", 3001)


@dataclass
class Original:
    """A run: ``packets`` that were sent after each frame, and where the agents were then (frames, n, 3)."""

    graph: navmesh.NodeGraph
    packets: list[list[bytes]]
    places: np.ndarray
    names: list[tuple[int, int, int]]
    distance: np.ndarray

    @property
    def seconds(self) -> float:
        return len(self.packets) * FRAME


def random_goals(
    graph: navmesh.NodeGraph, chance: np.random.Generator, start: np.ndarray | None = None
) -> np.ndarray:
    """A start, unless it is given, and a goal at least 5 m away, on ground from which one gets to and fro."""
    while True:
        pair = graph.positions[chance.integers(0, len(graph), 2)]
        if start is not None:
            pair[0] = start
        if np.linalg.norm(pair[1] - pair[0]) > 5.0 and all(
            graph.find_path(*way, radius=0.35).status == "complete" for way in (pair, pair[::-1])
        ):
            return pair


def original(
    graph: navmesh.NodeGraph,
    bodies: tuple[str, ...],
    seconds: float,
    seed: int,
    options: Options | None = None,
) -> Original:
    """Agents go to and fro through a level, walking and running by turns, and stop for a while."""
    chance, world = np.random.default_rng(seed), World(graph, seed)
    exchange = Exchange(world, Place(1, 1, 1), ORIGIN, options)
    speeds = (1.3, 3.3, 1.8, 4.0)
    agents = []
    for body in bodies:
        agent = None
        while agent is None:
            start = random_goals(graph, chance)[0]
            if all(np.linalg.norm(start - other.position) > 2.0 for other in agents):
                with suppress(RuntimeInputError):  # a dog has no room there
                    agent = world.spawn(body, start)
        agents.append(agent)
    packets, places = [], []
    until = np.zeros(len(agents))
    for frame in range(round(seconds / FRAME)):
        for k, agent in enumerate(agents):
            if not agent.moving and world.time >= until[k] and agent.status != "fallen":
                goal = random_goals(graph, chance, agent.position)[1]
                agent.go_to(goal, speeds[(frame + k) % len(speeds)])
                until[k] = world.time + float(chance.uniform(2.0, 6.0))
        world.step(FRAME)
        packets.append(exchange.send())
        places.append([agent.position for agent in agents])
    told = np.array(places)
    names = [(1, 1, k + 1) for k in range(len(agents))]
    way = np.linalg.norm(np.diff(told, axis=0), axis=2).sum(axis=0)
    return Original(graph, packets, told, names, way)


@dataclass
class Seen:
    """``errors`` (frames, n) [m] of where figures are drawn, NaN while not there; ``packets`` that arrived.
    ``root`` [m], ``joint`` [rad]: the most that a correction changed in the next frame. ``step``: the most by
    which a drawn root's way differed from one frame to the next [m]."""

    errors: np.ndarray
    packets: int
    root: float
    joint: float
    step: float


def seen(run: Original, loss: float, seed: int, check_jumps: bool = True) -> Seen:
    """What another world shows of a run, of whose packets a share is lost."""
    chance, world = np.random.default_rng(seed), World(run.graph)
    exchange = Exchange(world, Place(1, 2, 1), ORIGIN)
    errors = np.full(run.places.shape[:2], np.nan)
    arrived, root, joint, step = 0, 0.0, 0.0, 0.0
    drawn: list[dict[str, np.ndarray]] = []
    for frame, packets in enumerate(run.packets):
        kept = [(each, SENDER) for each in packets if chance.uniform() >= loss]
        arrived += len(kept)
        without = None
        if check_jumps and kept and world.agents:
            saved = world.save()
            world.step(FRAME)
            without = {name: agent.pose for name, agent in world.agents.items()}
            world.restore(saved)
        # what was sent after this frame of the original is there before the next one is drawn
        exchange.receive(kept)
        for k, name in enumerate(run.names):
            agent = world.agents.get(remote_name(name))
            if agent is not None:
                errors[frame, k] = np.linalg.norm(agent.position - run.places[frame, k])
        world.step(FRAME)
        for name, pose in (without or {}).items():
            if name in world.agents:
                now = world.agents[name].pose
                root = max(root, float(np.linalg.norm(now.transforms[0, :3] - pose.transforms[0, :3])))
                dot = np.abs(np.sum(now.local[:, 3:] * pose.local[:, 3:], axis=1)).clip(0.0, 1.0)
                joint = max(joint, float(2.0 * np.arccos(dot).max()))
        drawn.append({name: agent.blended_pose.transforms[0, :3] for name, agent in world.agents.items()})
        if len(drawn) == 3:
            before, middle, after = drawn
            for name in before.keys() & middle.keys() & after.keys():
                bend = after[name] - 2.0 * middle[name] + before[name]
                step = max(step, float(np.linalg.norm(bend)))
            drawn.pop(0)
    return Seen(errors, arrived, root, joint, step)
