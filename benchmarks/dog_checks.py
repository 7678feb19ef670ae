"""Rows of `benchmarks.dog` with a single question: the spine, the head, stops, short moves, footprints, dead
ends."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import trimesh

import navmesh
from benchmarks.dog_walks import SCANS, load_level
from locomotion import Ground, SmoothPath, smooth_route
from locomotion.body_events import BackedOut
from locomotion.quadruped import Animal, Body, Herd, Place, check_script, lay_trail, load_body, local_motion
from locomotion.quadruped import layout as at
from locomotion.quadruped.body_on_path import wrap
from locomotion.quadruped.footprint import RESOLUTION, key_balls, script_places
from locomotion.quadruped.spine import bend_for, brute_force_bend
from navmesh.errors import NavmeshError


def plane(half: float = 60.0) -> Ground:
    """A square floor at z = 0."""
    corners = np.array([[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0.0]])
    return Ground.from_arrays(corners, np.array([[0, 1, 2], [0, 2, 3]]))


@dataclass
class GraphPlanner:
    """`locomotion.quadruped.Planner` on a graph."""

    graph: navmesh.NodeGraph
    body: Body

    def way(self, start: np.ndarray, goal: np.ndarray, direction: np.ndarray) -> SmoothPath:
        route = self.graph.find_path(start, goal, radius=self.body.radius)
        if route.status != "complete":
            raise NavmeshError(f"no way: {route.status}")
        return smooth_route(route, self.body.smoothing, direction)

    def leads(self, start: np.ndarray, goal: np.ndarray) -> bool:
        return self.graph.find_path(start, goal, radius=self.body.radius).status == "complete"

    def room_to_turn(self, points: np.ndarray, length: float) -> np.ndarray:
        return self.graph.room_to_turn(points, length)


class Straight:
    """A planner for an open plane."""

    def way(self, start: np.ndarray, goal: np.ndarray, direction: np.ndarray) -> SmoothPath:
        return SmoothPath(np.stack([start, goal]), (), True)

    def leads(self, start: np.ndarray, goal: np.ndarray) -> bool:
        return True

    def room_to_turn(self, points: np.ndarray, length: float) -> np.ndarray:
        return np.ones(len(points), bool)


def spine(quick: bool) -> dict[str, Any]:
    """SpineFlex in closed form against laying bone to bone and halving."""
    worst = 0.0
    for bones in range(2, 13):
        for angle in np.linspace(-1.4, 1.4, 41 if quick else 281):
            worst = max(worst, abs(float(bend_for(angle, bones)) - brute_force_bend(float(angle), bones)))
    return {"worst_rad": worst}


def head(_: bool) -> dict[str, Any]:
    """Where the head's target is on the path, against speed times the time it looks ahead."""
    body, ground = load_body("dog"), plane()
    turn = np.linspace(0.0, 4.0, 200)
    points = np.column_stack([6.0 * turn, 1.5 * np.sin(turn), np.zeros(200)])
    trail = lay_trail(points, body, ground)
    fine = np.array([trail.point(arc) for arc in np.arange(0.0, trail.length, 0.002)])
    arcs = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(fine, axis=0), axis=1))])
    result = {}
    for speed in (0.6, 1.2, 2.4):
        herd = Herd(ground)
        index = herd.add(body, points[0], trail.heading(0.0))
        herd.follow(index, trail, speed)
        off = []
        for _tick in range(900):
            herd.tick()
            st = herd.state[index]
            if st[at.STOPPING] > 0.0:
                break
            here = arcs[np.argmin(np.linalg.norm(fine - herd.front(index), axis=1))]
            target = np.array([st[at.LOOK_X], st[at.LOOK_Y]])
            seen = arcs[np.argmin(np.linalg.norm(fine - target, axis=1))]
            off.append(abs(seen - here - st[at.SPEED] * body.head.look_ahead))
        result[f"{speed:g} m/s"] = {"worst_m": float(np.max(off))}
    return result


def stops(quick: bool) -> dict[str, Any]:
    """Goals and facings on a plane, reached from walk, trot and gallop."""
    body, ground = load_body("dog"), plane()
    result = {}
    for gait, speed in (("walk", 1.0), ("trot", 2.2), ("gallop", 4.5)):
        rng = np.random.default_rng(7)
        places, turns = [], []
        for _ in range(5 if quick else 40):
            herd = Herd(ground)
            animal = Animal(herd, herd.add(body, (0.0, 0.0, 0.0), float(rng.uniform(-3, 3))), Straight())
            direction, far = rng.uniform(-math.pi, math.pi), rng.uniform(3.0, 6.0) * max(1.0, speed / 1.5)
            goal = far * np.array([math.cos(direction), math.sin(direction), 0.0])
            facing = float(direction + rng.uniform(-1.0, 1.0))
            animal.go_to(goal, speed, facing)
            while animal.status == "running":
                herd.tick()
                animal.tick()
            feet = herd.toes(animal.index)
            front, rear = feet[:2, :2].mean(axis=0), feet[2:, :2].mean(axis=0)
            places.append(float(np.linalg.norm(front - goal[:2])))
            pointing = math.atan2(*(front - rear)[::-1])
            turns.append(abs(float(wrap(pointing - facing))))
        result[gait] = {
            "place_worst": max(places),
            "facing_worst_deg": math.degrees(max(turns)),
            "stops": len(places),
        }
    return result


