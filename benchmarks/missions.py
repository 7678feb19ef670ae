"""Missions between random reachable points: arrivals, distance from the path, and cost.

    python -m benchmarks.missions [--levels undulating courtyard] [--missions 50] [--speed 3.0]
        [--walk planned] [--json FILE] [--processes 1] [--cluster ADDRESS]

For each level the graph is built with a person's rules (`locomotion.PERSON_RULES`), start and goal are drawn
from its nodes, 10 to 60 m of route apart, and a person in a `runtime.World` is sent there from standing. The
table says how many arrive (within 60 s plus 10 s per metre: enough for hands and feet at 0.1 m/s), how often
they fell and got up, how many paths they took, and what stopped the others; JSON holds every mission. A
person that a fall has moved by more than 0.5 m, or that is stuck, takes a new path from where it is.
"lateral" is its distance from its present path while it moves on it, not while it gets up; "unfallen" the
same until its first fall. "in walls": missions in which a bone (the line between two joints) went through the
level's surface by more than the radius of a hand (2.8 cm), measured to its nearer joint or to the edge that
it passes; less is normal, since soft contacts yield. Then the longest mission is timed, alternating whole
ticks with bare physics under the same controls: "control", "rehearsal" and "planning" are costs on top of
bare physics, "all" their sum.

Hardly any ground of undulating is within a person's slope limit (7 % below 20 degrees; it falls into patches
of 4 m), so the limit there is 45 degrees; steps of 0.2 m between such slopes are too much for people (87 of
100 arrive), so the step limit there is 0.15 m.
"""

import argparse
import itertools
import json
import math
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

import navmesh
from benchmarks.shared_data import LEVELS, level_path, shared_folder, why_absent
from benchmarks.workers import add_place, place_of
from locomotion import MOVING, PERSON_RULES, Human, smooth_route
from locomotion.body.arm_reach import HAND_RADIUS
from locomotion.body.person import CONTROL_DT, STEPS_PER_TICK
from locomotion.body.physics import restore_physics, save_physics
from locomotion.paths.tracking import make_path
from navmesh.level.mesh_queries import MeshGrid, brute_crossed, crossed
from runtime import World
from runtime.bodies.kinds.kind import WALKS
from runtime.events import Departed, Fell
from runtime.world.state import WorldState
from surefoot.workers.pool import worker_pool

OWN_LEVELS = Path(__file__).resolve().parents[1] / "examples" / "levels"
LENGTHS = (10.0, 60.0)
REPEATS, MOST_TICKS = 3, 4000
LOOKS = 5  # ticks between two looks at where the bones are
TIME_LIMIT = 60.0, 10.0  # [s], and [s] more per metre of route
STEEP_RULES = {"undulating": {"max_slope": math.radians(45.0), "max_step": 0.15}}


def load_level(name: str) -> navmesh.Terrain:
    """One of the shared levels, or one of ours in examples/levels."""
    own = OWN_LEVELS / f"{name}.obj"
    if own.exists():
        return navmesh.Terrain.load(own, up="z")
    return navmesh.Terrain.load(level_path(name), up="y")


def level_rules(name: str) -> navmesh.WalkRules:
    """A person's rules, or those of a level that they hardly leave a place on."""
    rules = {key: PERSON_RULES[key] for key in ("headroom", "max_slope", "max_step")}
    return navmesh.WalkRules(**{**rules, **STEEP_RULES.get(name, {})})


def random_routes(graph: navmesh.NodeGraph, count: int, seed: int) -> list:
    """``count`` complete routes between nodes that a person fits in."""
    rng = np.random.default_rng(seed)
    roomy = np.flatnonzero(graph.radii > PERSON_RULES["radius"] + 0.1)
    routes: list = []
    for _ in range(200 * count):
        start, goal = graph.positions[rng.choice(roomy, 2)]
        route = graph.find_path(start, goal, radius=PERSON_RULES["radius"])
        if route.status == "complete" and LENGTHS[0] <= route.length <= LENGTHS[1]:
            routes.append(route)
            if len(routes) == count:
                return routes
    raise SystemExit(f"only {len(routes)} routes of {LENGTHS} m found")


