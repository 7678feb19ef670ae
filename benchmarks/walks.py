"""The learned walk beside the planned one, in the same scenes with the same orders.

    python -m benchmarks.walks [--scenes orders crowd ...] [--trials 20] [--seed 1] [--processes 1]

Worlds with people who walk; in each scene one world has the learned walk (and the planned one where it does
not hold), the other only the planned one:

- orders, orders on rolling ground, orders on steps: a minute of goals, stops and turns at 0.5 to 2 m/s, a new
  one every 1 to 6 s; waves with slopes of up to 0.15; platforms 6 and 12 cm high
- short ways: goals 0.3 to 1.5 m away in any direction, one after the other, for a minute
- kerb: there and back at 0.8 to 4.5 m/s over a kerb of 5 to 15 cm
- slope, stairs: up and down over 2 to 16 degrees; over seven steps of 0.1 to 0.18 m
- rooms: ways through doors 1.2 m wide and around corners
- pushed: a walk with a push of 50 to 200 N for 0.1 s from any side every 2 to 4 s, for half a minute
- pushed where it stands: with 300 N for 0.1 s every 6 s, from twelve sides
- run: runs at 2.5 to 3.5 m/s from a stand and back to one, a stop on the way in a half of them
- orders at a run: a minute of goals and stops at 0.8 to 4 m/s, a new one every 2 to 8 s, on 50 x 50 m
- crowd: 16 people in 12 x 12 m with goals all over it, for half a minute

Printed: falls in all; trials in which somebody fell, in which somebody was stuck or lost, and of how many
all; orders carried out; and how much of the time that somebody walked as learned.
"""

import argparse
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

import navmesh
from benchmarks.workers import add_place, place_of
from locomotion.body.person import CONTROL_DT
from locomotion.ground.ground import extruded
from runtime import Agent, Arrived, Fell, Lost, RuntimeInputError, Stuck, World
from runtime.bodies.kinds.kind import WALKS
from runtime.planning.rules import person_walk_rules
from surefoot.workers.pool import worker_pool

_PUSH, _LIMIT = 0.1, 90.0  # [s] that a push takes, and that a way may take
_HARD = 300.0  # [N]
_NEAR = 0.6  # [m] from the middle of a slope where ways begin and end
Scene = Callable[["Stage", np.random.Generator], None]


@dataclass
class Stage:
    """A world with people of a ``size``, and what has been seen of it: ``falls``; ``arrived``: orders carried
    out; ``stuck``: how often somebody ended stuck or lost; ``walked``: [s] on foot, of which ``learned`` as
    learned."""

    world: World
    size: float = 1.0
    falls: int = 0
    arrived: int = 0
    stuck: int = 0
    walked: float = 0.0
    learned: float = 0.0

    def spawn(self, place: ArrayLike, facing: float) -> Agent:
        """One more person."""
        agent = self.world.spawn("human", place, facing)
        agent.set_style(size=self.size)
        return agent

    def go_on(self, seconds: float, until: Callable[[], bool] = lambda: False) -> None:
        """Let time pass."""
        end = self.world.time + seconds - 1e-9
        while self.world.time < end and not until():
            self.world.step(CONTROL_DT)
            for event in self.world.events:
                self.falls += isinstance(event, Fell)
                self.arrived += isinstance(event, Arrived)
                self.stuck += isinstance(event, (Stuck, Lost))
            for agent in self.world.agents.values():
                feet = agent.human.on_feet
                if agent.moving and feet.walks and not agent.human.fours.active:
                    self.walked += CONTROL_DT
                    self.learned += CONTROL_DT * feet.walks_as_learned

    def go(self, agent: Agent, place: np.ndarray, speed: float, seconds: float = _LIMIT) -> None:
        """Send somebody on a way and wait for the end of it."""
        if agent.status != "fallen":
            agent.go_to(place, speed=speed)
            self.go_on(seconds, lambda: not agent.moving)


def _level(corners: np.ndarray, faces: np.ndarray) -> navmesh.NodeGraph:
    return navmesh.NodeGraph.build(navmesh.Terrain.from_arrays(corners, faces), person_walk_rules())


