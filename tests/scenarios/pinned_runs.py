"""Runs of every kind, and what everybody could see of them as one hash each.

    python tests/scenarios/pinned_runs.py > tests/scenarios/pinned_runs.json

What is hashed is what a host sees, ten times a second: poses, places, statuses and events. So the hashes
hold while the code is moved about, and change when anybody moves by a bit otherwise.
"""

import hashlib
import itertools
import json
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import mujoco
import numpy as np
import scipy

import navmesh
from runtime import World, WorldState

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
PINNED = Path(__file__).with_suffix(".json")
_EVERY = 0.1  # [s]
Place = tuple[float, float, float]


def machine() -> str:
    """Names a machine whose arithmetic gives these hashes: versions, and last bits of functions."""
    numbers = np.linspace(0.1, 9.7, 1001)
    functions = (np.sin, np.exp, np.log, np.arctan, np.sqrt, np.cbrt)
    bits = b"".join(function(numbers).tobytes() for function in functions)
    square = np.outer(numbers[:50], np.sin(numbers[:50])) + np.eye(50)
    bits += (square @ square).tobytes() + np.linalg.solve(square, numbers[:50]).tobytes()
    versions = (mujoco.__version__, np.__version__, scipy.__version__)
    return hashlib.sha256(repr(versions).encode() + bits).hexdigest()[:16]


@dataclass
class Recorder:
    """A world, and the hash of what is seen of it."""

    world: World
    seen: "hashlib._Hash" = field(default_factory=hashlib.sha256)
    events: list[str] = field(default_factory=list)

    @property
    def hash(self) -> str:
        return self.seen.hexdigest()[:32]

    def go_on(self, seconds: float) -> None:
        for _ in range(round(seconds / _EVERY)):
            self.world.step(_EVERY)
            for name, agent in self.world.agents.items():
                self.seen.update(f"{name} {agent.status} {agent.progress!r}".encode())
                self.seen.update(agent.pose.transforms.tobytes())
                self.seen.update(agent.position.tobytes())
            for event in self.world.events:
                self.seen.update(json.dumps(event.to_dict(), sort_keys=True).encode())
                self.events.append(str(event))


def level(name: str = "courtyard", seed: int = 5) -> World:
    return World(navmesh.Terrain.load(EXAMPLES / "levels" / f"{name}.obj", up="z"), seed=seed)


def box(low: Place, high: Place) -> navmesh.Terrain:
    corners = np.array(list(itertools.product(*zip(low, high, strict=True))))
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [face for a, b, c, d in sides for face in ((a, b, c), (a, c, d))]
    return navmesh.Terrain.from_arrays(corners, np.array(faces))


def one_way(
    body: str, start: tuple, goal: tuple, speed: float, seconds: float, where: str = "courtyard"
) -> Recorder:
    recorder = Recorder(level(where))
    recorder.world.spawn(body, start).go_to(goal, speed=speed)
    recorder.go_on(seconds)
    return recorder


def walk() -> Recorder:
    return one_way("human", (4.0, 26.0, 0.0), (10.0, 31.0, 0.0), 1.4, 9.0)


def ramp() -> Recorder:
    return one_way("human", (54.0, 37.8, 0.0), (38.0, 37.8, 3.0), 1.6, 12.0)


def run_with_bends() -> Recorder:
    return one_way("human", (3.0, 24.0, 0.0), (22.0, 31.0, 0.0), 4.0, 7.0)


def jump() -> Recorder:
    return one_way("human", (8.0, 4.0, 0.0), (32.0, 4.0, 0.3), 3.3, 10.0)


def vault() -> Recorder:
    parts = {
        "floor": box((0.0, 0.0, -1.0), (40.0, 8.0, 0.0)),
        "wall": box((20.0, 0.0, -1.0), (20.3, 8.0, 0.8)),
    }
    recorder = Recorder(World(navmesh.join_chunks(parts), seed=5))
    recorder.world.spawn("human", (4.0, 4.0, 0.0)).go_to((30.0, 4.0, 0.0), speed=3.5)
    recorder.go_on(10.0)
    return recorder


