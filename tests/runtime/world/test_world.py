"""Worlds: time, agents, events, determinism, saving."""

import numpy as np
import pytest

from runtime import Departed, RuntimeInputError, World


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


def test_removed_agents_are_gone_and_the_others_go_on_as_without_them(graph):
    hashes = set()
    for more in (False, True):
        world = World(graph)
        if more:
            others = [world.spawn(body, (5.0, 1.0, 0.0), name=body) for body in ("dog", "human", "cat")]
        dog = world.spawn("dog", (2.0, 3.0, 0.0), name="rex")
        human = world.spawn("human", (2.0, 4.5, 0.0), name="ada")
        if more:
            others[0].go_to((9.0, 1.0, 0.0), speed=1.0)
        for agent in (dog, human):
            agent.go_to((9.0, 3.0, 0.0), speed=1.0)
        world.step(0.5)
        if more:
            for other in others:
                other.remove()
            with pytest.raises(RuntimeInputError, match="not in this world"):
                others[0].remove()
        assert list(world.agents) == ["rex", "ada"]
        assert np.isfinite(dog.blended_pose.transforms).all()
        world.step(1.5)
        hashes.add((world.state_hash(), dog.pose.transforms.tobytes()))
        assert world.spawn("dog", (5.0, 1.0, 0.0)).name == "dog3"
        assert world.spawn("dog", (6.0, 2.0, 0.0)).name == "dog4"
    assert len(hashes) == 1
