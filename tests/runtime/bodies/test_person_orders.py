"""Orders of people: planned in the ticks that follow, whatever happens meanwhile."""

import numpy as np
import pytest

from benchmarks.giving_way import floor
from locomotion import LocomotionError
from runtime import Arrived, Departed, RuntimeInputError, World, WorldState

ROOM = (0.0, 0.0, 40.0, 20.0)


@pytest.fixture
def world():
    return World(floor(ROOM))


def is_planning(agent):
    return agent.driver.save()[4] is not None


def until_planned(world, agent, most=60):
    for ticks in range(most):
        if not is_planning(agent):
            return ticks
        world.step(0.01)
    raise AssertionError("it is still planning")


def test_one_that_stands_is_on_its_way_at_once_and_moves_when_it_has_a_path(world):
    agent = world.spawn("human", (5.0, 5.0, 0.0))
    assert agent.go_to((30.0, 12.0, 0.0), speed=3.0) == "walking"
    assert is_planning(agent) and agent.moving and agent.progress == 0.0
    assert any(isinstance(event, Departed) for event in world.events)
    assert agent.way.length == pytest.approx(26.0, abs=0.5)
    pulled = agent.way.points
    assert 1 <= until_planned(world, agent) <= 20
    assert len(agent.way.points) > len(pulled)
    world.step(2.0)
    assert agent.position[0] > 5.5 and agent.progress > 0.0


def test_one_that_moves_goes_on_until_it_has_a_path(world):
    agent = world.spawn("human", (5.0, 5.0, 0.0))
    agent.go_to((35.0, 5.0, 0.0), speed=3.0)
    world.step(5.0)
    before = agent.human.path
    agent.go_to((35.0, 15.0, 0.0), speed=3.0)
    assert np.array_equal(agent.human.path, before) and is_planning(agent)
    until_planned(world, agent)
    assert agent.human.path[-1, 1] == pytest.approx(15.0, abs=0.05)
    world.step(6.0)
    assert agent.status == "running" and agent.human.lateral_error < 0.5


def test_the_end_of_the_way_that_it_leaves_is_not_reported(world):
    """It comes to its goal while the next order is planned."""
    agent = world.spawn("human", (5.0, 5.0, 0.0))
    agent.go_to((8.0, 5.0, 0.0), speed=1.4)
    while agent.human.follower.remaining > 0.4 or is_planning(agent):
        world.step(0.01)
    list(world.events)
    agent.go_to((30.0, 12.0, 0.0), speed=1.4)
    agent.human.arrive()
    world.step(0.01)
    assert is_planning(agent) and agent.status == "walking"
    until_planned(world, agent)
    assert not [event for event in world.events if isinstance(event, Arrived)]
    world.step(2.0)
    assert agent.moving and agent.position[0] > 8.5


def test_a_new_order_takes_the_place_of_the_one_that_is_planned(world):
    agent = world.spawn("human", (5.0, 5.0, 0.0))
    agent.go_to((35.0, 5.0, 0.0))
    world.step(0.01)
    agent.go_to((5.0, 15.0, 0.0))
    until_planned(world, agent)
    assert agent.way.points[-1, :2] == pytest.approx([5.0, 15.0], abs=0.05)
    assert agent.human.path[-1, :2] == pytest.approx([5.0, 15.0], abs=0.05)


def test_one_that_is_told_anew_in_each_tick_gets_paths_all_the_same(world):
    agent = world.spawn("human", (5.0, 5.0, 0.0))
    for k in range(300):
        agent.go_to((30.0, 5.0 + 0.02 * k, 0.0), speed=3.0)
        world.step(0.01)
    assert agent.position[0] > 6.5
    until_planned(world, agent)
    assert agent.human.path[-1, 1] == pytest.approx(5.0 + 0.02 * 299, abs=0.05)


def test_an_order_to_stop_ends_the_planning(world):
    agent = world.spawn("human", (5.0, 5.0, 0.0))
    agent.go_to((35.0, 5.0, 0.0))
    agent.stop()
    assert not is_planning(agent) and agent.status == "standing"
    world.step(2.0)
    assert agent.position[0] == pytest.approx(5.0, abs=0.2)


def test_a_run_goes_on_bit_for_bit_from_a_state_in_mid_planning(world, tmp_path):
    agent = world.spawn("human", (5.0, 5.0, 0.0))
    agent.go_to((35.0, 5.0, 0.0), speed=3.0)
    world.step(4.0)
    agent.go_to((20.0, 15.0, 0.0), speed=3.0)
    hashes = {world.state_hash()}
    world.step(0.02)
    assert is_planning(agent)
    state = world.save()
    hashes.add(world.state_hash())
    other = World(floor(ROOM))
    state.write(tmp_path / "state.npz")
    other.restore(WorldState.read(tmp_path / "state.npz"))
    assert other.state_hash() == world.state_hash()
    for each in (world, other):
        each.step(3.0)
    hashes.add(world.state_hash())
    assert other.state_hash() == world.state_hash() and len(hashes) == 3
    world.restore(state)
    world.step(3.0)
    assert world.state_hash() in hashes


def test_a_damaged_order_is_refused(world):
    agent = world.spawn("human", (5.0, 5.0, 0.0))
    agent.go_to((35.0, 5.0, 0.0))
    state = agent.driver.save()
    orders = state.orders
    for wrong in (
        orders._replace(ticks=-1),
        orders._replace(ticks=10**9),
        orders._replace(order=orders.order._replace(goals=np.full((1, 3), np.nan))),
        orders._replace(order=orders.order._replace(place=np.zeros(2))),
        orders._replace(order=orders.order._replace(speed=0.0)),
        "orders",
    ):
        with pytest.raises((RuntimeInputError, LocomotionError)):
            agent.driver.restore(state._replace(orders=wrong))


def test_a_way_that_is_blocked_meanwhile_is_planned_anew():
    """There are two doors in a wall; the nearer one is shut while the way through it is planned."""
    sides, near, far = [(0.0, 0.0, 19.0, 20.0), (21.0, 0.0, 40.0, 20.0)], (19.0, 4.0, 21.0, 6.0), 14.0
    graph = floor(*sides, near, (19.0, far, 21.0, far + 2.0)).with_zones(
        {"near": [(20.0, 4.0, 0.0), (20.0, 6.0, 0.0)]}
    )
    world = World(graph)
    agent = world.spawn("human", (10.0, 5.0, 0.0))
    agent.go_to((30.0, 5.0, 0.0), speed=1.4)
    assert is_planning(agent)
    world.block("near")
    assert agent.status == "walking"
    until_planned(world, agent)
    assert agent.human.path[:, 1].max() > far
