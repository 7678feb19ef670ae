"""Who waits for each other for ever goes back to let the others by, or says that it is stuck."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.giving_way import floor
from benchmarks.narrow_meetings import meet
from runtime import Stuck, World
from runtime.traffic.waiting_and_deadlock import GIVEN_UP, untangle


def until_at_rest(world, seconds):
    while world.time < seconds and any(agent.moving for agent in world.agents.values()):
        world.step(0.1)
    return [agent.status for agent in world.agents.values()]


@pytest.mark.parametrize(
    ("body", "width", "speed", "starts"),
    [
        ("human", 1.1, 1.4, (8.0, 22.0)),
        ("dog", 0.6, 1.6, (9.0, 20.0)),
        ("dog", 0.6, 1.4, (7.0, 22.0)),
    ],
)
def test_two_who_cannot_pass_in_a_corridor_say_so(body, width, speed, starts):
    world = World(floor((0.0, 0.0, 30.0, width)))
    for x, goal, facing in ((starts[0], 29.0, 0.0), (starts[1], 1.0, np.pi)):
        world.spawn(body, (x, 0.5 * width, 0.0), facing).go_to((goal, 0.5 * width, 0.0), speed=speed)
    assert until_at_rest(world, 150.0) == ["stuck", "stuck"]
    assert sum(isinstance(event, Stuck) for event in world.events) == 2


@pytest.mark.parametrize(
    ("body", "width", "starts"), [("human", 1.1, (11.0, 21.0)), ("dog", 0.6, (15.0, 26.0))]
)
def test_one_of_two_in_a_corridor_goes_back_to_let_the_other_by(body, width, starts):
    graph = floor(
        (0.0, 0.0, 14.0, 8.0), (14.0, 4.0 - 0.5 * width, 18.0, 4.0 + 0.5 * width), (18.0, 0.0, 32.0, 8.0)
    )
    world = World(graph)
    ends = (4.0, 4.0, 0.0), (28.0, 4.0, 0.0)
    for k, (start, facing) in enumerate(zip(starts, (0.0, np.pi), strict=True)):
        world.spawn(body, (start, 4.0, 0.0), facing).go_to(ends[1 - k], speed=1.4)
    assert until_at_rest(world, 150.0) == ["arrived", "arrived"]


@pytest.mark.parametrize(("kinds", "seed"), [(("dog", "human"), 101), (("cat", "horse"), 7)])
def test_nobody_walks_through_another_in_a_passage(kinds, seed):
    met = meet(kinds, seed)
    assert met["overlap"] == 0.0 and "moving" not in met["ended"]


def test_three_horses_in_a_small_yard_do_not_stand_for_ever_in_silence():
    for seed in range(3):
        world = World(floor((0.0, 0.0, 8.0, 8.0)), seed=seed)
        places = ((2.0, 2.0), (5.5, 2.5), (3.0, 5.5))
        goals = world.random.uniform(1.5, 6.5, (3, 2))
        for place in places:
            world.spawn("horse", (*place, 0.0), world.random.uniform(-np.pi, np.pi))
        for agent, goal in zip(world.agents.values(), goals, strict=True):
            agent.go_to((*goal, 0.0), speed=1.4)
        until_at_rest(world, 200.0)
        assert not any(agent.moving for agent in world.agents.values())


def test_ten_who_queue_at_a_door_are_not_stuck():
    graph = floor((0.0, 0.0, 10.0, 8.0), (10.0, 3.5, 10.4, 4.5), (10.4, 0.0, 24.0, 8.0))
    world = World(graph)
    for k in range(10):
        row, column = divmod(k, 5)
        agent = world.spawn("human", (7.0 - 1.5 * row, 1.0 + 1.5 * column, 0.0))
        agent.go_to((22.0 - 1.5 * row, 1.0 + 1.5 * column, 0.0), speed=1.4)
    assert until_at_rest(world, 150.0) == ["arrived"] * 10
    assert not any(isinstance(event, Stuck) for event in world.events)


class Standing:
    """A follower that has waited for a while and cannot go back."""

    def __init__(self, waited):
        self.waited, self.status = waited, "walking"

    def way_back(self):
        return None

    def give_up(self):
        self.status = "stuck"


def moment_of(followers):
    """Who stands in a row, each near the next only."""
    n = len(followers)
    apart = np.abs(np.arange(n)[:, None] - np.arange(n))
    return SimpleNamespace(
        followers=followers,
        near=lambda indices: (apart == 1)[indices],
        forget=lambda index: None,
        discs=[np.array([[k, 0.0, 0.0, 0.0, 0.0, 0.3]]) for k in range(n)],
    )


@pytest.mark.parametrize(("first", "status"), [(GIVEN_UP + 1.0, "stuck"), (1.0, "walking"), (None, "stuck")])
def test_who_waits_in_a_queue_is_not_stuck_while_the_first_gets_on(first, status):
    """The first of three: stands as long, gets on, or has arrived."""
    queue = [Standing(first), Standing(GIVEN_UP + 5.0), Standing(GIVEN_UP + 5.0)]
    untangle(moment_of(queue), 2, floor((0.0, 0.0, 4.0, 4.0)))
    assert queue[2].status == status
