"""A running person that is told to go elsewhere stays up, and takes off where it should."""

import math
from functools import cache

import numpy as np
import pytest
import trimesh

import navmesh
from runtime import World
from runtime.events import Arrived, Fell, Lost, SkillStarted
from runtime.planning.rules import person_walk_rules


def graph_of(*boxes):
    mesh = trimesh.util.concatenate([trimesh.creation.box(bounds=each) for each in boxes])
    return navmesh.NodeGraph.build(
        navmesh.Terrain.from_arrays(mesh.vertices, mesh.faces), person_walk_rules()
    )


def unhurried(graph):
    """A world in which each decision is rehearsed in full."""
    return World(graph, rehearsal_ticks=None)


@pytest.fixture(scope="module")
def field():
    return graph_of(((-40, -40, -1), (60, 40, 0)))


@pytest.fixture(scope="module")
def terrace():
    """A floor, and along it, from y = 4 on, a platform of 0.4 m."""
    return graph_of(((0, -20, -1), (80, 4, 0)), ((0, 4, -1), (80, 14, 0.4)))


def running(graph, start, towards, until, speed=3.5):
    """A world with one that runs along x and has come to x = ``until``."""
    world = unhurried(graph)
    agent = world.spawn("human", start)
    agent.go_to(towards, speed=speed)
    while agent.position[0] < until:
        world.step(0.01)
    assert agent.status == "running" and not [e for e in world.events if isinstance(e, Fell)]
    return world, agent


def happens(world, agent, seconds):
    """Its events until it does not move any more."""
    events, end = [], world.time + seconds
    while world.time < end:
        world.step(0.02)
        events += world.events
        if not agent.moving and agent.status != "getting up":
            break
    return events


@pytest.fixture(scope="module")
def run_up(field):
    """As `running`, from a saved state: to the same place at the same speed it has run only once."""

    @cache
    def saved(speed, until):
        return running(field, (-35, 0, 0), (55, 0, 0), until, speed)[0].save()

    def restored(speed, until):
        world = unhurried(field)
        world.restore(saved(speed, until))
        (agent,) = world.agents.values()
        return world, agent

    return restored


@pytest.mark.parametrize("angle", [20, 45, 90, 135, 180])
@pytest.mark.parametrize(("speed", "until"), [(2.5, -9.0), (3.5, -8.6), (4.5, -8.1)])
def test_it_turns_or_stops_first_and_arrives(run_up, angle, speed, until):
    world, agent = run_up(speed, until)
    way = np.array([math.cos(math.radians(angle)), math.sin(math.radians(angle)), 0.0])
    goal = agent.position + 10.0 * way
    agent.go_to(goal, speed=speed)
    events = happens(world, agent, 60.0)
    assert not [e for e in events if isinstance(e, Fell | Lost)]
    assert [e.agent for e in events if isinstance(e, Arrived)] == [agent.name]
    for _ in range(200):
        world.step(0.01)
    assert np.linalg.norm((agent.position - goal)[:2]) < 0.7


@pytest.mark.parametrize("speed", [2.5, 3.5])
def test_within_the_budget_of_a_frame_most_stay_up_too(field, speed):
    """Told to go elsewhere while they run: not foreseen, and hardly rehearsed."""
    fell, told = 0, 0
    world = World(field)
    agent = world.spawn("human", (-22, 0, 0))
    agent.go_to((55, 0, 0), speed=speed)
    for until in (-9.3, -8.9, -8.5, -8.1):
        while agent.position[0] < until:
            world.step(0.01)
        state = world.save()
        for angle in (45, 180):
            world.restore(state)
            way = np.array([math.cos(math.radians(angle)), math.sin(math.radians(angle)), 0.0])
            agent.go_to(agent.position + 10.0 * way, speed=speed)
            told += 1
            fell += any(isinstance(event, Fell) for event in happens(world, agent, 12.0))
        world.restore(state)
    assert fell <= 0.25 * told


@pytest.mark.parametrize("speed", [1.25, 3.5])
@pytest.mark.parametrize("seconds", [0.3, 1.0, 4.0, 4.6, 6.1])
def test_told_to_stay_where_it_is_it_comes_back(field, speed, seconds):
    world = unhurried(field)
    agent = world.spawn("human", (0, 0, 0))
    agent.go_to((40, 0, 0), speed=speed)
    world.step(seconds)
    goal = agent.position
    agent.go_to(goal)
    events = happens(world, agent, 30.0)
    assert isinstance(events[-1], Arrived) and not [e for e in events if isinstance(e, Fell)]
    world.step(2.0)
    assert np.linalg.norm((agent.position - goal)[:2]) < 0.6


@pytest.mark.parametrize(
    ("body", "speed", "farthest"), [("human", 3.5, 5.6), ("dog", 2.0, 1.5), ("walker", 1.4, 0.8)]
)
def test_told_to_stop_it_stands_soon_and_goes_on_when_told(field, body, speed, farthest):
    world = unhurried(field)
    agent = world.spawn(body, (0, 0, 0))
    agent.go_to((40, 0, 0), speed=speed)
    world.step(6.0)
    begun = agent.position
    agent.stop()
    world.step(5.0)
    assert not agent.moving and agent.way is None
    assert agent.status == "standing" and 0.0 <= agent.position[0] - begun[0] < farthest
    stood = agent.position
    world.step(1.0)
    agent.stop()
    assert np.linalg.norm(agent.position - stood) < 0.01
    agent.go_to(stood + np.array([6.0, 0.0, 0.0]), speed=speed)
    assert isinstance(happens(world, agent, 30.0)[-1], Arrived)


def test_told_to_stop_as_it_clears_something_it_does_that_first(terrace):
    world = unhurried(terrace)
    agent = world.spawn("human", (40, -6, 0))
    agent.go_to((40, 12, 0.4))
    while agent.status != "jumping":
        world.step(0.01)
    agent.stop()
    world.step(8.0)
    assert agent.status == "standing" and agent.position[2] == pytest.approx(0.4, abs=0.01)


@pytest.mark.parametrize(("beside", "until"), [(3.2, 20.1), (2.0, 20.7), (0.0, 21.2), (-4.0, 20.4)])
def test_one_that_runs_along_a_platform_takes_off_in_front_of_it(terrace, beside, until):
    world, agent = running(terrace, (2, beside, 0), (78, beside, 0), until)
    agent.go_to((45, 9, 0.4))
    events = happens(world, agent, 60.0)
    assert not [e for e in events if isinstance(e, Fell | Lost)]
    (took_off,) = [e for e in events if isinstance(e, SkillStarted)]
    assert 1.0 < 4.0 - took_off.position[1] < 3.0
    assert isinstance(events[-1], Arrived)


@pytest.mark.parametrize("start", [(40, 0, 0), (20, 2, 0), (40, -12, 0)])
def test_a_platform_is_gone_up_from_the_side_without_trying_again(terrace, start):
    world = unhurried(terrace)
    agent = world.spawn("human", start)
    agent.go_to((55, 10, 0.4))
    events = happens(world, agent, 80.0)
    names = [type(e).__name__ for e in events]
    assert names == ["Departed", "SkillStarted", "SkillFinished", "Arrived"]
    assert world.time < 45.0
