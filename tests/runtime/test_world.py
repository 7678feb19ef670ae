"""Worlds: time, agents, events, determinism, saving."""

import numpy as np
import pytest

from runtime import Blocked, Departed, RuntimeInputError, World


def test_steps_of_any_length_make_whole_ticks(graph):
    world = World(graph)
    made = sum(world.step(1 / 60) for _ in range(60))
    assert made == 100
    assert world.time == pytest.approx(1.0)
    assert world.step(0.004) == 0
    assert world.step(0.004) == 0
    assert world.step(0.004) == 1
    assert world.step(0.0) == 0
    assert sum(world.step(1e-4) for _ in range(1000)) == 10


@pytest.mark.parametrize("dt", [-0.01, np.nan, np.inf])
def test_refuses_a_bad_step(graph, dt):
    with pytest.raises(RuntimeInputError, match="dt must be"):
        World(graph).step(dt)


def test_how_time_is_cut_does_not_matter(graph):
    hashes = set()
    for cuts in ([0.01] * 60, [0.6], [0.25, 0.05, 0.3]):
        world = World(graph, seed=5)
        world.spawn("human", (2.0, 3.0, 0.0)).go_to((9.0, 3.0, 0.0), speed=3.0)
        for dt in cuts:
            world.step(dt)
        hashes.add((world.time, *(agent.human.state_hash() for agent in world.agents.values())))
    assert len(hashes) == 1


def test_the_seed_is_part_of_the_state(graph):
    assert World(graph, seed=1).state_hash() == World(graph, seed=1).state_hash()
    assert World(graph, seed=1).state_hash() != World(graph, seed=2).state_hash()


def test_a_restored_world_goes_on_the_same_way(graph):
    world = World(graph, seed=5)
    agent = world.spawn("human", (2.0, 3.0, 0.0))
    agent.go_to((9.0, 3.0, 0.0), speed=3.0)
    world.step(0.5)
    saved = world.save()
    world.random.random()
    world.step(0.5)
    first = world.state_hash(), world.events
    world.restore(saved)
    world.random.random()
    world.step(0.5)
    assert (world.state_hash(), world.events) == first
    with pytest.raises(RuntimeInputError, match="agents"):
        World(graph).restore(saved)


def test_pose_is_ready_for_a_skeleton(graph):
    world = World(graph)
    pose = world.spawn("human", (2.0, 3.0, 0.0), facing=1.0).pose
    n = len(pose.names)
    assert pose.transforms.shape == (n, 7) and pose.transforms.dtype == np.float64
    assert pose.names[0] == "pelvis" and pose.parents[0] == -1
    assert all(0 <= parent < child for child, parent in enumerate(pose.parents) if child > 0)
    assert np.linalg.norm(pose.transforms[:, 3:], axis=1) == pytest.approx(1.0)
    assert pose.transforms[0, :2] == pytest.approx([2.0, 3.0], abs=0.2)


def test_events_are_typed_and_drained(graph):
    world = World(graph)
    agent = world.spawn("human", (2.0, 3.0, 0.0), name="ada")
    assert agent.go_to((9.0, 3.0, 0.0)) == "walking"
    (event,) = world.events
    assert (
        isinstance(event, Departed) and event.agent == "ada" and event.length == pytest.approx(7.0, abs=0.5)
    )
    assert event.to_dict()["kind"] == "Departed"
    assert world.events == []


def test_goes_through_several_points(graph):
    world = World(graph)
    agent = world.spawn("human", (1.0, 3.0, 0.0))
    agent.go_to([(6.0, 1.5, 0.0), (11.0, 4.5, 0.0)])
    (plan,) = agent.plans
    assert np.min(np.linalg.norm(plan.points - [6.0, 1.5, 0.0], axis=1)) < 1e-6
    assert plan.points[-1] == pytest.approx([11.0, 4.5, 0.0])


@pytest.mark.parametrize(
    ("goal", "reason"), [((18.0, 3.0, 0.0), "no way leads there"), ((50.0, 3.0, 0.0), "not near a place")]
)
def test_an_unreachable_goal_blocks(graph, goal, reason):
    world = World(graph)
    agent = world.spawn("human", (2.0, 3.0, 0.0))
    assert agent.go_to(goal) == "blocked" == agent.status
    (event,) = world.events
    assert isinstance(event, Blocked) and reason in event.reason and event.goal == goal


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"body": "goose"}, "valid: 'human'"),
        ({"at": (50.0, 3.0, 0.0)}, "not near a place"),
        ({"at": (2.0, 3.0)}, "finite"),
        ({"facing": np.nan}, "finite"),
        ({"name": "ada"}, "taken"),
    ],
)
def test_refuses_a_bad_spawn(graph, change, says):
    world = World(graph)
    world.spawn("human", (2.0, 3.0, 0.0), name="ada")
    with pytest.raises(RuntimeInputError, match=says):
        world.spawn(**{"body": "human", "at": (4.0, 3.0, 0.0), **change})


def test_refuses_a_bad_goal_and_a_bad_level(graph):
    agent = World(graph).spawn("human", (2.0, 3.0, 0.0))
    for point in ((1.0, 2.0), (1.0, np.nan, 0.0), ()):
        with pytest.raises(RuntimeInputError, match="finite"):
            agent.go_to(point)
    with pytest.raises(RuntimeInputError, match="Terrain or a NodeGraph"):
        World("level.obj")  # type: ignore[arg-type]