def _field(side: float, height: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> navmesh.NodeGraph:
    n = round(side / 0.5) + 1
    line = np.linspace(0.0, side, n)
    x, y = (g.ravel() for g in np.meshgrid(line, line, indexing="ij"))
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    a, b, d, e = corner, corner + n, corner + n + 1, corner + 1
    faces = np.concatenate([np.stack([a, b, d], axis=1), np.stack([a, d, e], axis=1)])
    return _level(np.stack([x, y, height(x, y)], axis=1), faces)


def hall(side: float = 12.0) -> navmesh.NodeGraph:
    """A level floor of ``side`` x ``side`` [m]."""
    corners = side * np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.0)])
    return _level(corners, np.array([(0, 1, 2), (0, 2, 3)]))


def rolling() -> navmesh.NodeGraph:
    """Waves in all directions with slopes of up to 0.15."""
    waves = ((0.9, 0.35, 0.4), (-0.4, 0.8, 1.9), (0.55, -0.65, 3.1))

    def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        each = (np.sin(a * x + b * y + c) / math.hypot(a, b) for a, b, c in waves)
        return 0.06 * sum(each, np.zeros_like(x))

    return _field(16.0, height)


def _profile(x: list[float], z: list[float], half_width: float) -> navmesh.NodeGraph:
    return _level(*extruded(np.column_stack([x, z]), half_width))


def platforms() -> navmesh.NodeGraph:
    """Platforms 6 and 12 cm high, 2 m deep, across the way."""
    fronts = np.arange(2.0, 16.0, 2.0)
    heights = [0.0, 0.06, 0.18, 0.12, 0.0, 0.12, 0.06, 0.0]
    x = [0.0, *np.repeat(fronts, 2).tolist(), 18.0]
    return _profile(x, np.repeat(heights, 2).tolist(), 6.0)


def rooms() -> navmesh.NodeGraph:
    """Four rooms of 5 x 5 m joined by doors 1.2 m wide."""
    boxes = [(0, 0, 5, 5), (5.2, 0, 10.2, 5), (0, 5.2, 5, 10.2), (5.2, 5.2, 10.2, 10.2)]
    boxes += [(5, 1.0, 5.2, 2.2), (5, 8, 5.2, 9.2), (1, 5, 2.2, 5.2), (8, 5, 9.2, 5.2)]
    xs, ys = (sorted({float(box[k]) for box in boxes for k in (a, a + 2)}) for a in (0, 1))
    corners = np.array([(x, y, 0.0) for x in xs for y in ys])
    faces = []
    for i in range(len(xs) - 1):
        for j in range(len(ys) - 1):
            x, y = 0.5 * (xs[i] + xs[i + 1]), 0.5 * (ys[j] + ys[j + 1])
            if any(b[0] < x < b[2] and b[1] < y < b[3] for b in boxes):
                a, n = i * len(ys) + j, len(ys)
                faces += [(a, a + n, a + n + 1), (a, a + n + 1, a + 1)]
    return _level(corners, np.array(faces))


def _somewhere(stage: Stage, rng: np.random.Generator, room: float = 0.5) -> np.ndarray:
    graph = stage.world.graph
    return rng.permutation(graph.positions[graph.radii > room])[0]


def _spawn(stage: Stage, rng: np.random.Generator) -> Agent:
    while True:
        try:
            return stage.spawn(_somewhere(stage, rng), float(rng.uniform(-math.pi, math.pi)))
        except RuntimeInputError:  # somebody stands there
            pass


def orders(
    stage: Stage,
    rng: np.random.Generator,
    speeds: tuple[float, float] = (0.5, 2.0),
    apart: tuple[float, float] = (1.0, 6.0),
) -> None:
    """A minute of them, at ``speeds`` [m/s], so far ``apart`` [s]."""
    agent = _spawn(stage, rng)
    while stage.world.time < 60.0:
        if rng.random() < 0.25:
            agent.stop()
        elif agent.status != "fallen":
            agent.go_to(_somewhere(stage, rng), speed=float(rng.uniform(*speeds)))
        stage.go_on(float(rng.uniform(*apart)))


