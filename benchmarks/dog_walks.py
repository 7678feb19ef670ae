"""Rows of `benchmarks.dog` with dogs walking on levels: paths, feet, joints, time."""

import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.spatial import KDTree

import navmesh
from benchmarks.shared_data import LEVELS, level_path, shared_folder
from locomotion import Ground, SmoothPath, smooth_route
from locomotion.errors import LocomotionError
from locomotion.quadruped import Animal, Body, Herd, lay_trail, load_body
from locomotion.quadruped import layout as at
from locomotion.quadruped.pose import body_names
from navmesh.level.mesh_queries import MeshGrid, surface_below

SCANS = ("IPproj_ClassRoomSpatialMapping", "collabxr_SpatialMapping")
GLB_LEVELS = ("proto-level", "bridges")
_EXPANSE = 5000.0  # [m] farther up or down than any level
_LONG, _SHORT = (4.0, 25.0), (1.3, 12.0)  # [m] of routes; in the levels that are small, what there is
_SMALL = (*SCANS, "bridges")


def load_level(name: str) -> navmesh.Terrain:
    """One of the shared levels or scans."""
    if name in LEVELS:
        return navmesh.Terrain.load(level_path(name), up="y")
    folder = shared_folder()
    assert folder is not None
    kind, suffix = ("scans", "obj") if name in SCANS else ("glb", "glb")
    return navmesh.Terrain.load(folder / "levels" / kind / f"{name}.{suffix}", up="y")


def dog_graph(name: str, body: Body) -> navmesh.NodeGraph:
    """The graph of a level for a body; finer in the scans of rooms."""
    rules = body.walk_rules(0.1 if name in SCANS else None)
    return navmesh.NodeGraph.build(load_level(name), rules, obstacle_rules=None)


def random_paths(graph: navmesh.NodeGraph, body: Body, count: int, lengths: tuple[float, float], seed: int):
    """Up to ``count`` smoothed paths (k, 3) between random places, with lengths in a range [m]."""
    rng = np.random.default_rng(seed)
    paths = []
    for _ in range(60 * count):
        start = graph.random_points(rng, 1, radius=body.radius)[0]
        try:
            goal = graph.random_points(rng, 1, radius=body.radius, reachable_from=start)[0]
        except navmesh.NavmeshError:
            continue
        route = graph.find_path(start, goal, radius=body.radius)
        if route.status == "complete" and lengths[0] <= route.length <= lengths[1]:
            paths.append(smooth_route(route, body.smoothing).points)
            if len(paths) == count:
                break
    return paths


@dataclass
class Walked:
    """What was measured while dogs walked: distances from the path [m], slides and heights of standing feet
    [m], joint speeds' changes."""

    front: list[float] = field(default_factory=list)
    feet: list[float] = field(default_factory=list)
    root: list[float] = field(default_factory=list)
    slides: list[float] = field(default_factory=list)
    above: list[float] = field(default_factory=list)
    speed: float = 0.0
    acceleration: float = 0.0
    jerk: float = 0.0
    jump: list[float] = field(default_factory=list)
    paths: int = 0
    finished: int = 0


class GroundTruth:
    """Heights of the mesh by code that the dog does not use."""

    def __init__(self, terrain: navmesh.Terrain) -> None:
        self.origin = terrain.vertices.min(axis=0) - 1.0
        self.grid = MeshGrid(terrain.vertices, terrain.faces, self.origin, np.radians(89.0))

    def off(self, toe: np.ndarray) -> float:
        """[m] from a toe to the nearest surface straight above or below it."""
        x, y, z = toe - self.origin
        below, _ = surface_below(self.grid.arrays, x, y, -_EXPANSE, z + 0.011)
        above, found = surface_below(self.grid.arrays, x, y, z - 0.011, z + 0.15)
        miss = z - below
        if found >= 0 and abs(z - above) < abs(miss):
            miss = z - above
        return float(miss)


