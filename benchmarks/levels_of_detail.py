"""People at several levels of detail: switching between them, and what a frame of a thousand costs.

    python -m benchmarks.levels_of_detail [--switches 1000] [--seconds 20] [--seed 1] [--only switches|frame]
    python -m benchmarks.levels_of_detail --only switches --modes vault roll

Switches: a person stands, walks or runs over a plain, or has just jumped, vaulted or rolled, plays recorded
motion or is simulated, and is told to go over to the other at a random moment. Printed are the greatest jump
of the pose then; the greatest step of a joint and of the root between two frames of 1/60 s in the half second
after it, and, for comparison, in the half second before it, since knees bend by more than 10 degrees between
two frames of any walk; and how many have not fallen 5 s later.

Frame: 10 simulated people, 90 in full, 300 in medium and 600 in low detail walk between random places of the
shared level nav_test, or of a plain where it is absent. A frame is 1/60 s of the world, which is one tick or
two, and the transforms of those whose turn it is: of people in full detail and of simulated ones always, in
medium detail 30 times and in low detail 15 times a second. Times are of one core. Printed besides: what
posing all of them would take, and what MuJoCo takes for the physics of the simulated people alone, below
which a frame cannot come.
"""

import argparse
import gc
import math
import time
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import pairwise

import mujoco
import numpy as np

from benchmarks.giving_way import floor
from benchmarks.shared_data import level_path, shared_folder, why_absent
from locomotion.body.person import STEPS_PER_TICK
from locomotion.recorded_people.fading import difference
from locomotion.skills.course import make_course
from navmesh import NodeGraph, Terrain
from runtime import Agent, Fell, SkillFinished, World
from runtime.bodies.human_driver import HumanDriver
from runtime.planning.rules import person_walk_rules
from runtime.world.level_of_detail import LEVELS, PHYSICS
from surefoot.progress import Progress

__all__ = ["COUNTS", "MODES", "SKILLS", "frame_figures", "switch_figures"]

FRAME = 1.0 / 60.0
MODES = {"stand": (0.0, 0.0), "walk": (0.5, 1.9), "run": (2.6, 4.6)}
"""[m/s] least and greatest speed."""
SKILLS = {"jump": ("jump", 0.3, 0.5), "vault": ("vault", 0.65, 0.9), "roll": ("drop", 1.1, 1.8)}
"""Obstacles that are cleared before, and least and greatest size [m] of these."""
COUNTS = (10, 90, 300, 600)
"""People at each of `LEVELS`."""
_PLAIN = (-5.0, -40.0, 120.0, 40.0)


def pose_of(agent: Agent) -> np.ndarray:
    """(46,) as it is drawn."""
    driver = agent.driver
    return driver.look.pose() if isinstance(driver, HumanDriver) else driver.person.qpos  # type: ignore[attr-defined]


def steps(poses: list[np.ndarray]) -> tuple[float, float]:
    """Greatest step of a joint [degrees] and of the root [m] between poses. A hinge at π and one at -π are in
    the same place."""
    moved = np.array([difference(b, a) for a, b in pairwise(poses)])
    turned = (moved[:, 6:] + math.pi) % (2.0 * math.pi) - math.pi
    return float(np.degrees(np.abs(turned).max())), float(np.linalg.norm(moved[:, :3], axis=1).max())


def setting(mode: str, rng: np.random.Generator) -> tuple[NodeGraph, np.ndarray, float]:
    """The level of a switch, the goal and the speed there."""
    if mode in SKILLS:
        kind, low, high = SKILLS[mode]
        course = make_course([(kind, float(rng.uniform(low, high)), 0.3)], [14.0])
        terrain = Terrain.from_arrays(course.vertices, course.faces)
        return NodeGraph.build(terrain, person_walk_rules()), course.path[-1], 3.5
    low, high = MODES[mode]
    angle = float(rng.uniform(-0.5, 0.5))
    goal = np.array([100.0 * math.cos(angle), 60.0 * math.sin(angle), 0.0])
    return plain(), goal, float(rng.uniform(low, high))