def drop_roll() -> Recorder:
    return one_way("human", (42.0, 15.8, 1.2), (52.0, 26.0, 0.0), 3.5, 20.0)


def leap() -> Recorder:
    return one_way("human", (2.0, 2.5, 3.0), (24.0, 2.5, 3.0), 3.6, 10.0, "roofs")


def stop_while_running() -> Recorder:
    recorder = one_way("human", (6.0, 4.0, 0.0), (22.0, 4.0, 0.0), 3.5, 3.0)
    next(iter(recorder.world.agents.values())).stop()
    recorder.go_on(4.0)
    return recorder


def fall_and_get_up() -> Recorder:
    recorder = one_way("human", (6.0, 4.0, 0.0), (22.0, 4.0, 0.0), 3.0, 2.8)
    human = next(iter(recorder.world.agents.values())).human
    human.data.xfrc_applied[human.index.root, :2] = (-200.0, 700.0)
    recorder.go_on(0.2)
    human.data.xfrc_applied[:] = 0.0
    recorder.go_on(16.0)
    return recorder


def dog() -> Recorder:
    return one_way("dog", (4.0, 26.0, 0.0), (20.0, 31.0, 0.0), 2.5, 9.0)


def dog_in_a_room() -> Recorder:
    return one_way("dog", (2.0, 3.0, 0.0), (6.0, 2.0, 0.0), 1.0, 9.0, "room")


def cat() -> Recorder:
    return one_way("cat", (4.0, 26.0, 0.0), (16.0, 27.0, 0.0), 1.5, 8.0)


def horse() -> Recorder:
    return one_way("horse", (4.0, 27.0, 0.0), (22.0, 24.0, 0.0), 5.0, 6.0)


def crowd() -> Recorder:
    recorder = Recorder(level())
    rng = np.random.default_rng(8)
    graph = recorder.world.graph
    starts = graph.random_points(rng, 60, 0.3, (6.0, 26.0, 0.0))
    goals = graph.random_points(rng, 60, 0.3, (6.0, 26.0, 0.0))
    for start, goal in zip(starts, goals, strict=True):
        recorder.world.spawn("walker", start).go_to(goal, speed=1.4)
    recorder.go_on(10.0)
    return recorder


def giving_way() -> Recorder:
    recorder = Recorder(level())
    recorder.world.spawn("human", (4.0, 27.0, 0.0)).go_to((14.0, 27.0, 0.0), speed=1.5)
    recorder.world.spawn("human", (14.0, 27.0, 0.0)).go_to((4.0, 27.0, 0.0), speed=1.5)
    recorder.world.spawn("dog", (9.0, 31.0, 0.0)).go_to((9.0, 23.0, 0.0), speed=1.5)
    recorder.go_on(8.0)
    return recorder


def change_of_level() -> Recorder:
    recorder = one_way("human", (4.0, 27.0, 0.0), (16.0, 27.0, 0.0), 1.6, 2.0)
    recorder.world.change_level({"wall": box((9.0, 25.0, -0.2), (9.4, 28.5, 2.5))})
    recorder.go_on(8.0)
    return recorder


def save_and_restore() -> Recorder:
    recorder = one_way("human", (6.0, 4.0, 0.0), (32.0, 4.0, 0.3), 3.3, 6.5)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "state.npz"
        recorder.world.save().write(file)
        recorder.world = level()
        recorder.world.restore(WorldState.read(file))
    recorder.go_on(6.0)
    return recorder


RUNS: dict[str, Callable[[], Recorder]] = {
    each.__name__: each
    for each in (
        walk, ramp, run_with_bends, jump, vault, drop_roll, leap, stop_while_running, fall_and_get_up,
        dog, dog_in_a_room, cat, horse, crowd, giving_way, change_of_level, save_and_restore,
    )
}  # fmt: skip


def seen(name: str) -> str:
    """The hash of the run called ``name``."""
    return RUNS[name]().hash


if __name__ == "__main__":
    print(json.dumps({"machine": machine(), "runs": {name: seen(name) for name in RUNS}}, indent=2))
