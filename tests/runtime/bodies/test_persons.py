"""People who go over from physics to recorded motion and back (`runtime.bodies.persons`)."""

import numpy as np
import pytest

from benchmarks.giving_way import floor
from locomotion.human.falls import fall
from locomotion.human.human import Human
from locomotion.rehearsal.sharing import REHEARSAL_TICKS
from runtime import Budget, Fell, PostureReached, RuntimeInputError, Viewer, World
from runtime.bodies import persons, recorded


@pytest.mark.parametrize("moves", [False, True])
def test_a_simulated_person_takes_a_posture_without_a_jump_and_is_simulated_again(graph, moves):
    world = World(graph)
    ada = world.spawn("human", (2.0, 3.0, 0.0))
    usual = 0.06
    if moves:
        bob = world.spawn("human", (2.0, 2.0, 0.0), detail="full")  # feet that swing are faster than the rest
        for each in (ada, bob):
            each.go_to((9.0, each.position[1], 0.0), speed=1.2)
        world.step(1.0)
        for _ in range(60):
            before = bob.pose.transforms
            world.step(1 / 60)
            usual = max(usual, np.abs(bob.pose.transforms[:, :3] - before[:, :3]).max())
    before = ada.pose.transforms
    ada.take_posture("kneel")
    assert ada.level == "full" and ada.detail == "physics"
    np.testing.assert_allclose(ada.pose.transforms, before, atol=1e-9)
    steps = []
    for posture in ("kneel", "stand"):
        ada.take_posture(posture)
        for _ in range(200):
            world.step(1 / 60)
            steps.append(np.abs(ada.pose.transforms[:, :3] - before[:, :3]).max())
            before = ada.pose.transforms
    assert max(steps) < usual
    assert ada.level == "physics" and ada.human.status == "standing"
    assert [e.posture for e in world.events if isinstance(e, PostureReached)] == ["kneel", "stand"]


def test_who_asks_waits_for_what_is_read_and_no_tick_does(graph, monkeypatch):
    """The first who asks cannot change at once: it lies on the ground."""
    read, make = [], recorded.RecordedPeople

    def people(*what, **more):
        read.append("people")
        return make(*what, **more)

    monkeypatch.setattr(recorded, "RecordedPeople", people)
    monkeypatch.setattr(persons, "moments", lambda: read.append("moments"))
    world = World(graph)
    ada, bob = world.spawn("human", (2.0, 3.0, 0.0)), world.spawn("human", (4.0, 3.0, 0.0))
    assert not read
    fall(ada.human, True)
    ada.detail = "full"
    assert ada.level == "physics" and set(read) == {"people", "moments"}
    bob.take_posture("kneel")
    world.step(0.5)
    assert bob.level == "full" and read.count("people") == 1


def test_standing_is_no_change(graph):
    world = World(graph)
    ada = world.spawn("human", (2.0, 3.0, 0.0))
    ada.take_posture("stand")
    world.step(0.1)
    assert ada.level == "physics"
    assert [e.posture for e in world.events if isinstance(e, PostureReached)] == ["stand"]


def test_who_comes_near_a_viewer_is_simulated_and_who_is_far_is_not(graph):
    world = World(graph)
    people = [world.spawn("human", (2.0 + k, 3.0, 0.0), detail="auto") for k in range(4)]
    assert {each.level for each in people} == {"low"} and {each.detail for each in people} == {"auto"}
    world.budget = Budget(physics=2, full=1)
    world.viewers = [Viewer((0.0, 3.0, 1.7))]
    world.step(0.5)
    assert [each.level for each in people] == ["physics", "physics", "full", "medium"]
    saved = world.save()
    world.viewers = [Viewer((6.5, 3.0, 1.7), (-1.0, 0.0, 0.0))]
    world.step(0.5)
    assert [each.level for each in people] == ["medium", "full", "physics", "physics"]
    after = world.state_hash()
    world.restore(saved)
    assert [each.level for each in people] == ["physics", "physics", "full", "medium"]
    assert world.viewers == (Viewer((0.0, 3.0, 1.7)),) and isinstance(world.budget, Budget)
    world.viewers = [Viewer((6.5, 3.0, 1.7), (-1.0, 0.0, 0.0))]
    world.step(0.5)
    assert world.state_hash() == after


