"""People who fall, slide off their way or cannot go on: they look for another way from where they are."""

from pathlib import Path

import numpy as np
import pytest

import navmesh
from locomotion.body_events import GotStuck, StrayedFromPath
from runtime import Arrived, Departed, GotUp, Lost, Stuck, World
from runtime.planning.rules import person_walk_rules
from runtime.world.agent import Agent

COURTYARD = Path(__file__).parents[3] / "examples" / "levels" / "courtyard.obj"
GOAL = (16.0, 2.0, 0.0)


@pytest.fixture(scope="module")
def yard() -> navmesh.NodeGraph:
    """A plane of 20 m by 12 m."""
    corners = np.array([[-2.0, -6.0, 0.0], [18.0, -6.0, 0.0], [18.0, 6.0, 0.0], [-2.0, 6.0, 0.0]])
    terrain = navmesh.Terrain.from_arrays(corners, np.array([[0, 1, 2], [0, 2, 3]]))
    return navmesh.NodeGraph.build(terrain, person_walk_rules())


@pytest.fixture(scope="module")
def courtyard() -> navmesh.NodeGraph:
    return navmesh.NodeGraph.build(navmesh.Terrain.load(COURTYARD, up="z"), person_walk_rules())


def _on_the_way(yard: navmesh.NodeGraph, begun: float = 3.0) -> tuple[World, Agent]:
    world = World(yard)
    agent = world.spawn("human", (0.0, 0.0, 0.0))
    agent.go_to(GOAL, speed=1.2)
    world.step(begun)
    return world, agent


def _until_it_stops(world: World, agent: Agent, limit: float = 60.0) -> list:
    begun = world.time
    events = world.events
    while agent.moving and world.time - begun < limit:
        world.step(0.1)
        events += world.events
    return events


def _fall(world: World, agent: Agent, force: tuple[float, float]) -> float:
    """Push it over; how far it is beside its path [m] when it is about to be up again."""
    human, off = agent.human, 0.0
    human.data.xfrc_applied[human.index.chest, :2] = force
    while human.status != "getting up":
        world.step(0.01)
    human.data.xfrc_applied[:] = 0.0
    while human.status == "getting up":
        off = abs(human.lateral_error)
        world.step(0.01)
    return off


@pytest.mark.parametrize("begun", [3.0, 3.3, 3.7])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_carried_off_by_a_fall_it_goes_on_from_there(yard, begun, side):
    world, agent = _on_the_way(yard, begun)
    assert _fall(world, agent, (0.0, 1200.0 * side)) > 0.5
    assert [type(event) for event in world.events[-2:]] == [GotUp, Departed]
    world.step(0.1)  # its path is planned meanwhile
    assert abs(agent.human.lateral_error) < 0.2
    assert len(agent.plans) == 2
    assert isinstance(_until_it_stops(world, agent)[-1], Arrived)


@pytest.mark.parametrize("begun", [3.0, 3.3, 3.7])
def test_after_a_fall_on_its_way_it_keeps_to_it(yard, begun):
    world, agent = _on_the_way(yard, begun)
    off = _fall(world, agent, (-300.0, 0.0))
    assert len(agent.plans) == (1 if off < 0.5 else 2)
    assert isinstance(_until_it_stops(world, agent)[-1], Arrived)


@pytest.mark.parametrize(
    ("status", "what", "told"),
    [
        ("stuck", GotStuck(0.0, (0.0, 0.0, 0.0)), Stuck),
        ("lost", StrayedFromPath(0.0, (0.0, 0.0, 0.0), 2.0), Lost),
    ],
)
def test_where_it_cannot_go_on_it_tries_again_a_few_times(yard, status, what, told):
    world, agent = _on_the_way(yard)
    for attempt in range(4):
        assert agent.moving
        agent.human.status = status
        agent.human.events.append(what)
        world.step(0.5)
        assert len(agent.plans) == min(2 + attempt, 4)
    assert agent.status == status
    assert sum(isinstance(event, told) for event in world.events) == 1
    agent.go_to(GOAL, speed=1.2)  # told anew it begins anew
    agent.human.status = status
    agent.human.events.append(what)
    world.step(0.01)
    assert isinstance(_until_it_stops(world, agent)[-1], Arrived)


def test_stuck_before_an_obstacle_it_goes_round(courtyard):
    world, rng = World(courtyard), np.random.default_rng(2)
    places = courtyard.positions[courtyard.radii > 0.5]
    while True:
        start, goal = places[rng.choice(len(places), 2)]
        on_foot = courtyard.find_path(start, goal, radius=0.3)
        if on_foot.status == "complete" and not on_foot.links and on_foot.length < 40.0:
            agent = world.spawn("human", start)
            if agent.plan(goal).skills:
                break
            agent.remove()
    agent.go_to(goal, speed=3.0)
    world.step(1.0)
    agent.human.status = "stuck"
    agent.human.events.append(GotStuck(0.0, (0.0, 0.0, 0.0)))
    world.step(0.1)
    assert agent.moving and agent.plans[0].skills and not agent.plans[-1].skills


def test_a_person_that_was_never_told_a_goal_stays_stuck(yard):
    world = World(yard)
    agent = world.spawn("human", (0.0, 0.0, 0.0))
    agent.human.follow([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]], speed=1.2)
    world.step(1.0)
    agent.human.status = "stuck"
    agent.human.events.append(GotStuck(0.0, (0.0, 0.0, 0.0)))
    world.step(0.1)
    assert agent.status == "stuck"