@lru_cache(maxsize=1)
def plain() -> NodeGraph:
    """A level without anything."""
    return floor(_PLAIN)


def switch(mode: str, to: str, rng: np.random.Generator) -> dict[str, float]:
    """One person goes over to the level ``to`` at a random moment."""
    graph, goal, speed = setting(mode, rng)
    world = World(graph, seed=int(rng.integers(2**31)))
    ada = world.spawn("human", (0.0, 0.0, 0.0), detail="full" if to == PHYSICS else PHYSICS)
    if speed > 0.0:
        ada.go_to(goal, speed=speed)
    if mode in SKILLS:
        while not any(isinstance(event, SkillFinished) for event in world.events) and world.time < 20.0:
            world.step(0.1)
        world.step(float(rng.uniform(0.0, 0.5)))
    else:
        world.step(float(rng.uniform(3.0, 5.0)))
    before = _frames(world, ada, 30)
    last = pose_of(ada)
    asked = world.time
    ada.detail = to
    while ada.level != to and world.time < asked + 2.0:
        world.step(FRAME)
        last = before[-1]
        before.append(pose_of(ada))
    jump = difference(pose_of(ada), last) if ada.level == to and world.time == asked else np.zeros(45)
    after = [pose_of(ada), *_frames(world, ada, 30)]
    world.step(5.0)
    here, there = steps(before[-30:]), steps(after)
    return {
        "switched": float(ada.level == to),
        "waited": world.time - asked - 5.5,
        "jump": float(np.degrees(np.abs(jump[6:]).max())),
        "jump_root": float(np.linalg.norm(jump[:3])),
        "joint_before": here[0],
        "joint_after": there[0],
        "root_before": here[1],
        "root_after": there[1],
        "up": float(not any(isinstance(event, Fell) for event in world.events)),
    }


def _frames(world: World, agent: Agent, count: int) -> list[np.ndarray]:
    poses = []
    for _ in range(count):
        world.step(FRAME)
        poses.append(pose_of(agent))
    return poses


def switch_figures(
    count: int, seed: int, modes: Sequence[str] = (*MODES, *SKILLS), progress: Progress | None = None
) -> Iterator[tuple[str, str, dict[str, float]]]:
    """Of each of ``modes`` and each direction, as soon as they are made: how many switched and stayed up; the
    worst of the rest. ``count`` is of all together. A mode's switches are the same whichever modes are asked
    for."""
    progress = progress or Progress(shown=False)
    cases = [(mode, to) for mode in modes for to in (PHYSICS, "full")]
    for k, (mode, to) in enumerate(cases):
        of = len(range(k, count, len(cases)))
        rng = np.random.default_rng((seed, [*MODES, *SKILLS].index(mode), to == PHYSICS))
        made = []
        with progress.stage(f"{mode} to {to}") as stage:
            for number in range(of):
                made.append(switch(mode, to, rng))
                stage.update((number + 1) / of, f"{sum(each['up'] for each in made):.0f} up")
        if made:
            worst = {name: max(each[name] for each in made) for name in made[0]}
            sums = {name: sum(each[name] for each in made) for name in ("switched", "up")}
            yield mode, to, {**worst, **sums, "count": of}