@pytest.mark.parametrize("fresh", [True, False])
def test_after_a_change_to_physics_and_back_a_restored_world_goes_on_the_same_way(graph, fresh):
    world = World(graph)
    ada = world.spawn("human", (2.0, 3.0, 0.0), detail="full", name="ada")
    bob = world.spawn("human", (4.0, 2.5, 0.0), detail="full", name="bob")
    before = world.save()
    for detail in ("physics", "full"):
        ada.detail = detail
        world.step(0.6)
        assert ada.level == detail
    ada.go_to((9.0, 3.5, 0.0), speed=1.3)
    bob.go_to((2.0, 2.0, 0.0), speed=1.3)
    world.step(0.7)
    saved, ends = world.save(), []
    for each in (world, World(graph) if fresh else world):
        if ends:
            each.restore(before if each is world else saved)  # bodies in another order
            each.restore(saved)
        assert list(each.agents) == ["ada", "bob"]
        poses = []
        for _ in range(40):
            each.step(0.05)
            poses += [places.tobytes() for places in each.transforms().values()]
        ends.append((each.state_hash(), poses))
    assert ends[0] == ends[1]


# --- in the middle of a run, so near its goal that it has to slow down at once, without having rehearsed it
@pytest.fixture(scope="module")
def plain():
    return floor((-5.0, -10.0, 40.0, 10.0))


def runner(plain, left=8.5, threads=1):
    """A world in which ada runs in recorded motion and has ``left`` [m] to go, and bob is simulated."""
    world = World(plain, seed=5, threads=threads)
    ada = world.spawn("human", (0.0, 0.0, 0.0), detail="low", name="ada")
    bob = world.spawn("human", (0.0, 5.0, 0.0), name="bob")
    ada.go_to((20.0, 0.0, 0.0), speed=3.5)
    bob.go_to((30.0, 5.0, 0.0), speed=3.0)
    while ada.position[0] < 20.0 - left:
        world.step(0.01)
    return world, ada


def test_a_runner_goes_over_to_physics_at_once_and_no_tick_is_long(plain, monkeypatch):
    world, ada = runner(plain)
    made, tick = [0], Human._tick

    def counted(human):
        made[0] += 1
        tick(human)

    monkeypatch.setattr(Human, "_tick", counted)
    ada.detail = "physics"
    assert ada.level == "physics"
    world.step(0.01)
    assert not ada.human.on_feet.walks
    while ada.moving:
        made[0] = 0
        world.step(0.01)
        assert made[0] <= REHEARSAL_TICKS + 1 + len(world.agents)
    assert ada.status == "arrived"


@pytest.mark.parametrize("then", ["nothing", "goes on", "stops", "is pushed"])
def test_a_runner_that_goes_over_to_physics_stays_up_and_is_restored(plain, then):
    world, ada = runner(plain)
    ada.detail = "physics"
    world.step(0.15)
    saved, hashes = world.save(), []
    for each in (world, World(plain, seed=5, threads=2)):
        each.restore(saved)
        ada = each.agents["ada"]
        if then == "goes on":
            ada.go_to((35.0, 2.0, 0.0), speed=2.0)
        elif then == "stops":
            ada.stop()
        for tick in range(500):
            pushed = then == "is pushed" and tick < 5
            ada.human.data.xfrc_applied[1, 1] = 60.0 if pushed else 0.0
            each.step(0.01)
        assert not [event for event in each.events if isinstance(event, Fell)]
        hashes.append(each.state_hash())
    assert hashes[0] == hashes[1]


def test_who_lies_on_the_ground_takes_no_posture_but_the_last(graph):
    world = World(graph)
    ada = world.spawn("human", (3.0, 3.0, 0.0), detail="auto")
    world.viewers = [Viewer((0.0, 3.0, 1.7))]
    world.step(0.11)
    fall(ada.human, True)
    world.viewers = []
    world.step(0.3)
    assert ada.level == "physics"  # it does not rise like a ghost
    with pytest.raises(RuntimeInputError, match="is getting up; it takes a posture once it stands"):
        ada.take_posture("kneel")
    ada.take_posture("dead")
    assert ada.level == "full"


def test_what_a_change_of_level_needs_is_made_with_the_first_who_may_change(graph, monkeypatch):
    made = []
    monkeypatch.setattr("runtime.bodies.persons.moments", lambda: made.append(1))
    world = World(graph)
    world.spawn("human", (2.0, 3.0, 0.0), detail="low")
    assert not made
    world.spawn("human", (4.0, 3.0, 0.0), detail="auto")
    assert made
