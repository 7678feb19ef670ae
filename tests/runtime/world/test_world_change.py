"""Levels that change while a world runs."""

import numpy as np
import pytest

import navmesh
from locomotion.quadruped.motion import stop_length
from runtime import Arrived, Blocked, Departed, Fell, Lost, RuntimeInputError, World, WorldState
from tests.runtime.changing_level import FLOORS, START, quad, two_floors

BODIES = ("dog", "walker", "human")
GOAL = (13.0, 2.0, 0.0)


def wall(x, y0, y1):
    """A wall of 2 m across the way, seen from the west."""
    corners = [(x, y1, 0), (x, y0, 0), (x, y0, 2), (x, y1, 2), (x + 0.2, y0, 2), (x + 0.2, y1, 2)]
    return navmesh.Terrain.from_arrays(corners, [(0, 1, 2), (0, 2, 3), (3, 2, 4), (3, 4, 5)])


@pytest.fixture(scope="module")
def whole():
    return two_floors()


def on_its_way(whole, body, seconds=1.0):
    world = World(whole)
    agent = world.spawn(body, START)
    agent.go_to(GOAL, speed=1.5)
    world.step(seconds)
    assert agent.moving
    return world, agent


def step_evenly(world, agent, seconds):
    """Step, and see to it that the agent is never elsewhere at once; returns the events."""
    events, before = [], agent.position
    for _ in range(round(seconds / 0.05)):
        world.step(0.05)
        events += world.events
        assert np.linalg.norm((agent.position - before)[:2]) < 0.25
        before = agent.position
        if not agent.moving and any(isinstance(event, Arrived) for event in events):
            break
    return events


@pytest.mark.parametrize("body", BODIES)
def test_a_way_that_holds_is_gone_on(whole, body):
    world, agent = on_its_way(whole, body)
    plan = agent.plans[-1]
    world.events.clear()
    world.change_level({"apart": None, "new": quad(9.0, 8.0, 16.0, 10.0)})
    assert world.graph.terrain.bounds[1, 0] == 16.0
    assert agent.moving and agent.plans[-1] is plan
    events = step_evenly(world, agent, 15.0)
    assert [type(event) for event in events if not isinstance(event, Departed)] == [Arrived]
    assert agent.plans[-1] is plan and agent.status == "arrived"


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("change", [{"bridge": None}, {"wall": wall(8.0, 0.0, 4.0)}])
def test_a_way_that_does_not_hold_is_planned_anew(whole, body, change):
    world, agent = on_its_way(whole, body)
    here = agent.position
    world.events.clear()
    world.change_level(change)
    assert (agent.position == here).all()
    assert agent.plan(GOAL).points[:, 1].max() > 5.0
    events = step_evenly(world, agent, 25.0)
    assert agent.status == "arrived", events
    assert isinstance(events[-1], Arrived)
    assert np.linalg.norm(agent.position[:2] - GOAL[:2]) < 0.6


@pytest.mark.parametrize("body", BODIES)
def test_without_a_way_it_stops_and_says_where(whole, body):
    world, agent = on_its_way(whole, body)
    world.events.clear()
    here = agent.position
    world.change_level({"bridge": None, "detour": None})
    blocked = world.events[-1]
    assert isinstance(blocked, Blocked) and blocked.goal == GOAL
    assert blocked.position == pytest.approx(here)
    step_evenly(world, agent, 4.0)
    assert agent.status == "blocked" and not agent.moving
    at_rest = agent.position
    world.step(2.0)
    assert np.linalg.norm(agent.position - at_rest) < 0.02
    assert agent.position[0] < 6.0
    world.change_level({"bridge": quad(*FLOORS["bridge"])})
    agent.go_to(GOAL, speed=1.5)
    assert isinstance(step_evenly(world, agent, 20.0)[-1], Arrived)


@pytest.mark.parametrize("seconds", [0.0, 1.0])
def test_where_the_ground_has_gone_a_dog_and_a_walker_stand_still(whole, seconds):
    world = World(whole)
    agents = [world.spawn(body, (2.0, y, 0.0)) for body, y in (("dog", 2.0), ("walker", 6.0))]
    if seconds:
        for agent in agents:
            agent.go_to(GOAL, speed=1.5)
    world.step(seconds)
    world.events.clear()
    before = [agent.position for agent in agents]
    world.change_level({"west": None})
    for agent, place in zip(agents, before, strict=True):
        assert (agent.position == place).all()
    world.step(3.0)
    assert {event.agent for event in world.events if isinstance(event, Lost)} == {a.name for a in agents}
    dog, walker = agents
    assert dog.status == "lost" and walker.status == "stuck"
    assert (walker.position == before[1]).all()
    braking = stop_length(1.5, dog.animal.body.movement.braking)
    assert np.linalg.norm(dog.position - before[0]) < (braking + 0.02 if seconds else 1e-3)
    with pytest.raises(RuntimeInputError, match="no floor under it"):
        walker.go_to(GOAL)
    state = world.save()
    world.restore(state)
    world.change_level({"west": quad(*FLOORS["west"])})
    walker.go_to(GOAL, speed=1.5)
    assert isinstance(step_evenly(world, walker, 20.0)[-1], Arrived)