def frame_figures(graph: NodeGraph, counts: tuple[int, ...], seconds: float, seed: int) -> dict[str, float]:
    """Times [ms] of frames of people at ``counts`` (of each of `LEVELS`) for ``seconds``."""
    world, rng = World(graph, seed=seed), np.random.default_rng(seed)
    tries = graph.random_points(rng, 50, 0.3)
    reach = [len(graph.reachable_nodes(place, 0.3)) for place in tries]
    home = tries[int(np.argmax(reach))]
    places = iter(graph.random_points(rng, 4 * sum(counts) + 2000, 0.3, reachable_from=home))
    for level, count in zip(LEVELS, counts, strict=True):
        for _ in range(count):
            world.spawn("human", next(places), detail=level)
    agents = list(world.agents.values())
    for agent in agents:
        agent.go_to(next(places), speed=float(rng.uniform(0.8, 1.6)))
    world.step(1.0)
    world.transforms()
    total, moving, everybody = [], [], []
    gc.collect()
    gc.freeze()
    for frame in range(round(seconds / FRAME)):
        begin, drawn = time.process_time(), world.time
        world.step(FRAME)
        stepped = time.process_time()
        world.transforms(since=drawn)
        total.append(time.process_time() - begin)
        moving.append(stepped - begin)
        if frame % 10 == 0:
            begin = time.process_time()
            world.transforms()
            everybody.append(time.process_time() - begin)
        for agent in agents[frame % 30 :: 30]:
            if not agent.moving and agent.status != "fallen":
                agent.go_to(next(places), speed=float(rng.uniform(0.8, 1.6)))
    gc.unfreeze()
    ms = 1000.0 * np.array(total)
    physics = mujoco_seconds(agents[: counts[0]])
    return {
        "median": float(np.median(ms)),
        "p99": float(np.percentile(ms, 99)),
        "worst": float(ms.max()),
        "posing": float(1000.0 * np.median(np.array(total) - np.array(moving))),
        "posing_all": float(1000.0 * np.median(everybody)),
        "physics": 2000.0 * physics,
        "share_moving": float(np.mean([agent.moving for agent in agents])),
    }


def mujoco_seconds(agents: Sequence[Agent]) -> float:
    """[s] that MuJoCo takes for a tick of all of ``agents``, who are simulated, as they are now."""
    taken = []
    for _ in range(9):
        begin = time.process_time()
        for agent in agents:
            simulation = agent.human.simulation
            mujoco.mj_step(simulation.model, simulation.data, STEPS_PER_TICK)
        taken.append(time.process_time() - begin)
    return float(np.median(taken))


def level() -> NodeGraph:
    """nav_test, or a plain."""
    if shared_folder() is None:
        print(f"{why_absent()}; on a plain instead")
        return floor((0.0, 0.0, 90.0, 90.0))
    terrain = Terrain.load(level_path("nav_test"), up="y")
    return NodeGraph.build(terrain, person_walk_rules())


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--switches", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", choices=("switches", "frame"))
    parser.add_argument("--modes", nargs="+", choices=(*MODES, *SKILLS), default=(*MODES, *SKILLS))
    given = parser.parse_args()
    if given.only != "frame":
        for mode, to, of in switch_figures(given.switches, given.seed, given.modes, Progress()):
            print(
                f"{mode:6} to {to:8} {of['switched']:.0f} of {of['count']:.0f} within {of['waited']:.2f} s; "
                f"jump {of['jump']:.1e} degrees, {100 * of['jump_root']:.1e} cm; joint step "
                f"{of['joint_after']:.1f} (before {of['joint_before']:.1f}) degrees; root step "
                f"{100 * of['root_after']:.1f} (before {100 * of['root_before']:.1f}) cm; up {of['up']:.0f}",
                flush=True,
            )
    if given.only != "switches":
        of = frame_figures(level(), COUNTS, given.seconds, given.seed)
        people = " + ".join(f"{count} {name}" for name, count in zip(LEVELS, COUNTS, strict=True))
        print(
            f"{people}: a frame takes {of['median']:.1f} ms (median), {of['p99']:.1f} ms (p99), "
            f"{of['worst']:.1f} ms (worst), posing {of['posing']:.2f} ms of it; "
            f"{of['share_moving']:.0%} move; posing all takes {of['posing_all']:.2f} ms; "
            f"MuJoCo's share of a frame of two ticks is {of['physics']:.1f} ms"
        )


if __name__ == "__main__":
    main()
