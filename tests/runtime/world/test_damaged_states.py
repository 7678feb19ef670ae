"""Saved worlds with numbers that nobody can have are refused; the world then stays as it was."""

import dataclasses

import numpy as np
import pytest

import navmesh
from locomotion.crowd import layout as walker_at
from locomotion.quadruped import layout as animal_at
from runtime import RuntimeInputError, World

SIDE = np.array([[0, 0, 0], [8, 0, 0], [8, 8, 0], [0, 8, 0]], float)


@pytest.fixture(scope="module")
def world():
    world = World(navmesh.Terrain.from_arrays(SIDE, np.array([[0, 1, 2], [0, 2, 3]])), seed=1)
    for body, y in (("human", 2), ("dog", 4), ("walker", 6)):
        world.spawn(body, at=(2, y, 0)).go_to((6, y, 0), speed=1.0)
    world.step(0.5)
    return world


def refused(world, state):
    before = world.state_hash()
    with pytest.raises(RuntimeInputError, match="the state does not fit") as error:
        world.restore(state)
    assert "\n" not in str(error.value) and world.state_hash() == before


def with_body(state, name, **changes):
    agent = state.agents[name]
    body = agent.driver[0]
    body = body._replace(**changes) if hasattr(body, "_replace") else dataclasses.replace(body, **changes)
    agents = {**state.agents, name: dataclasses.replace(agent, driver=(body, agent.driver[1]))}
    return dataclasses.replace(state, agents=agents)


@pytest.mark.parametrize("value", [-1.0, 1e6, 2.0**31, np.nan, np.inf])
def test_a_person_whose_numbers_are_all_one_is_refused(world, value):
    state = world.save()
    numbers = np.full_like(state.agents["human1"].driver[0].numbers, value)
    refused(world, with_body(state, "human1", numbers=numbers))
    refused(world, with_body(state, "human1", numbers=numbers[:-1]))


@pytest.mark.parametrize(
    ("column", "value"),
    [
        (walker_at.CELL, 1e6), (walker_at.CELL, -1.0), (walker_at.CELL, 0.5), (walker_at.NEXT, 0.0),
        (walker_at.NEXT, 99.0), (walker_at.ROUTE_COUNT, 99.0), (walker_at.MODE, 7.0), (walker_at.X, np.nan),
        (walker_at.X, 1e5), (walker_at.GATE_NEXT, -1.0), (walker_at.RADIUS, 0.0), (walker_at.PASSAGE, 9.0),
    ],
)  # fmt: skip
def test_a_walker_with_an_odd_number_is_refused(world, column, value):
    state = world.save()
    row = state.agents["walker3"].driver[0].row.copy()
    row[column] = value
    refused(world, with_body(state, "walker3", row=row))


@pytest.mark.parametrize(
    ("column", "value"),
    [
        (animal_at.MODE, 3.0), (animal_at.GAIT_NOW, 99.0), (animal_at.GAIT_NOW, -1.0), (animal_at.WAY, 0.5),
        (animal_at.ROW_COUNT, 1e5), (animal_at.ROW_STEP, 0.0), (animal_at.CRUMB_LAST, 512.0),
        (animal_at.CRUMBS, -1.0), (animal_at.ARC, np.inf), (animal_at.YAW, np.nan),
    ],
)  # fmt: skip
def test_an_animal_with_an_odd_number_is_refused(world, column, value):
    state = world.save()
    herd = state.agents["dog2"].driver[0].herd
    row = herd.row.copy()
    row[column] = value
    refused(world, with_body(state, "dog2", herd=dataclasses.replace(herd, row=row)))


@pytest.mark.parametrize(
    "change",
    [{"owed": 1e9}, {"owed": -1.0}, {"ticks": -1}, {"random": {}}, {"random": {"bit_generator": "x"}}],
)
def test_a_world_at_no_time_is_refused(world, change):
    refused(world, dataclasses.replace(world.save(), **change))
