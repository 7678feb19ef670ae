"""How long frames take in mixed play, and what an order costs.

    python -m benchmarks.frames [--people 1 10 40] [--dogs 4] [--walkers 20] [--seconds 60] [--seed 1]
                                [--level FILE] [--speed 3] [--rehearsal-ticks 20] [--threads 1]
    python -m benchmarks.frames --changes 8 --level "city 8" --people 0 --dogs 0 [--within 0.5]

People, dogs and walkers get new goals all over a level, are told to stop, and go over to recorded motion and
back, all drawn by the seed. A frame is `World.step(1 / 60)`. Printed for each number of people are the mean,
median, 99th percentile and longest of the frames after the first second, also of their processor time, and of
`go_to`, by body; by how much the world is faster than real time; the ratio of all frames to bare physics:
`mj_step` of the simulated people from the states they were in, sampled during the play and timed in the same
run; the same of those who run on level floors over that on a plane; and the kernels that compiled meanwhile.
Ratios are of processor times, so that they hardly depend on what else runs on the machine. Kernels are loaded
before the play, as a game does with `runtime.prepare`.

With ``--changes``, so many times a chunk of 10 m of a level of `benchmarks.large_levels` is taken out and put
back: at once, then within so many seconds of the world's time, by turns. Printed is the longest frame from
the call until 0.2 s after the change (the call counts as part of its frame), and the longest of as many
frames without any: median and worst of all, by the clock and by processor time of the world's own thread.
Frames come 60 times a second, as in a game.
"""

import argparse
import time
from dataclasses import dataclass, field

import numpy as np

import navmesh
from benchmarks.bare_physics import tick_alone, tick_on_a_plane_instead
from benchmarks.large_levels import LARGE_LEVELS, large_level
from locomotion import Human
from locomotion.body.person import CONTROL_DT
from locomotion.rehearsal.sharing import REHEARSAL_TICKS
from navmesh.level.chunks import chunks_of, join_chunks, split_terrain
from runtime import RuntimeInputError, World, prepare
from runtime.world.agent import Agent
from surefoot.compile_notice import counted

FRAME = 1.0 / 60.0
_ORDERS = 0.15  # [1/s] new goals of each
_STOPS = 0.02  # [1/s]
_LEVELS = 0.02  # [1/s] of people, to recorded motion or back
_ROOMY = 0.45  # [m] radius of the discs that goals are in
_BEGIN = 1.0  # [s] that do not count
_AFTER = 0.2  # [s] after a change that count as around it
_CHUNK = 10.0  # [m]
_SAMPLES = 0.25  # [s] between states whose bare physics is timed


@dataclass
class Times:
    """What was measured. ``frames``, ``spent``: [s] each, by the clock and of processor time. ``orders``: of
    each kind of body, [s] each. ``bare``: [s] of processor time of the ticks of bare physics that all frames
    contain; ``running``: of such ticks of some who run, and with a plane under them instead. ``compiled``:
    kernels."""

    frames: list[float] = field(default_factory=list)
    spent: list[float] = field(default_factory=list)
    orders: dict[str, list[float]] = field(default_factory=dict)
    bare: float = 0.0
    running: list[tuple[float, float]] = field(default_factory=list)
    compiled: int = 0


@dataclass
class Around:
    """The longest frames [s] around changes of the level, by the clock and by processor time of the world's
    thread: of changes ``at_once``, of those ``within`` some time, and ``without`` any."""

    at_once: list[tuple[float, float]] = field(default_factory=list)
    within: list[tuple[float, float]] = field(default_factory=list)
    without: list[tuple[float, float]] = field(default_factory=list)


