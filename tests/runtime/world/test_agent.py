"""What an agent is told and asked."""

import numpy as np
import pytest

from runtime import Blocked, RuntimeInputError, World
from runtime.world.agent import Agent


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


@pytest.mark.parametrize("body", ["human", "walker", "dog"])
def test_a_removed_agent_says_so_whatever_it_is_asked(graph, body):
    world = World(graph)
    empty, agent, other = world.save(), *(world.spawn(body, (x, 3.0, 0.0)) for x in (2.0, 6.0))
    agent.remove()
    for use in (
        agent.stop,
        lambda: agent.go_to((4.0, 3.0, 0.0)),
        lambda: agent.plan((4.0, 3.0, 0.0)),
        lambda: agent.position,  # its place among its kind is another's now
        lambda: agent.status,
        lambda: agent.pose,
        lambda: agent.human,
    ):
        with pytest.raises(RuntimeInputError, match=f"{body}1 has been removed from its world"):
            use()
    world.restore(empty)
    with pytest.raises(RuntimeInputError, match=f"{body}2 has been removed from its world"):
        other.stop()


@pytest.mark.parametrize("body", ["human", "dog"])
def test_blended_poses_move_evenly_between_ticks(graph, body):
    world = World(graph)
    agent = world.spawn(body, (2.0, 3.0, 0.0))
    agent.go_to((9.0, 3.0, 0.0), speed=1.2)
    assert (agent.blended_pose.transforms == agent.pose.transforms).all()
    world.step(2.0)
    before = agent.pose
    world.step(0.01)
    after = agent.pose
    assert world.blend == pytest.approx(0.0, abs=1e-6)
    assert agent.blended_pose.transforms == pytest.approx(before.transforms, abs=1e-6)
    moved = np.linalg.norm(after.transforms[:, :3] - before.transforms[:, :3], axis=1)
    assert moved.max() > 1e-3
    for share in (0.25, 0.5, 0.75):
        world.step(0.0025)
        assert world.blend == pytest.approx(share)
        blend = agent.blended_pose.transforms
        straight = before.transforms[:, :3] + share * (after.transforms[:, :3] - before.transforms[:, :3])
        assert np.linalg.norm(blend[:, :3] - straight, axis=1).max() < 0.05 * moved.max()
        assert np.linalg.norm(blend[:, 3:], axis=1) == pytest.approx(1.0)
    assert (agent.pose.transforms == after.transforms).all()


def test_looking_does_not_change_the_run(graph):
    hashes = set()
    for looks in (False, True):
        world = World(graph)
        agents = [world.spawn(body, (2.0, y, 0.0)) for body, y in (("human", 2.0), ("dog", 4.0))]
        for agent in agents:
            agent.go_to((9.0, 3.0, 0.0), speed=3.0)
        for _ in range(120):
            world.step(1 / 60)
            if looks:
                assert all(np.isfinite(a.pose.local).all() for a in agents)
                assert all(np.isfinite(a.blended_pose.transforms).all() for a in agents)
        hashes.add(world.state_hash())
    assert len(hashes) == 1


def test_agents_are_made_by_their_world(graph):
    agent = World(graph).spawn("walker", (2.0, 3.0, 0.0), name="ada")
    assert isinstance(agent, Agent) and (agent.name, agent.body) == ("ada", "walker")
