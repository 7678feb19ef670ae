"""All bodies at one moment: where they will be, who stands at a goal, and who leaves first."""

import numpy as np
import pytest

from benchmarks.giving_way import HALL, floor
from locomotion.avoidance.yielding import COUNT, STEP
from runtime import World
from runtime.traffic.snapshot import Snapshot


@pytest.fixture(scope="module")
def hall():
    return floor(*HALL)


def test_a_dog_is_foretold_where_it_will_be(hall):
    """As it slows down, halts, turns, and goes on."""
    world = World(hall)
    dog = world.spawn("dog", (10.0, 5.0, 0.0))
    dog.go_to((24.0, 5.0, 0.0), speed=1.4)
    dogs = next(each for each in world._populations if each.followers())
    driver = dogs.followers()[0]
    seen = set()

    def hold(seconds):
        told = Snapshot(world._populations).foretold(0)
        for k in range(round(seconds / STEP)):
            away = np.linalg.norm(dogs.in_the_way()[:, :2] - told[k], axis=1)
            assert away.max() < 0.1, (driver.animal._phase, k)
            seen.add(driver.animal._phase)
            world.step(STEP)

    world.step(2.0)
    driver.give_way(0.0, None)
    hold(3.0)
    driver.give_way(1.0, None)
    world.step(2.0)
    dog.go_to((4.0, 5.0, 0.0), speed=1.4)
    hold(0.5)
    while driver.animal._phase != "turning":
        world.step(0.01)
    hold(1.0)
    while driver.animal._phase != "following":
        world.step(0.01)
    world.step(1.0)
    hold(COUNT * STEP)  # to its goal: with the front feet on it
    assert seen >= {"following", "halting", "turning"}


def told_and_real(world, seconds):
    """(k, 2) each: where the only one was foretold to be, and where it came to be."""
    told = Snapshot(world._populations).foretold(0)[:, 0]
    agent, real = next(iter(world.agents.values())), []
    for _ in range(round(seconds / STEP)):
        real.append(agent.position[:2])
        world.step(STEP)
    return told[: len(real)], np.array(real)


@pytest.mark.parametrize(
    ("walked", "speed", "goal", "within"),
    [
        (0.0, 1.4, (2.0, 3.0), 0.8),  # turns on the spot
        (5.0, 1.4, (2.0, 5.0), 1.0),  # comes to a stand first
        (5.0, 1.4, None, 0.7),  # stops
        (5.0, 3.0, None, 1.2),  # from a run
    ],
)
def test_a_person_is_foretold_where_it_will_be(hall, walked, speed, goal, within):
    world = World(hall)
    person = world.spawn("human", (5.0, 5.0, 0.0))
    if walked:
        person.go_to((28.0, 5.0, 0.0), speed=speed)
        world.step(walked)
    if goal is None:
        person.driver.stop()
    else:
        person.go_to((*goal, 0.0), speed=speed)
        world.step(0.1)  # its path is planned meanwhile
    told, real = told_and_real(world, 4.0)
    assert np.linalg.norm(told - real, axis=1).max() < within


def snapshot(world):
    return Snapshot(world._populations)


def spawned(hall, *bodies):
    """Bodies in a row along y = 5, each 0.4 m behind the one before; those that go go along x."""
    world = World(hall)
    return world, [world.spawn(body, (10.0 - 0.4 * k, 5.0, 0.0)) for k, body in enumerate(bodies)]


def test_those_that_can_give_way_come_first(hall):
    world = World(hall)
    for body, x in (("walker", 3.0), ("human", 6.0), ("dog", 9.0), ("walker", 12.0)):
        world.spawn(body, (x, 5.0, 0.0))
    seen = snapshot(world)
    assert len(seen) == 4 and len(seen.followers) == 2
    middle = [discs[:, 0].mean() for discs in seen.discs]
    assert middle == pytest.approx([6.0, 9.0, 3.0, 12.0], abs=0.3)
    assert (seen.discs[-1] == list(seen.discs)[3]).all() and len(seen.discs[-1]) > 0
    with pytest.raises(IndexError):
        seen.discs[4]
    assert len(seen.others(0)) == sum(map(len, list(seen.discs)[1:]))


def test_a_walker_is_foretold_straight_on_for_a_second(hall):
    world = World(hall)
    walker = world.spawn("walker", (5.0, 5.0, 0.0))
    walker.go_to((20.0, 5.0, 0.0), speed=1.5)
    world.step(2.0)
    there, radii = snapshot(world).all_foretold([0])
    assert radii.tolist() == [walker.radius] and there.shape == (COUNT, 1, 2)
    at = walker.position
    one = round(1.0 / STEP)
    expected = at[0] + 1.5 * STEP * np.arange(one)
    assert there[:one, 0, 0] == pytest.approx(expected, abs=0.05)
    assert (there[one:] > 1e5).all()  # it steps aside for others: not foretold any further
    nobody, none = snapshot(world).all_foretold([])
    assert nobody.shape == (COUNT, 0, 2) and none.shape == (0,)


def test_who_stands_at_a_goal_ends_the_course_before_it(hall):
    world = World(hall)
    runner = world.spawn("human", (5.0, 5.0, 0.0))
    runner.go_to((7.5, 5.0, 0.0), speed=1.4)
    world.step(2.0)
    world.spawn("walker", (7.5, 5.0, 0.0))
    seen = snapshot(world)
    whole, course = seen.followers[0].course(), seen.course(0)
    assert whole.whole and not course.whole
    assert whole.points[-1, 0] == pytest.approx(7.5, abs=0.2)
    assert 7.5 - course.points[-1, 0] > 2 * 0.3  # it touches nobody there
    assert seen.group(0)[:, :2] == pytest.approx(np.array([[7.5, 5.0]]))


def test_of_two_that_overlap_the_one_ahead_leaves(hall):
    world, (first, second) = spawned(hall, "human", "human")
    for agent in (first, second):
        agent.go_to((24.0, 5.0, 0.0), speed=1.4)
    world.step(0.1)  # their paths are planned meanwhile
    seen = snapshot(world)
    assert seen.gets_away(0, 1) and not seen.gets_away(1, 0)
    apart = spawned(hall, "human")[0]
    apart.spawn("human", (15.0, 5.0, 0.0))
    assert not snapshot(apart).gets_away(0, 1)


def test_only_those_that_come_near_are_looked_at(hall):
    world = World(hall)
    for x in (5.0, 7.0, 25.0):
        world.spawn("human", (x, 5.0, 0.0))
    assert snapshot(world).near(np.array([0, 2])).tolist() == [[False, True, False], [False, False, False]]