class Play:
    """A world with ``people``, ``dogs`` and ``walkers``, who are told to go about at ``speed`` [m/s]."""

    def __init__(
        self,
        graph: navmesh.NodeGraph,
        counts: dict[str, int],
        speed: float,
        seed: int,
        rehearsal_ticks: int = REHEARSAL_TICKS,
        threads: int = 1,
    ) -> None:
        self.world = World(graph, seed, rehearsal_ticks=rehearsal_ticks, threads=threads)
        self._rng = np.random.default_rng(seed)
        self._speeds = {"human": speed, "dog": 2.0, "walker": 1.4}
        self._places = graph.positions[graph.radii > _ROOMY]
        self.times = Times()
        for body, count in counts.items():
            for _ in range(count):
                self._spawn(body)

    def _place(self) -> np.ndarray:
        return self._places[self._rng.integers(len(self._places))]

    def _spawn(self, body: str) -> None:
        for _ in range(200):
            try:
                self.world.spawn(body, self._place(), float(self._rng.uniform(-3.0, 3.0)))
                return
            except RuntimeInputError:  # somebody is there already
                continue
        raise SystemExit(f"there is no room for another {body}")

    def go_on(self, seconds: float) -> None:
        """Play, and measure."""
        due = 0.0
        with counted(lambda count: setattr(self.times, "compiled", count)):
            for agent in self.world.agents.values():
                self._order(agent)
            while self.world.time < seconds:
                self._tell()
                begun, spent = time.perf_counter(), time.process_time()
                self.world.step(FRAME)
                passed, spent = time.perf_counter() - begun, time.process_time() - spent
                if self.world.time > _BEGIN:
                    self.times.frames.append(passed)
                    self.times.spent.append(spent)
                    if self.world.time >= due:
                        self._time_bare(self.world.time - max(due - _SAMPLES, _BEGIN))
                        due = self.world.time + _SAMPLES

    def change(self, chunks: dict[str, navmesh.Terrain], times: int, within: float) -> Around:
        """Take chunks out and put them back, so many times each way and of each kind, and measure."""
        around, names = Around(), sorted(chunks)
        self.go_on(_BEGIN)
        for turn in range(-1, times):
            for found, limit in ((around.at_once, 0.0), (around.within, within)):
                name = names[self._rng.integers(len(names))]
                for mesh in (None, chunks[name]):
                    without = self._longest(None, limit)
                    changed = self._longest({name: mesh}, limit)
                    if turn >= 0:  # the first pays for compiling
                        around.without.append(without)
                        found.append(changed)
        return around

    def _longest(
        self, changes: dict[str, navmesh.Terrain | None] | None, within: float
    ) -> tuple[float, float]:
        """The longest frame [s] from a call for ``changes``, if any, until some time after it; see
        `Around`."""
        frames = []
        for number in range(round((within + _AFTER) / FRAME)):
            self._tell()
            begun, spent = time.perf_counter(), time.thread_time()
            if changes and number == 0:
                self.world.change_level(changes, within)
            self.world.step(FRAME)
            passed, spent = time.perf_counter() - begun, time.thread_time() - spent
            frames.append((passed, spent))
            time.sleep(max(FRAME - passed, 0.0))
        passed, spent = np.array(frames).max(axis=0).tolist()
        return passed, spent

    def _tell(self) -> None:
        for agent in self.world.agents.values():
            chance = float(self._rng.random()) / FRAME
            if chance < _ORDERS:
                self._order(agent)
            elif chance < _ORDERS + _STOPS:
                agent.stop()
            elif chance < _ORDERS + _STOPS + _LEVELS and agent.body == "human":
                agent.detail = "full" if agent.detail == "physics" else "physics"

    def _order(self, agent: Agent) -> None:
        if agent.status == "fallen":
            return
        goal, speed = self._place(), self._speeds[agent.body]
        begun = time.perf_counter()
        try:
            agent.go_to(goal, speed=speed)
        except RuntimeInputError:
            return
        passed = time.perf_counter() - begun
        if self.world.time > _BEGIN:
            self.times.orders.setdefault(agent.body, []).append(passed)

    def _time_bare(self, covers: float) -> None:
        """Add the time of bare physics of ``covers`` [s] of the people as they are now."""
        for agent in self.world.agents.values():
            human = agent.driver.simulated
            if not isinstance(human, Human) or human.held:
                continue
            self.times.bare += tick_alone(human) * covers / CONTROL_DT
            running = tick_on_a_plane_instead(human)
            if running is not None:
                self.times.running.append(running)


