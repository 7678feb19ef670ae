"""What is recorded of a running world is what happened in it."""

import numpy as np
import pytest

from runtime import World
from runtime.traces.recording import Recorder, level_trace


def test_poses_events_and_paths_are_those_of_the_world(graph):
    world = World(graph, seed=1)
    ada = world.spawn("walker", (2.0, 3.0, 0.0), name="ada")
    ada.go_to((9.0, 3.0, 0.0), speed=1.5)
    recorder, places, told = Recorder(world), [], []
    for _ in range(4):
        told += recorder.sample()
        places.append(ada.pose.transforms)
        world.step(0.5)
    trace = recorder.trace({"held": True})
    (agent,) = trace.agents
    assert agent.name == "ada" and agent.poses.dtype == np.float32
    assert agent.poses == pytest.approx(np.stack(places), abs=1e-5)
    assert trace.times == pytest.approx([0.0, 0.5, 1.0, 1.5])
    assert np.array_equal(agent.paths[0].smooth, ada.plans[0].points)
    assert [event["kind"] for event in trace.events] == [event.kind for event in told] == ["Departed"]
    assert trace.state_hash == world.state_hash() and trace.report == {"held": True}
    assert world.events == []  # the recorder has read them


def test_of_a_graph_each_edge_is_drawn_once(graph):
    level = level_trace(graph)
    assert len(level.edges) == len(graph.edge_target) // 2
    assert len({frozenset(edge) for edge in level.edges.tolist()}) == len(level.edges)
    assert (level.edges[:, 0] < level.edges[:, 1]).all()
    assert level.faces is graph.terrain.faces and len(level.affordances) == len(level.rim)


def test_agents_may_come_and_go(graph):
    """Who comes later stands at its first place until then, who has gone at its last."""
    world = World(graph, seed=1)
    world.spawn("walker", (2.0, 3.0, 0.0), name="ada")
    recorder = Recorder(world)
    recorder.sample()
    world.step(0.5)
    bob = world.spawn("walker", (5.0, 3.0, 0.0), name="bob")
    recorder.sample()
    bob.remove()
    world.step(0.5)
    recorder.sample()
    trace = recorder.trace({})
    assert [agent.name for agent in trace.agents] == ["ada", "bob"]
    assert [len(agent.poses) for agent in trace.agents] == [3, 3]
    assert (trace.agents[1].poses == trace.agents[1].poses[0]).all() and trace.agents[1].paths == ()
