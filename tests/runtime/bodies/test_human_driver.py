"""One simulated person in a world: its size, what it refuses, and what is saved of it."""

import math

import numpy as np
import pytest

from runtime import RuntimeInputError, World
from runtime.bodies.human_driver import HumanDriver
from runtime.bodies.people import People
from runtime.planning.level import Level


@pytest.fixture
def people(graph):
    return People(Level.of(graph), seed=3)


@pytest.mark.parametrize("hesitates", [-0.1, float("nan"), "long", None])
def test_a_state_without_a_time_to_hesitate_is_refused(people, hesitates):
    driver = people.spawn("human", np.array([2.0, 3.0, 0.0]), 0.0, 0.3)
    state = driver.save()
    with pytest.raises(RuntimeInputError, match="hesitates for some seconds"):
        driver.restore(state._replace(hesitates=hesitates))
    for wrong in (tuple(state), None):
        with pytest.raises(RuntimeInputError, match="no person's state"):
            driver.restore(wrong)


def test_what_a_person_cannot_do_yet_is_said(people):
    driver = people.spawn("human", np.array([2.0, 3.0, 0.0]), 0.0, 0.3)
    with pytest.raises(RuntimeInputError, match="cannot turn to a facing at its goal"):
        driver.go_to(np.array([[5.0, 3.0, 0.0]]), 1.4, 1.0)


def test_a_person_of_another_size_goes_where_it_is_told(graph):
    world = World(graph, seed=4, rehearsals=0)
    ada, bob = (world.spawn("human", (2.0, y, 0.0)) for y in (2.0, 4.0))
    ada.set_style(size=0.9)
    tall, small = bob.pose.transforms[:, 2].max(), ada.pose.transforms[:, 2].max()
    assert small == pytest.approx(0.9 * tall, abs=0.01)
    assert ada.skills["jump"][1] == pytest.approx(0.9 * bob.skills["jump"][1])
    for agent, y in ((ada, 2.0), (bob, 4.0)):
        agent.go_to((6.0, y, 0.0), speed=1.2)
    world.step(2.0)
    with pytest.raises(RuntimeInputError, match="only where it stands"):
        ada.set_style(size=1.1)
    state, here = world.save(), world.state_hash()
    world.step(1.0)
    after = world.state_hash()
    other = World(graph, seed=4, rehearsals=0)
    other.restore(state)
    assert other.state_hash() == here
    other.step(1.0)
    assert other.state_hash() == after
    world.step(8.0)
    assert [agent.status for agent in (ada, bob)] == ["arrived", "arrived"]
    assert ada.position[0] == pytest.approx(6.0, abs=0.3)
    told = [event for event in world.events if event.agent == "human1"]
    assert told[-1].time == pytest.approx(world.time, abs=8.0)


def test_physics_and_recorded_motion_keep_a_persons_size(graph):
    world = World(graph, seed=4, rehearsals=0)
    ada, bob = (world.spawn("human", (2.0, y, 0.0), detail="full") for y in (2.0, 4.0))
    ada.set_style(size=0.9)
    for detail in ("full", "physics", "medium", "physics"):
        ada.detail = bob.detail = detail
        world.step(0.5)
        assert ada.level == detail and ada.driver.traits["size"] == 0.9
        small, usual = (agent.pose.transforms[:, 2].max() for agent in (ada, bob))
        assert small == pytest.approx(0.9 * usual, abs=0.03)
    assert isinstance(ada.driver, HumanDriver) and ada.driver.body.size == 0.9


@pytest.mark.parametrize(("field", "wrong"), [("size", 3.0), ("size", math.nan), ("owed", -0.5)])
def test_a_state_of_no_size_is_refused(people, field, wrong):
    driver = people.spawn("human", np.array([2.0, 3.0, 0.0]), 0.0, 0.3)
    before = driver.state_hash()
    with pytest.raises(ValueError, match=r"size of a person|behind its world"):
        driver.restore(driver.save()._replace(**{field: wrong}))
    assert driver.state_hash() == before


def test_an_agent_is_pushed_and_a_saved_world_goes_on_alike(graph):
    world = World(graph, seed=2, rehearsals=0)
    ada, bob = world.spawn("human", (3.0, 3.0, 0.0)), world.spawn("walker", (6.0, 3.0, 0.0))
    world.step(0.5)
    still = ada.position
    ada.push((0.0, 250.0, 0.0), 0.1)
    world.step(0.05)
    twin = World(graph, seed=2, rehearsals=0)
    twin.restore(world.save())
    for each in (world, twin):
        each.step(3.0)
    assert world.state_hash() == twin.state_hash()
    assert ada.position[1] - still[1] > 0.05 and ada.status == "standing"
    with pytest.raises(RuntimeInputError, match="only a human with physics"):
        bob.push((1.0, 0.0, 0.0))
    for force, seconds, says in (((1.0, 2.0), 0.1, "three finite"), ((1.0, 0.0, 0.0), 0.0, r"0.01 to 10")):
        with pytest.raises(RuntimeInputError, match=says):
            ada.push(force, seconds)