@pytest.mark.parametrize("seconds", [0.0, 1.0])
@pytest.mark.parametrize("below", [None, -1.5])
def test_where_the_ground_has_gone_a_person_falls(whole, seconds, below):
    world = World(whole)
    agent = world.spawn("human", START)
    if seconds:
        agent.go_to(GOAL, speed=1.5)
    world.step(seconds)
    qpos = agent.human.qpos
    world.change_level({"west": None if below is None else quad(*FLOORS["west"], below)})
    assert (agent.human.qpos == qpos).all()
    lowest = []
    for _ in range(60):
        world.step(0.05)
        lowest.append(agent.human.qpos[2])
    assert max(np.abs(np.diff([qpos[2], *lowest]))) < 0.6
    assert agent.status == ("fallen" if below is None else "getting up")
    assert any(isinstance(event, Fell) for event in world.events)
    assert lowest[-1] < qpos[2] - 1.0
    assert not any(warning.number for warning in agent.human.data.warning)  # what it was told is finite
    if below is not None:
        assert lowest[-1] > below
    else:
        assert lowest[-1] == lowest[-2]  # held, not falling for ever


def test_bad_changes_leave_everything_as_it_was(whole):
    world, _ = on_its_way(whole, "dog", 0.2)
    before = world.state_hash(), world.level_digest, world.graph
    for changes, says in (
        ({"roof": None}, "no chunk 'roof' to remove"),
        ({"bridge": None, "wall": [1, 2, 3]}, "chunk 'wall' is a list"),
        ({name: None for name in FLOORS}, "removes all chunks"),
    ):
        with pytest.raises(navmesh.NavmeshError, match=says):
            world.change_level(changes)
    with pytest.raises(navmesh.NavmeshError, match="nothing to walk on"):
        world.change_level({**dict.fromkeys(FLOORS), "speck": quad(0.0, 0.0, 0.1, 0.1)})
    with pytest.raises(RuntimeInputError, match="changes are a list"):
        world.change_level([("bridge", None)])  # type: ignore[arg-type]
    assert (world.state_hash(), world.level_digest, world.graph) == before


def test_a_changed_world_is_saved_and_restored(whole, tmp_path):
    world = World(whole, seed=2)
    agents = [world.spawn(body, (2.0, 1.0 + 2.0 * k, 0.0)) for k, body in enumerate(BODIES)]
    for agent in agents:
        agent.go_to(GOAL, speed=1.5)
    world.step(0.5)
    early = world.save()
    world.change_level({"bridge": None})
    world.step(0.5)
    world.save().write(tmp_path / "state.npz")
    hashes = []
    for fresh in (False, True):
        if fresh:
            world = World(whole.update({"bridge": None}))
        world.restore(WorldState.read(tmp_path / "state.npz"))
        world.step(1.0)
        world.change_level({"detour": None})
        world.step(0.5)
        hashes.append(world.state_hash())
    assert hashes[0] == hashes[1]
    with pytest.raises(RuntimeInputError, match="the state is of the level"):
        world.restore(early)
    world.change_level({name: quad(*FLOORS[name]) for name in ("bridge", "detour")})
    world.restore(early)
    assert world.time == pytest.approx(0.5)


def test_goals_behind_it_are_not_gone_to_again(whole):
    for body in BODIES:
        world = World(whole)
        agent = world.spawn(body, (1.0, 2.0, 0.0))
        agent.go_to([(3.5, 2.0, 0.0), GOAL], speed=1.5)
        while agent.position[0] < 4.5:
            world.step(0.1)
        world.change_level({"bridge": None})
        assert agent.driver.goals_left == 1
        assert agent.plans[-1].points[:, 0].min() > 3.5 or body == "dog"


def test_a_callback_may_change_the_level(whole):
    world = World(whole)
    agent = world.spawn("walker", START)
    world.listen(lambda _: world.change_level({"bridge": None}), Arrived)
    agent.go_to((4.0, 2.0, 0.0), speed=2.0)
    world.step(4.0)
    assert agent.status == "arrived"
    assert agent.plan(GOAL).points[:, 1].max() > 5.0