def depth_through(triangles: np.ndarray, a: np.ndarray, b: np.ndarray) -> float:
    """How far [m] the line from ``a`` to ``b``, each (3,), goes through any of the prepared ``triangles``
    (t, 15), and would have to be moved to be out: the distance of the end that is nearer to its plane or,
    where the line comes out again through another one, of the edge between the two, 0 where the line meets
    none."""
    corners = triangles[:, :9].reshape(-1, 3, 3)
    meet = (corners.max(1) >= np.minimum(a, b)) & (corners.min(1) <= np.maximum(a, b))
    rows = [row for row in triangles[meet.all(1)] if brute_crossed(row[None], a, b)]
    if not rows:
        return 0.0
    p, q, r = np.array(rows)[:, :9].reshape(-1, 3, 3).transpose(1, 0, 2)
    normals = np.cross(q - p, r - p)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    offsets, along = (normals * p).sum(axis=1), b - a
    depths = np.abs(np.array([a, b]) @ normals.T - offsets).min(axis=0)
    for i, j in itertools.combinations(range(len(rows)), 2):
        edge = np.cross(normals[i], normals[j])
        across = np.cross(edge, along)
        if (normals[i] @ along) * (normals[j] @ along) < 0.0 and across.any():
            on_edge = np.linalg.lstsq(normals[[i, j]], offsets[[i, j]], rcond=None)[0]
            beside = abs((a - on_edge) @ across) / np.linalg.norm(across)
            depths[[i, j]] = np.minimum(depths[[i, j]], beside)
    return float(depths.max())


def pierces(human: Human, mesh_grid: MeshGrid, origin: np.ndarray) -> bool:
    """Whether any bone of a person goes through a triangle of the level, by more than contacts press it
    in."""
    joints, parents = human.body_transforms()[:, :3] - origin, human.model.body_parentid
    return any(
        crossed(mesh_grid.arrays, *a, *b) and depth_through(mesh_grid.triangles, a, b) > HAND_RADIUS
        for a, b in ((joints[parents[k]], joints[k]) for k in np.flatnonzero(parents > 0))
    )


@dataclass(frozen=True)
class Stage:
    """A level with all ways that people are sent, and the world in which that is done, as it was at first."""

    graph: navmesh.NodeGraph
    routes: list
    world: World
    fresh: WorldState
    mesh_grid: MeshGrid
    origin: np.ndarray

    @classmethod
    def of(cls, name: str, missions: int, seed: int, walk: str) -> "Stage":
        terrain, rules = load_level(name), level_rules(name)
        graph = navmesh.NodeGraph.build(terrain, rules)
        world, origin = World(graph, walk=walk), terrain.bounds[0] - 1.0
        grid = MeshGrid(terrain.vertices, terrain.faces, origin, rules.max_slope)
        return cls(graph, random_routes(graph, missions, seed), world, world.save(), grid, origin)


_stage: Stage | None = None  # of a worker
_speed = 0.0


def _begin(name: str, missions: int, seed: int, walk: str, speed: float) -> None:
    global _stage, _speed
    _stage, _speed = Stage.of(name, missions, seed, walk), speed


def _run(number: int) -> dict[str, Any]:
    assert _stage is not None
    return run_mission(_stage, _stage.routes[number], _speed)


