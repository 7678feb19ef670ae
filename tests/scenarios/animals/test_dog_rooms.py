"""Animals among furniture: out of any place that they are put in, or a reason why not."""

from collections import Counter

import numpy as np
import pytest

import navmesh
from benchmarks.dog_rooms import try_room
from runtime import Arrived, Blocked, World
from runtime.planning.rules import walk_rules


@pytest.mark.parametrize(("name", "seed"), [("dog", 1), ("cat", 2)])
def test_gets_around_in_a_furnished_room_or_says_why_not(name, seed):
    found: Counter[str] = Counter()
    left: list[str] = []
    try_room(name, np.random.default_rng([9, seed]), found, left)
    assert found["goals"] == 4
    assert not found["silent"] and not any("without a reason" in outcome for outcome in found), left
    assert found["with a route: arrived"] >= 0.75 * found["with a route"], left


@pytest.mark.parametrize("goal", [(5, 3, 0), (4, 3, 0), (5, 1, 0), (6, 5, 0), (3, 5, 0), (2, 5, 0)])
def test_the_dog_of_the_readme_gets_out_from_under_the_table(goal, room):
    world = World(room)
    dog = world.spawn("dog", at=(2.0, 3.0, 0.0))
    assert dog.go_to(goal, speed=1.0) == "running"
    while dog.moving and world.time < 30.0:
        world.step(0.1)
    assert dog.status == "arrived" and isinstance(world.events[-1], Arrived)


@pytest.fixture(scope="module")
def room():
    """The room of the README, in the rules that a world takes for a mesh."""
    terrain = navmesh.Terrain.load("examples/levels/room.obj", up="z")
    return World(terrain).graph


def test_one_without_room_to_move_is_blocked_at_once_with_a_reason():
    boxes = [(-0.25, -0.25, 1.05, -0.2), (-0.25, 0.2, 1.05, 0.25), (1.0, -0.2, 1.05, 0.2)]
    boxes += [(-0.25, -0.2, -0.2, 0.2)]
    corners = [[-5.0, -5.0, 0.0], [5.0, -5.0, 0.0], [5.0, 5.0, 0.0], [-5.0, 5.0, 0.0]]
    faces = [[0, 1, 2], [0, 2, 3]]
    for x0, y0, x1, y1 in boxes:
        k = len(corners)
        corners += [[x0, y0, 0.0], [x1, y0, 0.0], [x1, y1, 0.0], [x0, y1, 0.0]]
        corners += [[x0, y0, 0.8], [x1, y0, 0.8], [x1, y1, 0.8], [x0, y1, 0.8]]
        for q in ((4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)):
            faces += [[k + q[0], k + q[1], k + q[2]], [k + q[0], k + q[2], k + q[3]]]
    terrain = navmesh.Terrain.from_arrays(np.array(corners), np.array(faces))
    world = World(navmesh.NodeGraph.build(terrain, walk_rules(["dog"], resolution=0.05)))
    dog = world.spawn("dog", (0.0, 0.0, 0.0))
    assert dog.go_to((-3.0, 0.5, 0.0)) == "blocked"
    (blocked,) = [event for event in world.events if isinstance(event, Blocked)]
    assert blocked.reason and not dog.moving