def short_ways(stage: Stage, rng: np.random.Generator) -> None:
    """A minute of them."""
    agent = _spawn(stage, rng)
    while stage.world.time < 60.0 and agent.status != "fallen":
        angle, far = rng.uniform(-math.pi, math.pi), rng.uniform(0.3, 1.5)
        to = agent.position + far * np.array([math.cos(angle), math.sin(angle), 0.0])
        if 0.5 < to[:2].min() and to[:2].max() < 11.5:
            stage.go(agent, to, float(rng.uniform(0.6, 1.4)), 20.0)
            stage.go_on(float(rng.uniform(0.0, 2.0)))


def up_and_down(stage: Stage, rng: np.random.Generator, speeds: tuple[float, float] = (0.8, 1.8)) -> None:
    """From one end to the other and back, at ``speeds`` [m/s]."""
    low, high = stage.world.graph.terrain.bounds
    aside = rng.uniform(-_NEAR, _NEAR, 2)
    ends = [(low[0] + 2.0, aside[0], low[2]), (high[0] - 2.0, aside[1], high[2])]
    agent = stage.spawn(ends[0], float(rng.uniform(-1.0, 1.0)))
    for end in (ends[1], ends[0]):
        stage.go(agent, end, float(rng.uniform(*speeds)))


def ways(stage: Stage, rng: np.random.Generator) -> None:
    """Six of them, all over the level."""
    agent = _spawn(stage, rng)
    for _ in range(6):
        stage.go(agent, _somewhere(stage, rng, 0.4), float(rng.uniform(0.8, 1.8)))


def pushed(stage: Stage, rng: np.random.Generator) -> None:
    """Half a minute, to and fro."""
    agent = _spawn(stage, rng)
    while stage.world.time < 30.0 and agent.status != "fallen":
        if not agent.moving:
            agent.go_to(_somewhere(stage, rng), speed=float(rng.uniform(0.8, 1.4)))
        stage.go_on(float(rng.uniform(2.0, 4.0)))
        side, force = rng.uniform(-math.pi, math.pi), rng.uniform(50.0, 200.0)
        agent.push((force * math.cos(side), force * math.sin(side), 0.0), _PUSH)


def pushed_standing(stage: Stage, rng: np.random.Generator) -> None:
    """A push every 6 s, from twelve directions in any order."""
    agent = stage.spawn((6.0, 6.0, 0.0), float(rng.uniform(-math.pi, math.pi)))
    for side in rng.permutation(12) * math.pi / 6.0:
        stage.go_on(6.0)
        agent.push(_HARD * np.array([math.cos(side), math.sin(side), 0.0]), _PUSH)
    stage.go_on(6.0)


def run(stage: Stage, rng: np.random.Generator) -> None:
    """To the other end and back."""
    agent = stage.spawn((2.0, float(rng.uniform(-3.0, 3.0)), 0.0), float(rng.uniform(-1, 1)))
    for k in range(2):
        if agent.status == "fallen":
            return
        agent.go_to(
            (38.0 if k == 0 else 2.0, float(rng.uniform(-3.0, 3.0)), 0.0), speed=rng.uniform(2.5, 3.5)
        )
        if rng.random() < 0.5:
            stage.go_on(float(rng.uniform(3.0, 8.0)))
            agent.stop()
            stage.go_on(4.0)
        else:
            stage.go_on(_LIMIT, lambda: not agent.moving)


def crowd(stage: Stage, rng: np.random.Generator) -> None:
    """Half a minute."""
    agents = [_spawn(stage, rng) for _ in range(16)]
    due = rng.uniform(0.0, 1.0, len(agents))
    while stage.world.time < 30.0:
        for k, agent in enumerate(agents):
            if (
                stage.world.time >= due[k]
                and not agent.moving
                and agent.status not in ("fallen", "getting up")
            ):
                agent.go_to(_somewhere(stage, rng), speed=float(rng.uniform(0.8, 1.8)))
                due[k] = stage.world.time + float(rng.uniform(1.0, 4.0))
        stage.go_on(0.1)