def local_moves(quick: bool) -> dict[str, Any]:
    """Random wanted places within 1 m and facings, looked up, played, and measured where the feet stand."""
    body, ground = load_body("dog"), plane()
    rng = np.random.default_rng(3)
    places, turns = [], []
    for _ in range(60 if quick else 1000):
        yaw, way = rng.uniform(-math.pi, math.pi, 2)
        far = math.sqrt(rng.uniform(0.0, 1.0))
        turn = float(rng.uniform(-math.pi, math.pi))
        herd = Herd(ground)
        index = herd.add(body, (1.0, 2.0, 0.0), float(yaw))
        wanted = (far * math.cos(way), far * math.sin(way), turn)
        herd.play(index, local_motion(body).script(herd.place(index), wanted))
        for _tick in range(1500):
            herd.tick()
            if herd.resting(index):
                break
        c, s = math.cos(yaw), math.sin(yaw)
        goal = np.array([1.0 + c * wanted[0] - s * wanted[1], 2.0 + s * wanted[0] + c * wanted[1]])
        feet = herd.toes(index)
        front, rear = feet[:2, :2].mean(axis=0), feet[2:, :2].mean(axis=0)
        places.append(float(np.linalg.norm(rear - goal)))
        turns.append(abs(float(wrap(math.atan2(*(front - rear)[::-1]) - yaw - turn))))
    return {
        "moves": len(places),
        "place_p99": float(np.percentile(places, 99)), "place_worst": max(places),
        "facing_p99_deg": math.degrees(float(np.percentile(turns, 99))),
        "facing_worst_deg": math.degrees(max(turns)),
    }  # fmt: skip


def footprints(quick: bool) -> dict[str, Any]:
    """Random local motions at random places of a scanned room, against trimesh's distances to the mesh."""
    body = load_body("dog")
    terrain = load_level(SCANS[0])
    ground = Ground.from_arrays(terrain.vertices, terrain.faces)
    graph = navmesh.NodeGraph.build(terrain, body.walk_rules(0.1), obstacle_rules=None)
    triangles = terrain.vertices[terrain.faces]
    rng = np.random.default_rng(5)
    spots = graph.random_points(rng, 100 if quick else 1000, radius=0.1)
    passed = refused = wrongly = 0
    deepest = 0.0
    by_part: dict[str, int] = {}
    for spot in spots:
        yaw, way, turn = rng.uniform(-math.pi, math.pi, 3)
        far = rng.uniform(0.0, 1.0)
        place = Place(*(float(v) for v in spot), float(yaw))
        script = local_motion(body).script(place, (far * math.cos(way), far * math.sin(way), float(turn)))
        found = check_script(script, body, ground)
        if not found.free:
            by_part[found.part] = by_part.get(found.part, 0) + 1
        if found.part == "ground":
            continue
        places = _finer(script_places(script, body))
        front_z = _front_heights(places, body, ground)
        if not np.isfinite(front_z).all():
            continue
        balls = key_balls(places, body, front_z)
        depth = _depth(balls.centres, balls.radii, triangles)
        if found.free:
            passed += 1
            deepest = max(deepest, depth)
        else:
            refused += 1
            wrongly += depth < 0.0
    return {
        "placements": len(spots), "passed": passed, "refused": refused, "refused_by": by_part,
        "deepest_of_passed": deepest, "resolution": RESOLUTION,
        "wrongly_refused": wrongly / max(refused, 1),
    }  # fmt: skip