def run_mission(stage: Stage, route: Any, speed: float) -> dict[str, Any]:
    """Send a person along one route; returns what happened. It is the same whatever was done before."""
    world = stage.world
    world.restore(stage.fresh)
    path = smooth_route(route)
    facing = math.atan2(*(path.points[1] - path.points[0])[1::-1])
    agent = world.spawn("human", path.points[0], facing)
    begun, events = world.time, world.events
    agent.go_to(path.points[-1], speed)
    lateral: list[float] = []
    unfallen: list[float] = []
    in_walls, ticks = False, 0
    limit = TIME_LIMIT[0] + TIME_LIMIT[1] * route.length
    while agent.moving and world.time - begun < limit:
        world.step(CONTROL_DT)
        events += world.events
        ticks += 1
        in_walls = in_walls or (ticks % LOOKS == 0 and pierces(agent.human, stage.mesh_grid, stage.origin))
        if agent.status != "getting up":
            lateral.append(abs(agent.human.lateral_error))
            if not any(isinstance(event, Fell) for event in events):
                unfallen.append(lateral[-1])
    rise = np.abs(np.diff(path.points[:, 2])) / np.maximum(
        np.linalg.norm(np.diff(path.points[:, :2], axis=0), axis=1), 1e-6
    )
    result = {
        "status": "out of time" if agent.moving else agent.status,
        "falls": sum(isinstance(event, Fell) for event in events),
        "ways": sum(isinstance(event, Departed) for event in events),
        "in_walls": in_walls,
        "start": path.points[0].round(3).tolist(),
        "goal": path.points[-1].round(3).tolist(),
        "length": round(route.length, 2),
        "bounded": path.bounded,
        "steepest_deg": round(float(np.degrees(np.arctan(np.percentile(rise, 95)))), 1),
        "time": round(world.time - begun, 2),
        "event": events[-1].to_dict(),
        "lateral": lateral,
        "unfallen": unfallen,
    }
    agent.remove()
    return result


def cost_of_control(human: Human, route: Any, speed: float) -> dict[str, float]:
    """What a person costs on its way on top of bare physics, as shares of the latter: "control" of one that
    does not rehearse, "rehearsal" what the rehearsals of one that does add, "planning" (A*, pulling,
    smoothing, the speeds along the path) of the way once, spread over its ticks.
    """
    planning = math.inf
    for _ in range(REPEATS):
        begun = time.thread_time()
        path = smooth_route(route.graph.find_path(*route.waypoints[[0, -1]], radius=PERSON_RULES["radius"]))
        make_path(path.points, speed, human.on_feet.limits, 0.0)
        planning = min(planning, time.thread_time() - begun)
    policy = None if human.on_feet.learned is None else human.on_feet.learned.skill
    whole, bare, ticks = time_ticks(human, path.points, speed)
    alone, bare_alone, _ = time_ticks(
        Human(human.ground, rehearsals=0, gets_up=True, policy=policy), path.points, speed
    )
    control, all_ticks = alone / bare_alone - 1.0, whole / bare - 1.0
    return {
        "ticks": ticks,
        "tick_us": 1e6 * whole / ticks,
        "physics_us": 1e6 * bare / ticks,
        "control": control,
        "rehearsal": all_ticks - control,
        "planning": planning / bare,
        "share": all_ticks + planning / bare,
        "real_time": ticks * CONTROL_DT / (whole + planning),
    }