def _slope(rng: np.random.Generator) -> navmesh.NodeGraph:
    slope = math.tan(math.radians(rng.uniform(2.0, 16.0)))
    return _profile([0, 5, 11, 16.0], [0, 0, 6 * slope, 6 * slope], 2.0)


def _stairs(rng: np.random.Generator) -> navmesh.NodeGraph:
    riser = float(rng.uniform(0.1, 0.18))
    tread, x, z = 0.63 - 2.0 * riser, [0.0], [0.0]
    for k in range(7):
        x += [5.0 + k * tread, 5.0 + k * tread]
        z += [k * riser, (k + 1) * riser]
    return _profile([*x, x[-1] + tread + 5.0], [*z, z[-1]], 2.0)


def _kerb(rng: np.random.Generator) -> navmesh.NodeGraph:
    kerb = float(rng.uniform(0.05, 0.15))
    return _profile([0.0, 15.0, 15.0, 30.0], [0.0, 0.0, kerb, kerb], 3.0)


def _long_hall(rng: np.random.Generator) -> navmesh.NodeGraph:
    return _profile([0.0, 40.0], [0.0, 0.0], 5.0)


SCENES: dict[str, tuple[Callable[[np.random.Generator], navmesh.NodeGraph], Scene]] = {
    "orders": (lambda rng: hall(), orders),
    "orders on rolling ground": (lambda rng: rolling(), orders),
    "orders on steps": (lambda rng: platforms(), orders),
    "short ways": (lambda rng: hall(), short_ways),
    "slope": (_slope, up_and_down),
    "stairs": (_stairs, up_and_down),
    "kerb": (_kerb, partial(up_and_down, speeds=(0.8, 4.5))),
    "rooms": (lambda rng: rooms(), ways),
    "pushed": (lambda rng: hall(), pushed),
    "pushed where it stands": (lambda rng: hall(), pushed_standing),
    "run": (_long_hall, run),
    "orders at a run": (lambda rng: hall(50.0), partial(orders, speeds=(0.8, 4.0), apart=(2.0, 8.0))),
    "crowd": (lambda rng: hall(), crowd),
}
"""What levels and people do in each."""


def play(job: tuple[str, str, int, int]) -> dict[str, Any]:
    """One trial: scene, walk, seed, number."""
    scene, walk, seed, number = job
    make, act = SCENES[scene]
    rng = np.random.default_rng([seed, number])
    stage = Stage(World(make(rng), seed=number, walk=walk))
    act(stage, rng)
    return {
        "falls": stage.falls, "arrived": stage.arrived, "stuck": stage.stuck,
        "learned": stage.learned, "walked": stage.walked, "number": number, "seconds": stage.world.time,
    }  # fmt: skip


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", nargs="+", choices=list(SCENES), default=list(SCENES))
    parser.add_argument("--walks", nargs="+", choices=WALKS, default=list(WALKS))
    parser.add_argument("--trials", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    add_place(parser)
    options = parser.parse_args()
    print(f"{'scene':26} {'walk':8} {'trials':>6} {'falls':>6} {'with falls':>10} {'stuck':>6} {'orders':>7}"
          f" {'learned':>8} {'seconds':>8}")  # fmt: skip
    with worker_pool(place_of(options), int, ()) as workers:
        for scene in options.scenes:
            for walk in options.walks:
                jobs = [(scene, walk, options.seed, k) for k in range(options.trials)]
                rows = list(workers.imap(play, jobs))
                share = sum(row["learned"] for row in rows) / max(sum(row["walked"] for row in rows), 1e-9)
                print(
                    f"{scene:26} {walk:8} {len(rows):6} {sum(row['falls'] for row in rows):6}"
                    f" {sum(row['falls'] > 0 for row in rows):10} {sum(row['stuck'] > 0 for row in rows):6}"
                    f" {sum(row['arrived'] for row in rows):7} {100 * share:6.0f} %"
                    f" {np.mean([row['seconds'] for row in rows]):8.1f}"
                    f"  falls in {[row['number'] for row in rows if row['falls']]}",
                    flush=True,
                )


if __name__ == "__main__":
    from benchmarks.walks import main  # by its name, so that workers find what it sends them

    main()
