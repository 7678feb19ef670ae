"""Dogs and people give way."""

import numpy as np
import pytest

from benchmarks.giving_way import floor
from locomotion.gaits.run.layout import STEPS
from navmesh.routes.route_validity import line_holds
from runtime import World
from runtime.traffic.traffic import Traffic


@pytest.fixture(scope="module")
def hall():
    return floor((0.0, 0.0, 20.0, 8.0))


@pytest.fixture(scope="module")
def door():
    return floor((0.0, 0.0, 9.8, 8.0), (9.8, 3.4, 10.2, 4.6), (10.2, 0.0, 20.0, 8.0))


def facing_each_other(graph, bodies, seed):
    """Two bodies that go to where about the other is."""
    world = World(graph, seed=seed)
    (x0, x1), (y0, y1) = world.random.uniform(-0.8, 0.8, (2, 2))
    starts = (4.0 + x0, 4.0 + 0.3 * y0, 0.0), (16.0 + x1, 4.0 + 0.3 * y1, 0.0)
    for body, start, goal, facing in zip(bodies, starts, reversed(starts), (0.0, np.pi), strict=True):
        world.spawn(body, start, facing).go_to(goal, speed=1.4)
    return world


def gap(world):
    """[m] between the two bodies' rims."""
    first, second = (
        discs
        for population in world._populations
        for discs in np.split(population.in_the_way(), max(len(population.followers()), 1))
        if len(discs)
    )
    away = np.linalg.norm(first[:, None, :2] - second[None, :, :2], axis=2)
    return float((away - first[:, None, 5] - second[None, :, 5]).min())


@pytest.mark.parametrize("bodies", [("dog", "dog"), ("human", "dog"), ("human", "human"), ("dog", "walker")])
@pytest.mark.parametrize("level", ["hall", "door"])
def test_two_who_meet_pass_each_other(bodies, level, request):
    graph = request.getfixturevalue(level)
    for seed in range(3):
        world = facing_each_other(graph, bodies, seed)
        nearest = np.inf
        while world.time < 40.0 and any(agent.moving for agent in world.agents.values()):
            world.step(0.05)
            nearest = min(nearest, gap(world))
        assert [agent.status for agent in world.agents.values()] == ["arrived"] * 2
        assert nearest > -0.01


def test_everybody_chooses_five_times_a_second_in_turns(hall, monkeypatch):
    world = World(hall)
    for k in range(12):
        world.spawn("dog" if k % 2 else "human", (2.0 + k, 4.0, 0.0))
    chosen = []
    monkeypatch.setattr(Traffic, "_let_choose", lambda _, __, turns, ___=None: chosen.append(turns.tolist()))
    for _ in range(40):
        world.step(0.01)
    assert max(map(len, chosen)) == 2 and len(chosen) == 20
    assert sorted(index for turns in chosen for index in turns) == sorted(2 * list(range(12)))


def test_ways_aside_stay_on_the_surface(door):
    world = facing_each_other(door, ("dog", "dog"), 1)
    before = [agent.plans[-1].points for agent in world.agents.values()]
    while any(agent.moving for agent in world.agents.values()):
        world.step(0.1)
        for agent in world.agents.values():
            assert line_holds(door, agent.plans[-1].points, agent.radius - 0.03)
    after = [agent.plans[-1].points for agent in world.agents.values()]
    assert any(len(a) != len(b) or not np.array_equal(a, b) for a, b in zip(before, after, strict=True))


def test_who_meets_nobody_goes_as_if_alone(hall):
    ends = []
    for company in (False, True):
        world = World(hall)
        agents = [world.spawn(body, (3.0, y, 0.0)) for body, y in (("dog", 1.0), ("human", 3.0))]
        for agent, y in zip(agents, (1.0, 3.0), strict=True):
            agent.go_to((17.0, y, 0.0), speed=1.4)
        if company:
            world.spawn("walker", (10.0, 7.0, 0.0))
        world.step(6.0)
        ends.append([agent.state_hash() for agent in agents])
    assert ends[0] == ends[1]


def test_a_restored_meeting_goes_on_the_same_way(hall):
    world = facing_each_other(hall, ("human", "dog"), 2)
    paces = set()
    while not paces & {0.0, 0.3, 0.6} and world.time < 8.0:
        world.step(0.1)
        paces |= {follower.pace for p in world._populations for follower in p.followers()}
    saved = world.save()
    world.step(6.0)
    end = world.state_hash()
    other = World(hall)
    other.restore(saved)
    other.step(6.0)
    assert other.state_hash() == end