def time_ticks(human: Human, path: np.ndarray, speed: float) -> tuple[float, float, int]:
    """CPU time [s] of the whole ticks of a way (at most `MOST_TICKS`), and of bare physics under the same
    controls from the same state; and how many ticks.

    Both do the same a few times in turns, and the fastest counts, so that what else runs on the machine does
    not. That the bare physics did what the person did is checked to the last bit.
    """
    human.reset(path[0], math.atan2(*(path[1] - path[0])[1::-1]))
    human.follow(path, speed)
    saved, begin = human.save_state(), save_physics(human.model, human.data)
    steps: list[tuple[mujoco.MjModel, np.ndarray]] = []
    while human.status in MOVING and len(steps) < MOST_TICKS:
        crawls = human.fours.active
        human.tick()  # on hands and feet it may find other ground first, and be moved by another model
        steps.append((human.fours.model if crawls else human.model, human.data.ctrl.copy()))
    twin = mujoco.MjData(human.model)
    whole = bare = math.inf
    for _ in range(REPEATS):
        human.restore_state(saved)
        begun = time.thread_time()
        for _ in steps:
            human.tick()
        whole = min(whole, time.thread_time() - begun)
        restore_physics(human.model, twin, begin)
        begun = time.thread_time()
        for model, control in steps:
            twin.ctrl[:] = control
            mujoco.mj_step(model, twin, STEPS_PER_TICK)
        bare = min(bare, time.thread_time() - begun)
        if not np.array_equal(save_physics(human.model, twin), save_physics(human.model, human.data)):
            raise SystemExit("the bare physics is not what the person did: the comparison means nothing")
    return whole, bare, len(steps)


def report_on(name: str, options: argparse.Namespace) -> dict[str, Any]:
    """All missions on one level, and what a tick costs there."""
    asked = name, options.missions, options.seed, options.walk
    stage = Stage.of(*asked)
    with worker_pool(place_of(options), _begin, (*asked, options.speed)) as workers:
        results = list(workers.imap(_run, range(options.missions)))
    lateral, unfallen = (
        np.concatenate([result.pop(name) for result in results]) for name in ("lateral", "unfallen")
    )
    human = stage.world.spawn("human", stage.routes[0].waypoints[0]).human
    return {
        "missions": results,
        "arrived": sum(r["status"] == "arrived" for r in results),
        "falls": sum(r["falls"] for r in results),
        "ways": sum(r["ways"] for r in results),
        "in_walls": sum(r["in_walls"] for r in results),
        "lateral_p95": float(np.percentile(lateral, 95)),
        "lateral_max": float(lateral.max()),
        "unfallen_p95": float(np.percentile(unfallen, 95)),
        "stopped_by": dict(Counter(r["status"] for r in results if r["status"] != "arrived")),
        "cost": cost_of_control(human, max(stage.routes, key=lambda r: r.length), options.speed),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--levels", nargs="+", default=["undulating", "courtyard"])
    parser.add_argument("--missions", type=int, default=50)
    parser.add_argument("--speed", type=float, default=3.0, help="wished speed [m/s]")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--walk", default=WALKS[0], choices=WALKS, help="as of World")
    parser.add_argument("--json", type=Path, help="write every mission here")
    add_place(parser)
    options = parser.parse_args()
    report: dict[str, Any] = {"speed": options.speed, "seed": options.seed, "levels": {}}
    print(
        f"{'level':12} {'arrive':>8} {'falls':>6} {'ways':>5} {'in walls':>9} {'lateral p95':>12} "
        f"{'unfallen':>9} {'control':>8} {'rehearsal':>10} {'planning':>9} {'all':>7} {'real time':>10}  "
        "stopped by"
    )
    for name in options.levels:
        if name in LEVELS and shared_folder() is None:
            print(f"{name:12} skipped: {why_absent()}")
            continue
        result = report_on(name, options)
        report["levels"][name] = result
        arrived, cost = f"{result['arrived']}/{len(result['missions'])}", result["cost"]
        print(
            f"{name:12} {arrived:>8} {result['falls']:6} {result['ways']:5} {result['in_walls']:9} "
            f"{result['lateral_p95']:10.2f} m {result['unfallen_p95']:7.2f} m {100 * cost['control']:6.1f} % "
            f"{100 * cost['rehearsal']:8.1f} % {100 * cost['planning']:7.1f} % {100 * cost['share']:5.1f} % "
            f"{cost['real_time']:8.0f} x  {result['stopped_by']}"
        )
    if options.json:
        options.json.write_text(json.dumps(report, indent=1))


if __name__ == "__main__":
    from benchmarks.missions import main  # by its name, so that other machines find what it sends them

    main()
