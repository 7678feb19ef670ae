"""Worlds in which zones of the level are blocked and opened."""

import numpy as np
import pytest

import navmesh
from runtime import Arrived, Blocked, RuntimeInputError, World, WorldState
from tests.runtime.changing_level import START, two_floors

BODIES = ("dog", "walker", "human")
GOAL = (13.0, 2.0, 0.0)
ZONES = {
    "bridge": [(7.0, 0.5, 0.0), (8.0, 0.5, 0.0), (8.0, 3.5, 0.0), (7.0, 3.5, 0.0)],
    "detour": [(7.5, 5.0, 0.0), (7.5, 8.0, 0.0)],
}


@pytest.fixture(scope="module")
def floors() -> navmesh.NodeGraph:
    return two_floors().with_zones(ZONES)


def on_its_way(floors, body, seconds=1.0):
    world = World(floors)
    agent = world.spawn(body, START)
    agent.go_to(GOAL, speed=1.5)
    world.step(seconds)
    assert agent.moving
    world.events.clear()
    return world, agent


def events_of(world, seconds):
    events = []
    for _ in range(round(seconds / 0.25)):
        world.step(0.25)
        events += world.events
        if any(isinstance(event, Arrived | Blocked) for event in events):
            break
    return events


@pytest.mark.parametrize("body", BODIES)
def test_a_way_that_holds_is_gone_on(floors, body):
    world, agent = on_its_way(floors, body)
    plan = agent.plans[-1]
    world.block("detour")
    world.step(0.5)
    world.open("detour")
    assert agent.moving and agent.plans[-1] is plan


@pytest.mark.parametrize("body", BODIES)
def test_agents_go_round_what_is_blocked(floors, body):
    world, agent = on_its_way(floors, body)
    here = agent.position
    world.block("bridge")
    assert (agent.position == here).all()
    assert agent.plan(GOAL).points[:, 1].max() > 5.0
    events = events_of(world, 25.0)
    assert agent.status == "arrived" and isinstance(events[-1], Arrived)


@pytest.mark.parametrize("body", BODIES)
def test_agents_stop_where_all_is_blocked_and_go_when_told_again(floors, body):
    world, agent = on_its_way(floors, body)
    world.block("bridge", "detour")
    assert any(isinstance(event, Blocked) for event in world.events)
    world.events.clear()
    world.step(2.0)
    assert not agent.moving and agent.position[0] < 7.0
    world.open("detour")
    agent.go_to(GOAL, speed=1.5)
    assert isinstance(events_of(world, 25.0)[-1], Arrived)


def test_worlds_of_one_graph_have_doors_of_their_own(floors):
    one, other = World(floors), World(floors)
    one.block("bridge")
    assert one.graph.zones == {"bridge": True, "detour": False}
    assert not any(other.graph.zones.values()) and not any(floors.zones.values())


def test_a_change_of_the_level_keeps_what_is_blocked(floors):
    world = World(floors)
    world.block("bridge")
    world.change_level({"apart": None})
    assert world.graph.zones == {"bridge": True, "detour": False}


def test_what_is_blocked_is_saved_and_restored(floors, tmp_path):
    world = World(floors)
    for body in BODIES:
        world.spawn(body, (START[0], START[1] + 1.5 * BODIES.index(body), 0.0)).go_to(GOAL, speed=1.5)
    open_hash = World(floors).state_hash()
    world.step(1.0)
    world.block("bridge")
    world.step(1.0)
    world.save().write(tmp_path / "state.npz")
    state = WorldState.read(tmp_path / "state.npz")
    assert state.blocked == ("bridge",)
    world.open("bridge")
    world.block("detour")
    again = World(floors)
    for each in (world, again):
        each.restore(state)
        assert each.graph.zones == {"bridge": True, "detour": False}
    hashes = set()
    for each in (world, again):
        each.step(1.0)
        each.open("bridge")
        for agent in each.agents.values():
            agent.go_to(GOAL, speed=1.5)
        each.step(3.0)
        hashes.add(each.state_hash())
    assert len(hashes) == 1
    shut = World(floors)
    shut.block("bridge")
    assert shut.state_hash() != open_hash


def test_the_same_run_is_the_same_bit_for_bit(floors):
    hashes = set()
    for _ in range(2):
        world = World(floors, seed=4)
        for k in range(6):
            world.spawn("walker", (1.5, 0.8 + 1.2 * k, 0.0)).go_to(GOAL)
        for turn in range(8):
            (world.block if turn % 2 == 0 else world.open)("bridge" if turn % 4 < 2 else "detour")
            world.step(0.7)
        places = np.array([agent.position for agent in world.agents.values()])
        hashes.add((world.state_hash(), places.tobytes()))
    assert len(hashes) == 1


def test_wrong_calls_are_refused(floors):
    world = World(floors)
    with pytest.raises(navmesh.NavmeshError, match="no zone 'gate'"):
        world.block("gate")
    world.block("bridge")
    state = world.save()
    with pytest.raises(RuntimeInputError, match="blocked zone 'bridge'"):
        World(floors.undivided).restore(state)


def test_a_callback_can_open_a_door(floors):
    world = World(floors)
    world.block("bridge", "detour")
    agent = world.spawn("walker", START)
    world.listen(lambda event: world.open("bridge"), Arrived)
    agent.go_to((5.0, 2.0, 0.0))
    world.step(6.0)
    assert world.graph.zones == {"bridge": False, "detour": True}
