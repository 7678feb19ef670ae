"""Row of `benchmarks.dog` about rooms: from any place among furniture to any other, or a reason why not.

Rooms are sized to the body, with boxes for furniture, a wall with a door, and alcoves that are dead ends. An
animal starts at a random place in a random direction and gets one random goal after the other.
"""

import math
from collections import Counter
from typing import Any

import numpy as np

import navmesh
from locomotion.quadruped import Body, load_body
from runtime import RuntimeInputError, World
from runtime.planning.rules import walk_rules

BODIES = ("dog", "cat", "horse")
_LIMIT = 120.0  # [s] for a goal
_IDLE = 10.0  # [s] within which who gets nowhere has to say so
_GOALS = 4  # in each room
_STEP = 0.1  # [s]


def room(body: Body, rng: np.random.Generator) -> navmesh.Terrain:
    """A room of 7 by 5 body lengths."""
    unit = body.length
    x, y, high = 7.0 * unit, 5.0 * unit, 1.5 * (body.front_legs.height + body.neck.length)
    boxes = [
        (-0.2, -0.2, x + 0.2, 0.0),
        (-0.2, y, x + 0.2, y + 0.2),
        (-0.2, 0.0, 0.0, y),
        (x, 0.0, x + 0.2, y),
    ]
    door, at, wide = rng.uniform(0.1, 0.7) * y, rng.uniform(2.0, 5.0) * unit, rng.uniform(0.45, 1.0) * unit
    boxes += [(at, 0.0, at + 0.1 * unit, door), (at, door + wide, at + 0.1 * unit, y)]
    for _ in range(2):  # alcoves: three sides
        ax, ay, width, depth = (
            *rng.uniform([0.5, 0.5], [5.0, 3.0]),
            rng.uniform(0.4, 0.9),
            rng.uniform(0.8, 1.8),
        )
        sides = [(0.0, 0.0, depth, 0.1), (0.0, width + 0.1, depth, width + 0.2), (0.0, 0.0, 0.1, width + 0.2)]
        turned = rng.random() < 0.5
        for a, b, c, d in sides:
            a, b, c, d = (b, a, d, c) if turned else (a, b, c, d)
            boxes.append(tuple(unit * np.array([ax + a, ay + b, ax + c, ay + d])))
    for _ in range(7):
        ax, ay, wx, wy = *rng.uniform([0.0, 0.0], [6.5, 4.5]), *rng.uniform(0.2, 1.0, 2)
        boxes.append(tuple(unit * np.array([ax, ay, ax + wx, ay + wy])))
    corners = [[-1.0, -1.0, 0.0], [x + 1.0, -1.0, 0.0], [x + 1.0, y + 1.0, 0.0], [-1.0, y + 1.0, 0.0]]
    faces = [[0, 1, 2], [0, 2, 3]]
    for x0, y0, x1, y1 in boxes:
        first = len(corners)
        corners += [[a, b, c] for c in (0.0, high) for a, b in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
        quads = [(4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
        faces += [[first + q[k] for k in half] for q in quads for half in ((0, 1, 2), (0, 2, 3))]
    return navmesh.Terrain.from_arrays(np.array(corners), np.array(faces))


def try_room(name: str, rng: np.random.Generator, found: Counter[str], left: list[str]) -> None:
    """Put an animal into a room and send it to goals, one after the other."""
    body = load_body(name)
    level = room(body, rng)
    graph = navmesh.NodeGraph.build(level, walk_rules([name]), obstacle_rules=None)
    world, animal = World(graph, seed=0), None
    inside = np.array([7.0, 5.0]) * body.length
    for _ in range(200):
        x, y = rng.uniform(0.0, inside)
        try:
            animal = world.spawn(name, (x, y, 0.0), facing=float(rng.uniform(-math.pi, math.pi)))
            break
        except RuntimeInputError:
            found["places refused"] += 1
    if animal is None:
        return
    for _ in range(_GOALS):
        x, y = rng.uniform(0.0, inside)
        goal = np.array([x, y, 0.0])
        here = animal.animal.position
        route = graph.find_path(here, goal, radius=body.radius).status == "complete"
        found["goals"] += 1
        found["with a route"] += route
        told = animal.go_to(goal, speed=1.5 * body.local_motions.step.speed)
        idle, last = 0.0, animal.pose.transforms
        begun = world.time
        while animal.moving and world.time < begun + _LIMIT and idle < _IDLE:
            world.step(_STEP)
            now = animal.pose.transforms
            idle = 0.0 if np.abs(now - last).max() > 1e-3 else idle + _STEP
            last = now
        reason = getattr(world.events[-1], "reason", "")
        if told == "blocked":
            outcome = "blocked at once"
        elif animal.moving:
            outcome = "silent"
            animal.stop()
            world.step(3.0)
        elif animal.status == "arrived":
            outcome = "arrived"
        else:
            outcome = f"{animal.status}, {'told why' if reason else 'without a reason'}"
        found[outcome] += 1
        if route:
            found[f"with a route: {outcome}"] += 1
            if outcome != "arrived":
                left.append(f"{here.round(2).tolist()} to {goal.round(2).tolist()}: {outcome}: {reason}")


def rooms(quick: bool, seed: int = 0) -> dict[str, Any]:
    """Each body in rooms of its own size."""
    result: dict[str, Any] = {}
    for name in BODIES:
        found: Counter[str] = Counter()
        left: list[str] = []
        for k in range(5 if quick else 40):
            try_room(name, np.random.default_rng([seed, k]), found, left)
        result[name] = dict(found) | {"left": left}
    return result