def toes_of(pose: np.ndarray, body: Body) -> np.ndarray:
    """(4, 3) [m] the toes as the bones have them, by the transforms of the feet."""
    names = body_names(body.spine.bones)
    toes = np.empty((4, 3))
    for leg, name in enumerate(at.LEGS):
        x, y, z, w, i, j, k = pose[names.index(f"{name}_foot")]
        length = body.front_legs.foot if leg < 2 else body.rear_legs.foot
        along = np.array([1 - 2 * (j * j + k * k), 2 * (i * j + w * k), 2 * (i * k - w * j)])
        toes[leg] = np.array([x, y, z]) + length * along
    return toes


def dense(points: np.ndarray, over: float = 1.0) -> np.ndarray:
    """(n, 2) [m] a line's points every 2 mm, and straight on beyond both ends."""
    line = points[:, :2]
    first, last = line[0] - line[1], line[-1] - line[-2]
    line = np.vstack([
        line[0] + over * first / max(np.linalg.norm(first), 1e-9), line,
        line[-1] + over * last / max(np.linalg.norm(last), 1e-9),
    ])  # fmt: skip
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    where = np.arange(0.0, arc[-1], 0.002)
    return np.column_stack([np.interp(where, arc, line[:, k]) for k in range(2)])


def walk_paths(name: str, count: int, speeds: tuple[float, ...], seed: int, lengths=(6.0, 25.0)) -> Walked:
    """Dogs walk and trot along random paths of a level."""
    body = load_body("dog")
    graph = dog_graph(name, body)
    ground = Ground.from_arrays(graph.terrain.vertices, graph.terrain.faces)
    truth = GroundTruth(graph.terrain)
    paths = random_paths(graph, body, count, lengths, seed)
    walked = Walked(paths=len(paths) * len(speeds))
    for path in paths:
        for speed in speeds:
            _walk(path, speed, body, ground, truth, walked)
    return walked


class _Fixed:
    """A planner that knows one path."""

    def __init__(self, path: np.ndarray) -> None:
        self.path = path

    def way(self, start: np.ndarray, goal: np.ndarray, direction: np.ndarray) -> SmoothPath:
        return SmoothPath(self.path, (), True)

    def room_to_turn(self, points: np.ndarray, length: float) -> np.ndarray:
        return np.zeros(len(points), bool)


def _walk(
    path: np.ndarray, speed: float, body: Body, ground: Ground, truth: GroundTruth, walked: Walked
) -> None:
    try:
        trail = lay_trail(path, body, ground)
    except LocomotionError:
        return
    line = KDTree(dense(path))
    herd = Herd(ground)
    x, y = trail.point(body.spine.length) - trail.point(0.0)  # as one stands that has just come there
    index = herd.add(body, trail.rows[0, [at.PX, at.PY, at.PZ]], float(np.arctan2(y, x)))
    animal = Animal(herd, index, _Fixed(path))
    animal.go_to(path[-1], speed)
    joints, fronts, roots, middles = [], [], [], []
    stance: list[list[np.ndarray]] = [[], [], [], []]
    for _ in range(int(100 * (20.0 + trail.length / 0.2))):
        herd.tick()
        animal.tick()
        toes = toes_of(herd.pose(index), body)
        for leg, stands in enumerate(herd.standing_feet(index)):
            if stands:
                stance[leg].append(toes[leg])
                walked.above.append(truth.off(toes[leg]))
            elif stance[leg]:
                walked.slides.append(float(np.ptp(stance[leg], axis=0).max()))
                stance[leg] = []
        joints.append(herd.joints[index].copy())
        if animal.speed > 0.0:
            fronts.append(herd.front(index).copy())
            roots.append(herd.root(index)[:2].copy())
            middles.append(toes[:2, :2].mean(axis=0))
        if animal.status != "running":
            walked.finished += animal.status == "arrived"
            break
    if not fronts:  # too short for a path: local motion, or no room
        return
    walked.front += line.query(np.array(fronts))[0].tolist()
    walked.root += line.query(np.array(roots))[0].tolist()
    walked.feet += line.query(np.array(middles))[0].tolist()
    speeds = np.diff(np.unwrap(np.array(joints), axis=0), axis=0) / 0.01
    changes = np.diff(speeds, axis=0)
    walked.speed = max(walked.speed, float(np.abs(speeds).max()))
    walked.acceleration = max(walked.acceleration, float(np.abs(changes).max()) / 0.01)
    walked.jerk = max(walked.jerk, float(np.abs(np.diff(changes, axis=0)).max()) / 1e-4)
    walked.jump.append(float(np.percentile(np.abs(changes).max(axis=1), 99)))