def test_a_body_at_rest_on_the_goal_does_not_keep_others_away(hall):
    world = World(hall)
    world.spawn("dog", (10.0, 4.0, 0.0))
    late = world.spawn("dog", (4.0, 4.0, 0.0))
    late.go_to((10.2, 4.0, 0.0), speed=1.4)
    world.step(15.0)
    assert late.status == "arrived"


def overlaps(world):
    """How deep [m] the discs of any two bodies lie in each other."""
    bodies = [
        discs
        for population in world._populations
        if len(rows := population.in_the_way())
        for discs in np.split(rows, len(population.followers()) or len(rows))
    ]
    return max(
        float((a[:, None, 5] + b[:, 5] - np.linalg.norm(a[:, None, :2] - b[:, :2], axis=2)).max())
        for i, a in enumerate(bodies)
        for b in bodies[:i]
    )


@pytest.mark.parametrize(
    "bodies", [("dog", "dog", "dog"), ("human", "human", "human"), ("dog", "walker", "horse")]
)
def test_who_is_sent_to_one_place_comes_to_a_stand_beside_the_others(hall, bodies):
    for seed in range(3):
        world = World(hall, seed=seed)
        goal = np.array([10.0, 4.0, 0.0])
        for body, x in zip(bodies, (4.0, 15.0, 2.5), strict=True):
            agent = world.spawn(body, (x, 4.0 + world.random.uniform(-2.5, 2.5), 0.0))
            agent.go_to(goal, speed=1.4)
        deepest = -np.inf
        while world.time < 40.0 and any(agent.moving for agent in world.agents.values()):
            world.step(0.05)
            deepest = max(deepest, overlaps(world))
        assert [agent.status for agent in world.agents.values()] == ["arrived"] * 3
        assert deepest < 0.02
        away = [np.linalg.norm(agent.position - goal) for agent in world.agents.values()]
        assert min(away) < 1.0 and max(away) < 4.0


def test_who_is_told_again_to_go_where_others_stand_stays(hall):
    world = World(hall)
    world.spawn("dog", (10.0, 4.0, 0.0))
    late = world.spawn("dog", (4.0, 4.0, 0.0))
    goal = world.agents["dog1"].position
    late.go_to(goal, speed=1.4)
    world.step(10.0)
    stood = late.position
    for _ in range(20):
        late.go_to(goal, speed=1.4)
        world.step(0.5)
    assert late.status == "arrived" and np.linalg.norm(late.position - stood) < 0.01
    late.go_to((4.0, 4.0, 0.0), speed=1.4)
    world.step(10.0)
    assert late.status == "arrived" and np.linalg.norm(late.position[:2] - [4.0, 4.0]) < 0.3


def test_a_person_finishes_going_over_to_another_gait_before_it_gives_way():
    world = World(floor((0.0, 0.0, 40.0, 6.0)), walk="planned")
    runner = world.spawn("human", (2.0, 3.0, 0.0))
    runner.go_to((38.0, 3.0, 0.0), speed=3.0)
    asked = {}
    while runner.moving:
        world.step(0.01)
        human = runner.human
        slows, steps = human.gait_now == "slow run", human.control[STEPS]
        free = human.course() is not None
        if slows or (human.gait_now == "run" and steps < 4.0):
            assert not free
        asked.setdefault(human.gait_now, set()).add(free)
    assert asked == {"walk": {True, False}, "run": {True, False}, "slow run": {False}}


def test_a_runner_goes_round_others_no_sharper_than_it_can_slow_down():
    world = World(floor((0.0, 0.0, 40.0, 6.0)))
    runner = world.spawn("human", (2.0, 3.0, 0.0))
    runner.go_to((38.0, 3.0, 0.0), speed=3.3)
    world.step(5.0)
    course = runner.human.course()
    assert runner.status == "running" and course is not None
    assert (
        course.sharpest * course.speeds.max() ** 2 < 1.2
    )  # [m/s^2] in `locomotion.training.gaits.slow_down`


def test_a_runner_that_gives_way_altogether_walks_and_runs_on():
    world = World(floor((0.0, 0.0, 60.0, 6.0)))
    ends = []
    for told in (2.0, 2.3, 2.6, 2.9):  # one stop of many is a fall
        agent = world.spawn("human", (2.0, 3.0, 0.0))
        agent.go_to((58.0, 3.0, 0.0), speed=3.0)
        world.step(told)
        agent.human.give_way(0.0, None)
        world.step(6.0)
        slow = np.linalg.norm(agent.human.velocity[:2]) < 0.5
        agent.human.give_way(1.0, None)
        world.step(6.0)
        ends.append(slow and agent.status == "running" and agent.human.gait_now == "run")
        agent.remove()
    assert sum(ends) >= 3
