"""Who is told again and again where to go keeps out of the way of others, also where it turns."""

import numpy as np
import pytest

import navmesh
from benchmarks.giving_way import play
from locomotion import PERSON_RULES
from runtime import World
from runtime.planning.rules import person_walk_rules
from runtime.traffic.snapshot import Snapshot


@pytest.fixture(scope="module")
def hall():
    corners = np.array([(0.0, 0.0, 0.0), (30.0, 0.0, 0.0), (30.0, 10.0, 0.0), (0.0, 10.0, 0.0)])
    terrain = navmesh.Terrain.from_arrays(corners, np.array([(0, 1, 2), (0, 2, 3)]))
    return navmesh.NodeGraph.build(terrain, person_walk_rules())


def overlap(world):
    """[m] how deep the discs of any two bodies lie in each other, below 0 if they do not."""
    bodies = list(Snapshot(world._populations).discs)
    return max(
        float((a[:, None, 5] + b[:, 5] - np.linalg.norm(a[:, None, :2] - b[:, :2], axis=2)).max())
        for i, a in enumerate(bodies)
        for b in bodies[:i]
    )


def deepest_until_at_rest(world, seconds):
    deepest = -np.inf
    while world.time < seconds and any(agent.moving for agent in world.agents.values()):
        world.step(0.02)
        deepest = max(deepest, overlap(world))
    return deepest


@pytest.mark.parametrize("seed", range(6))
def test_dogs_that_chase_a_point_do_not_touch(hall, seed):
    """It runs to and fro; they are told twice a second where it is."""
    world = World(hall, seed=seed)
    corners = world.random.uniform((4.0, 1.5), (26.0, 8.5), (4, 2))
    arcs = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    for place in world.random.uniform((4.0, 1.0), (26.0, 9.0), (3, 2)):
        world.spawn("dog", (*place, 0.0), world.random.uniform(-np.pi, np.pi))
    deepest = overlap(world)
    assert deepest < 0.0
    for tick in range(2500):
        point = [np.interp(1.2 * world.time, arcs, corners[:, axis]) for axis in range(2)]
        for agent in world.agents.values():
            if tick % 50 == 0 and np.linalg.norm(agent.position[:2] - point) > 1.0:
                agent.go_to((*point, 0.0), speed=2.0)
        world.step(0.01)
        deepest = max(deepest, overlap(world))
    deepest = max(deepest, deepest_until_at_rest(world, 50.0))
    assert deepest < 0.02
    assert [agent.status for agent in world.agents.values()] == ["arrived"] * 3


@pytest.mark.parametrize("beside", [0.3, -0.3])
def test_a_dog_does_not_turn_into_one_beside_it(hall, beside):
    world = World(hall)
    world.spawn("dog", (10.0, 5.0 + beside, 0.0))
    turner = world.spawn("dog", (10.0, 5.0, 0.0))
    turner.go_to((4.0, 5.0, 0.0), speed=1.4)
    assert deepest_until_at_rest(world, 30.0) < 0.0
    assert turner.status == "arrived"


def test_a_dog_between_others_turns_when_they_have_left(hall):
    world = World(hall)
    others = [world.spawn("dog", (10.0, 5.0 + side, 0.0)) for side in (-0.3, 0.3)]
    turner = world.spawn("dog", (10.0, 5.0, 0.0))
    turner.go_to((4.0, 5.0, 0.0), speed=1.4)
    world.step(1.0)
    assert turner.moving and turner.position[0] > 10.0
    saved, hashes = world.save(), []
    for again in (world, World(hall)):
        again.restore(saved)
        for other in others:
            again.agents[other.name].go_to((20.0, again.agents[other.name].position[1], 0.0), speed=1.4)
        assert deepest_until_at_rest(again, 30.0) < 0.0
        assert again.agents[turner.name].status == "arrived"
        hashes.append(again.state_hash())
    assert hashes[0] == hashes[1]


def test_a_dog_that_is_hemmed_in_turns_in_the_end(hall):
    world = World(hall)
    for side in (-0.3, 0.3):
        world.spawn("dog", (10.0, 5.0 + side, 0.0))
    turner = world.spawn("dog", (10.0, 5.0, 0.0))
    turner.go_to((4.0, 5.0, 0.0), speed=1.4)
    while world.time < 40.0 and turner.moving:
        world.step(0.5)
        if turner.moving:
            turner.go_to((4.0, 5.0, 0.0), speed=1.4)
    assert turner.status == "arrived"


def test_two_that_lie_in_each_other_get_apart(hall):
    world = World(hall)
    for y in (5.0, 5.15):
        world.spawn("dog", (10.0, y, 0.0)).go_to((20.0, 5.0, 0.0), speed=1.4)
    assert overlap(world) > 0.05
    world.step(30.0)
    assert [agent.status for agent in world.agents.values()] == ["arrived"] * 2
    assert overlap(world) < 0.0


def test_people_who_lie_in_each_other_get_apart(hall):
    """The one that is ahead leaves first, whichever was made first."""
    for places in ((10.0, 10.4), (10.4, 10.0)):
        world = World(hall)
        for x in places:
            world.spawn("human", (x, 5.0, 0.0)).go_to((24.0, 5.0, 0.0), speed=1.4)
        world.step(4.0)
        assert overlap(world) < 0.0


@pytest.mark.parametrize("seed", [2, 7])
def test_people_who_walk_after_a_point_hardly_touch(hall, seed):
    """In all four they stood in each other up to 0.6 m before those who turn on the spot were foretold."""
    result = play(hall, ("person", "person"), "chase", seed, False)
    assert result["overlap"] * PERSON_RULES["radius"] < 0.15
    assert result["ended"] == ["arrived"] * 3
