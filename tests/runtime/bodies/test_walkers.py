"""Walkers in worlds and missions."""

import numpy as np
import pytest

from runtime import Arrived, Blocked, Departed, RuntimeInputError, World
from runtime.missions.mission import load_mission
from runtime.missions.run import run_mission
from runtime.traces.trace import Trace
from runtime.world.state_file import pack, unpack
from tests.small_level import MISSION


def test_a_walker_goes_where_it_is_told(graph):
    world = World(graph)
    walker = world.spawn("walker", (2.0, 3.0, 0.0), radius=0.25)
    assert walker.radius == 0.25
    assert walker.go_to((9.0, 4.0, 0.0), speed=1.5, facing=1.0) == "walking"
    assert walker.moving and isinstance(world.events[0], Departed)
    world.step(2.0)
    assert 0.2 < walker.progress < 0.6
    while walker.moving:
        world.step(0.1)
    assert walker.status == "arrived" and isinstance(world.events[-1], Arrived)
    assert walker.position == pytest.approx([9.0, 4.0, 0.0], abs=0.2)
    world.step(1.0)
    assert walker.facing == pytest.approx(1.0, abs=0.01)
    pose = walker.pose
    assert pose.names == ("root",) and pose.transforms.shape == (1, 7)
    assert len(walker.figure.posed(pose.transforms).size) == 2
    assert walker.plans[0].length == pytest.approx(np.hypot(7.0, 1.0), abs=0.05)


def test_a_goal_that_cannot_be_reached_blocks_it(graph):
    world = World(graph)
    walker = world.spawn("walker", (2.0, 3.0, 0.0))
    for goal in ((18.0, 3.0, 0.0), (50.0, 3.0, 0.0)):
        assert walker.go_to(goal) == "blocked"
        assert isinstance(world.events[-1], Blocked)
    with pytest.raises(RuntimeInputError, match="speed"):
        walker.go_to((6.0, 3.0, 0.0), speed=-1.0)
    with pytest.raises(RuntimeInputError, match="not near a place where a walker fits"):
        world.spawn("walker", (6.0, 3.0, 0.0), radius=9.0)
    with pytest.raises(RuntimeInputError, match="only a walker"):
        world.spawn("dog", (6.0, 3.0, 0.0), radius=0.5)


def test_a_restored_world_of_walkers_goes_on_the_same_way(graph):
    world = World(graph, seed=5)
    rng = np.random.default_rng(1)
    for spot, goal in zip(
        graph.random_points(rng, 20, 0.3, (2, 3, 0)),
        graph.random_points(rng, 20, 0.3, (2, 3, 0)),
        strict=True,
    ):
        world.spawn("walker", spot).go_to(goal, speed=2.0)
    world.step(1.0)
    saved = world.save()
    ends = set()
    for _ in range(2):
        world.step(3.0)
        ends.add((world.state_hash(), len(world.events)))
        world.restore(saved)
    assert len(ends) == 1


def test_walkers_come_back_from_a_file_and_leave(graph, tmp_path):
    world = World(graph)
    walkers = [world.spawn("walker", (2.0 + k, 3.0, 0.0)) for k in range(3)]
    for walker in walkers:
        walker.go_to((8.0, 2.0, 0.0))
    world.step(1.0)
    tree, arrays = pack(world.save())
    here = walkers[2].position
    world.remove(walkers[1])
    assert (walkers[2].position == here).all()
    with pytest.raises(RuntimeInputError, match="is not in this world"):
        world.remove(walkers[1])
    world.step(0.013)
    assert 0.005 < np.linalg.norm(walkers[2].position - here) < 0.04
    ends = set()
    for other in (world, World(graph)):
        other.restore(unpack(tree, arrays))
        other.step(2.0)
        ends.add(other.state_hash())
    assert len(ends) == 1 and len(world.agents) == 3


def test_poses_between_ticks(graph):
    world = World(graph)
    walker = world.spawn("walker", (2.0, 3.0, 0.0))
    walker.go_to((9.0, 3.0, 0.0), speed=1.4)
    world.step(1.0)
    driver = walker.driver
    now, half, before = (driver.transforms_between(share) for share in (1.0, 0.5, 0.0))
    assert now == pytest.approx(driver.transforms())
    assert half == pytest.approx(0.5 * (now + before))
    assert now[0, 0] - before[0, 0] == pytest.approx(0.014, abs=0.001)


def test_a_mission_with_a_walker_runs(folder):
    (folder / "mission.yaml").write_text(MISSION.replace("body: human", "body: walker"))
    result = run_mission(load_mission(folder / "mission.yaml"))
    assert result.held, result.checks
    result.trace.write(folder / "trace.npz")
    assert Trace.read(folder / "trace.npz").state_hash == result.trace.state_hash


@pytest.mark.parametrize(("body", "speed"), [("dog", 1.5), ("human", 1.2)])
def test_walkers_keep_out_of_the_way_of_dogs_and_people(graph, body, speed):
    world = World(graph)
    other = world.spawn(body, (2.0, 3.0, 0.0))
    other.go_to((10.0, 3.0, 0.0), speed=speed)
    walkers = [world.spawn("walker", (4.0 + 2.0 * k, 3.0, 0.0), radius=0.25) for k in range(3)]
    walkers[0].go_to((2.0, 3.0, 0.0), speed=1.2)
    nearest = np.inf
    while other.moving and world.time < 15.0:
        world.step(0.01)
        away = [np.hypot(*(walker.position - other.position)[:2]) for walker in walkers]
        nearest = min(nearest, *away)
    assert walkers[0].status == "arrived"
    assert nearest > 0.25 + 0.12 - 1e-6  # they touch at most
    assert other.status == "arrived"