def following(quick: bool) -> dict[str, Any]:
    """Row by level: how far from the path, how the feet stand, how the joints move."""
    result: dict[str, Any] = {}
    for name in (*LEVELS, *GLB_LEVELS, *SCANS):
        lengths = _SHORT if name in _SMALL else _LONG
        walked = walk_paths(name, 3 if quick else 12, (1.0, 2.0), 0, lengths)
        if not walked.front:
            result[name] = {"paths": 0}
            continue
        above = np.array(walked.above)
        result[name] = {
            "paths": walked.paths,
            "finished": walked.finished,
            "front_p95": float(np.percentile(walked.front, 95)),
            "front_max": float(np.max(walked.front)),
            "feet_p95": float(np.percentile(walked.feet, 95)),
            "feet_max": float(np.max(walked.feet)),
            "root_p95": float(np.percentile(walked.root, 95)),
            "root_max": float(np.max(walked.root)),
            "stances": len(walked.slides),
            "slide_max": float(np.max(walked.slides)),
            "slide_p99": float(np.percentile(walked.slides, 99)),
            "slides_above_5mm": int((np.array(walked.slides) > 0.005).sum()),
            "height_worst": float(np.abs(above).max()),
            "heights_above_1cm": int((np.abs(above) > 0.01).sum()),
            "joint_speed": walked.speed,
            "joint_acceleration": walked.acceleration,
            "joint_jerk": walked.jerk,
            "joint_change": 0.01 * walked.acceleration,
            "joint_change_p99": float(np.max(walked.jump)),
        }
    return result


def many_at_once(count: int, ticks: int) -> dict[str, Any]:
    """Processor time of a tick of many dogs on nav_test, in one call on one core, with all bodies'
    transforms; the time on the wall says besides how busy the machine was with other things."""
    body = load_body("dog")
    graph = dog_graph("nav_test", body)
    ground = Ground.from_arrays(graph.terrain.vertices, graph.terrain.faces)
    trails = [lay_trail(p, body, ground) for p in random_paths(graph, body, 40, (30.0, 80.0), 1)]
    herd = Herd(ground)
    rng = np.random.default_rng(2)
    for k in range(count):
        trail = trails[k % len(trails)]
        start = float(rng.uniform(0.0, 5.0))
        index = herd.add(
            body,
            [
                *trail.point(start),
                np.interp(start, trail.step * np.arange(len(trail.rows)), trail.rows[:, at.PZ]),
            ],
            trail.heading(start),
        )
        herd.follow(index, trail, float(rng.uniform(0.8, 3.0)), start=start)
    for _ in range(150):
        herd.tick()
    times, walls = [], []
    for _ in range(ticks):
        begun, clock = time.process_time(), time.perf_counter()
        herd.tick()
        times.append(time.process_time() - begun)
        walls.append(time.perf_counter() - clock)
    moving = int((herd.state[:, at.SPEED] > 0.05).sum())
    return {
        "dogs": count,
        "moving": moving,
        "bodies": len(herd.poses),
        "ms_per_tick": 1e3 * float(np.median(times)),
        "ms_p95": 1e3 * float(np.percentile(times, 95)),
        "wall_ms": 1e3 * float(np.median(walls)),
    }