def _depth(centres: np.ndarray, radii: np.ndarray, triangles: np.ndarray) -> float:
    """[m] by which the balls (k, parts, 3) come deeper than the surface of the triangles, at most; -inf where
    they touch none. By trimesh's closest points, on the triangles whose box each ball meets."""
    worst = -math.inf
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    for part, radius in enumerate(radii):
        points = centres[:, part]
        near = np.flatnonzero(
            np.all((low < points.max(axis=0) + radius) & (high > points.min(axis=0) - radius), axis=1)
        )
        for some in np.array_split(points, len(points) * len(near) // 200_000 + 1):
            meets = (low[near] < some[:, None] + radius) & (high[near] > some[:, None] - radius)
            ball, triangle = np.nonzero(meets.all(axis=2))
            if len(ball) == 0:
                continue
            closest = trimesh.triangles.closest_point(triangles[near[triangle]], some[ball])
            worst = max(worst, radius - float(np.linalg.norm(closest - some[ball], axis=1).min()))
    return worst


def _finer(places: np.ndarray) -> np.ndarray:
    """Twice as many samples."""
    steps = np.arange(0.0, len(places) - 0.75, 0.5)
    return np.stack([np.interp(steps, np.arange(len(places)), places[:, k]) for k in range(5)], axis=1)


def _front_heights(places: np.ndarray, body: Body, ground: Ground) -> np.ndarray:
    from locomotion.quadruped.footprint import fronts

    above = np.column_stack([fronts(places, body), places[:, 2] + 0.5])
    return ground.surface_below(above)[0]


def dead_ends(quick: bool) -> dict[str, Any]:
    """Random passages, narrower than the dog is long, closed at their end, off a room: into each and out."""
    body = load_body("dog")
    rng = np.random.default_rng(11)
    out = touched = backed = stuck = 0
    nearest = math.inf
    count = 20 if quick else 200
    for _ in range(count):
        width = float(rng.uniform(0.42, 0.95 * body.length))
        depth, bend = float(rng.uniform(1.2, 3.5)), float(rng.uniform(-0.8, 0.8))
        terrain, walls, end = passage(width, depth, bend)
        graph = navmesh.NodeGraph.build(terrain, body.walk_rules(0.08), obstacle_rules=None)
        ground = Ground.from_arrays(terrain.vertices, terrain.faces)
        herd = Herd(ground)
        planner = GraphPlanner(graph, body)
        animal = Animal(herd, herd.add(body, (-2.5, float(rng.uniform(-1, 1)), 0.0), 0.0), planner)
        gaps = []
        for goal in (end, np.array([-3.0, float(rng.uniform(-1.5, 1.5)), 0.0])):
            try:
                animal.go_to(goal, 1.0)
            except ValueError:
                break
            for _tick in range(6000):
                herd.tick()
                animal.tick()
                gaps.append(_gap_to_walls(herd, animal.index, walls))
                if animal.status != "running":
                    break
        out += animal.status == "arrived" and animal.position[0] < -1.5
        stuck += animal.status != "arrived"
        backed += any(isinstance(event, BackedOut) for event in animal.events)
        least = min(gaps) if gaps else math.inf
        nearest = min(nearest, least)
        touched += least < 0.0
    return {
        "dead_ends": count, "out": out, "backed_out": backed, "not_arrived": stuck, "touched": touched,
        "nearest_m": nearest,
    }  # fmt: skip


def passage(width: float, depth: float, bend: float) -> tuple[navmesh.Terrain, np.ndarray, np.ndarray]:
    """A room x < 0 with a passage from its east side: terrain, walls as segments (k, 2, 2) [m], the place
    near the passage's end."""
    half = 0.5 * width
    knee = 0.55 * depth
    first, second = np.array([1.0, 0.0]), np.array([math.cos(bend), math.sin(bend)])
    middle = np.array([[0.0, 0.0], knee * first, knee * first + (depth - knee) * second])
    turn = math.tan(0.5 * bend)
    left = [[0.0, half], [knee - half * turn, half], middle[2] + half * np.array([-second[1], second[0]])]
    right = [[0.0, -half], [knee + half * turn, -half], middle[2] - half * np.array([-second[1], second[0]])]
    loop = [
        [-4.0, -3.0], [0.0, -3.0], *right, *left[::-1], [0.0, 3.0], [-4.0, 3.0],
    ]  # fmt: skip
    outline = np.array(loop, dtype=np.float64)
    walls = np.stack([outline, np.roll(outline, -1, axis=0)], axis=1)
    corners = [[-6.0, -6.0, 0.0], [6.0, -6.0, 0.0], [6.0, 6.0, 0.0], [-6.0, 6.0, 0.0]]
    faces = [[0, 1, 2], [0, 2, 3]]
    for a, b in walls:
        at_ = len(corners)
        corners += [[*a, 0.0], [*b, 0.0], [*b, 1.2], [*a, 1.2]]
        faces += [[at_, at_ + 1, at_ + 2], [at_, at_ + 2, at_ + 3]]
    terrain = navmesh.Terrain.from_arrays(np.array(corners), np.array(faces))
    goal = middle[2] - 0.35 * second
    return terrain, walls, np.array([goal[0], goal[1], 0.0])


def _gap_to_walls(herd: Herd, index: int, walls: np.ndarray) -> float:
    """[m] from head, shoulders and root, as balls, to the nearest wall, seen from above; below 0: through."""
    body = herd.bodies[index]
    place = herd.place(index)
    balls = key_balls(np.array([[place.x, place.y, place.z, place.yaw, place.bend]]), body)
    pose = herd.pose(index)
    bones = body.spine.bones
    skull = pose[2 + bones]
    w, i, j, k = skull[3:]
    along = np.array([1 - 2 * (j * j + k * k), 2 * (i * j + w * k)])
    centres = balls.centres[0, :, :2].copy()
    centres[0] = skull[:2] + 0.5 * body.head.length * along
    a, d = walls[:, 0], walls[:, 1] - walls[:, 0]
    off = centres[:, None] - a
    share = np.clip((off * d).sum(axis=2) / (d * d).sum(axis=1), 0.0, 1.0)
    gaps = np.linalg.norm(off - share[:, :, None] * d, axis=2).min(axis=1)
    return float((gaps - balls.radii).min())