def told(name: str, seconds: list[float]) -> str:
    """Mean, median, 99th percentile and longest in a line."""
    if not seconds:
        return f"{name}: none"
    each = 1000.0 * np.array(seconds)
    middle = float(np.median(each))
    return (
        f"{name}: mean {each.mean():.2f}, median {middle:.2f}, p99 {np.quantile(each, 0.99):.2f}, longest "
        f"{each.max():.2f} ms of {len(each)}; p99 {np.quantile(each, 0.99) / middle:.1f} x, longest "
        f"{each.max() / middle:.1f} x the median"
    )


def told_around(name: str, longest: list[tuple[float, float]]) -> str:
    """Median and worst of the longest frames, by the clock and by processor time."""
    median, worst = 1000.0 * np.median(longest, axis=0), 1000.0 * np.max(longest, axis=0)
    return (
        f"{name:24} longest frame, median {median[0]:6.1f}, worst {worst[0]:6.1f} ms; of processor time "
        f"{median[1]:6.1f}, {worst[1]:6.1f} ms ({len(longest)} times)"
    )


def measured(
    graph: navmesh.NodeGraph,
    counts: dict[str, int],
    speed: float,
    seconds: float,
    seed: int,
    rehearsal_ticks: int = REHEARSAL_TICKS,
    threads: int = 1,
) -> Times:
    """Play for so long."""
    play = Play(graph, counts, speed, seed, rehearsal_ticks, threads)
    play.go_on(seconds)
    return play.times


def main() -> None:
    """Print all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--people", type=int, nargs="+", default=[1, 10, 40])
    parser.add_argument("--dogs", type=int, default=4)
    parser.add_argument("--walkers", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--speed", type=float, default=3.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rehearsal-ticks", type=int, default=REHEARSAL_TICKS, help="as of World")
    parser.add_argument("--threads", type=int, default=1, help="as of World")
    parser.add_argument("--level", default="examples/levels/courtyard.obj")
    parser.add_argument("--up", default="z")
    parser.add_argument("--changes", type=int, default=0, help="of a level such as 'city 8'")
    parser.add_argument("--within", type=float, default=0.5, help="[s] as of World.change_level")
    asked = parser.parse_args()
    kind, _, size = asked.level.partition(" ")
    if kind in LARGE_LEVELS:
        terrain = join_chunks(split_terrain(large_level(kind, int(size), asked.seed), _CHUNK), asked.level)
    else:
        terrain = navmesh.Terrain.load(asked.level, up=asked.up)
    graph = navmesh.NodeGraph.build(terrain)
    prepare()
    for people in asked.people:
        counts = {"human": people, "dog": asked.dogs, "walker": asked.walkers}
        if asked.changes:
            play = Play(graph, counts, asked.speed, asked.seed, asked.rehearsal_ticks)
            around = play.change(chunks_of(terrain), asked.changes, asked.within)
            print(f"{people} people, {asked.dogs} dogs, {asked.walkers} walkers, {asked.level}")
            print(told_around("  no change", around.without))
            print(told_around("  changed at once", around.at_once))
            print(told_around(f"  changed within {asked.within:g} s", around.within))
            continue
        times = measured(
            graph, counts, asked.speed, asked.seconds, asked.seed, asked.rehearsal_ticks, asked.threads
        )
        print(f"{people} people, {asked.dogs} dogs, {asked.walkers} walkers, {asked.seconds:g} s")
        print(told("  frames", times.frames))
        print(told("  frames by processor time", times.spent))
        for body, orders in times.orders.items():
            print(told(f"  go_to of a {body}", orders))
        passed, spent = len(times.frames) * FRAME, sum(times.spent)
        print(
            f"  real time: {passed / sum(times.frames):.2f} x by the clock, {passed / spent:.2f} x by "
            f"processor time ({asked.threads} threads)"
        )
        print(f"  world.step over bare mj_step: {spent / max(times.bare, 1e-9):.2f}")
        if times.running:
            here, plane = np.sum(times.running, axis=0)
            told_plane = f"{here / plane:.2f} ({len(times.running)} ticks)"
            print(f"  mj_step of runners, over the same steps on a plane: {told_plane}")
        print(f"  kernels compiled: {times.compiled}")


if __name__ == "__main__":
    main()
