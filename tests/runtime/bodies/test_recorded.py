"""Recorded persons in worlds: they go, take postures, are seen, saved and removed."""

import numpy as np
import pytest

from locomotion.recorded_people import layout as at
from navmesh import NodeGraph, Terrain
from runtime import Arrived, PostureReached, RuntimeInputError, World, WorldState
from runtime.bodies.joints import person_figure
from runtime.bodies.recorded import RecordedDriver
from runtime.evaluation.courses import make_course
from runtime.traces.recording import Recorder


def test_a_recorded_person_goes_as_a_walker_does_and_looks_like_a_person(graph):
    world = World(graph)
    ada = world.spawn("human", (2.0, 3.0, 0.0), detail="medium", name="ada")
    world.spawn("walker", (5.5, 3.1, 0.0))
    assert ada.level == ada.detail == "medium" and isinstance(ada.driver, RecordedDriver)
    assert ada.figure is person_figure(1.0) and ada.pose.transforms.shape == (20, 7)
    simulated = world.spawn("human", (2.0, 5.0, 0.0))
    assert ada.figure.bodies == simulated.figure.bodies
    apart = ada.pose.transforms[:, :3] - simulated.pose.transforms[:, :3] + [0.0, 2.0, 0.0]
    assert np.abs(apart).max() < 0.25  # both stand
    recorder = Recorder(world)
    assert ada.go_to((9.0, 3.0, 0.0), speed=1.5) == "walking"
    while ada.moving:
        world.step(0.1)
        recorder.sample()
    assert isinstance(recorder.events[-1], Arrived) and ada.progress == 1.0
    assert recorder.trace({}).agents[0].poses.shape[1:] == (20, 7)
    world.step(0.013)
    assert np.abs(ada.blended_pose.transforms - ada.pose.transforms).max() < 0.05


def test_a_world_with_recorded_people_comes_back_from_a_file(graph, tmp_path):
    world = World(graph, seed=3)
    for k in range(4):
        world.spawn("human", (2.0 + k, 3.0, 0.0), detail=("low", "full")[k % 2])
    agents = list(world.agents.values())
    agents[0].go_to((9.0, 3.0, 0.0), speed=1.4)
    agents[1].take_posture("kneel")
    agents[2].take_posture("prone")
    world.step(1.0)
    agents[2].go_to((9.0, 4.0, 0.0), speed=1.4)  # it gets up first
    world.save().write(tmp_path / "state.npz")
    world.step(4.0)
    other = World(graph, seed=3)
    other.restore(WorldState.read(tmp_path / "state.npz"))
    other.step(4.0)
    assert other.state_hash() == world.state_hash()
    for name, agent in world.agents.items():
        np.testing.assert_array_equal(other.agents[name].pose.transforms, agent.pose.transforms)
    here = agents[3].position
    world.remove(agents[0])
    np.testing.assert_array_equal(agents[3].position, here)


def test_a_world_with_somebody_at_an_obstacle_comes_back_from_a_file(tmp_path):
    """Before it, in the run-up and over it."""
    course = make_course([("jump", 0.4, 0.3)], [6.0])
    graph = NodeGraph.build(Terrain.from_arrays(course.vertices, course.faces))
    world, stages = World(graph, seed=3), []
    ada = world.spawn("human", (0.0, 0.0, 0.0), detail="full")
    ada.go_to((course.obstacles[0].position[0] + 4.0, 0.0, 0.0), speed=3.0)
    while ada.moving:
        world.step(0.2)
        stage = ada.driver.person.row[at.CROSSES]
        if stage not in stages:
            stages.append(stage)
            world.save().write(tmp_path / f"{stage}.npz")
    assert stages == [at.APPROACHES, at.RUNS_UP, at.CLEARS, at.NOTHING]
    for stage in stages:
        other = World(graph, seed=3)
        other.restore(WorldState.read(tmp_path / f"{stage}.npz"))
        other.step(world.time - other.time)
        assert other.state_hash() == world.state_hash()


def test_a_damaged_state_of_one_is_refused(graph):
    world = World(graph)
    ada = world.spawn("human", (2.0, 3.0, 0.0), detail="low")
    saved, plans = ada.driver.save()
    row = saved.row.copy()
    row[at.LEVEL] = 9.0
    for wrong in ((saved.__class__(saved.body, row, None, "", None), plans), (saved,), None):
        with pytest.raises(ValueError):
            ada.driver.restore(wrong)


def test_it_does_not_jump_when_its_detail_changes(graph):
    world = World(graph)
    ada = world.spawn("human", (2.0, 3.0, 0.0), detail="full")
    ada.go_to((10.0, 3.0, 0.0), speed=1.3)
    world.step(1.5)
    for detail in ("low", "medium", "full", "low"):
        before = ada.pose.transforms
        ada.detail = detail
        assert ada.level == detail
        np.testing.assert_allclose(ada.pose.transforms, before, atol=1e-9)
        world.step(0.21)


def test_what_it_cannot_be_is_said_and_changes_nothing(graph):
    world = World(graph)
    ada = world.spawn("human", (2.0, 3.0, 0.0), detail="low")
    for wrong, says in (
        (lambda: ada.take_posture("fly"), "posture 'fly': valid: stand"),
        (lambda: ada.hold("spear"), "object 'spear': valid: rifle"),
        (lambda: setattr(ada, "detail", "high"), "valid: auto, physics"),
        (lambda: ada.human, "plays recorded motion"),
        (lambda: world.spawn("walker", (4.0, 3.0, 0.0), detail="low"), "valid: physics"),
        (lambda: world.spawn("walker", (4.0, 3.0, 0.0)).take_posture("kneel"), "no postures"),
    ):
        with pytest.raises(RuntimeInputError, match=says):
            wrong()
    ada.take_posture("dead")
    world.step(3.0)
    assert [event.posture for event in world.events if isinstance(event, PostureReached)] == ["dead"]
    with pytest.raises(RuntimeInputError, match="no way from 'dead'"):
        ada.take_posture("stand")
    with pytest.raises(RuntimeInputError, match="no way from 'dead'"):
        ada.go_to((9.0, 3.0, 0.0))


def test_what_its_hands_cannot_hold_in_a_posture_they_stow(graph):
    world = World(graph)
    ada = world.spawn("human", (2.0, 3.0, 0.0), detail="low")
    ada.hold("rifle")
    world.step(1.5)
    ada.take_posture("kneel")
    world.step(1.5)
    assert (ada.posture, ada.held) == ("kneel", ("rifle", "deployed"))
    ada.take_posture("all-fours")
    world.step(3.0)
    assert (ada.posture, ada.held) == ("all-fours", ("", "stowed"))
    told = [str(event) for event in world.events if isinstance(event, PostureReached)]
    assert told[0] == "human1 is in the posture stand, rifle deployed"


def test_each_differs_from_the_next_by_chance_and_by_hand(graph):
    world = World(graph, seed=2)
    people = [world.spawn("human", (1.0 + 0.7 * k, 3.0, 0.0), detail="full") for k in range(10)]
    for agent in people:
        agent.go_to((agent.position[0] + 4.0, 5.0, 0.0), speed=1.2)
    world.step(1.5)
    rows = np.array([agent.driver.person.row for agent in people])
    assert abs(np.exp(2j * np.pi * rows[:, at.PHASE]).mean()) < 0.7  # not in step
    assert (rows[:, at.TRAITS][:, :6].std(axis=0) > 0.003).all() and (rows[:, at.TRAITS][:, 6] == 1.0).all()
    before = people[0].pose.transforms
    people[0].set_style(lean=0.25, arms=1.8)
    np.testing.assert_allclose(people[0].pose.transforms, before, atol=1e-9)  # it goes over to it
    world.step(1.0)
    row = people[0].driver.person.row
    assert row[at.TRAITS][3] == 1.8 and row[at.TRAITS][1] == rows[0, at.TRAITS][1]
    for wrong, says in (
        ({"limp": 1.0}, "valid: phase"),
        ({"lean": 2.0}, "lean is 2.0, expected a number from -0.2"),
        ({"lean": "x"}, "lean is .x., expected a number"),
        ({"size": 1.3}, "size is 1.3, expected a number from 0.8 to 1.2"),
    ):
        with pytest.raises(RuntimeInputError, match=says):
            people[0].set_style(**wrong)
    with pytest.raises(RuntimeInputError, match="only people have"):
        world.spawn("walker", (9.0, 2.0, 0.0)).set_style(arms=1.0)


def test_a_style_outlasts_physics_and_is_taken_at_any_level(graph, tmp_path):
    world = World(graph, seed=1)
    ada = world.spawn("human", (3.0, 3.0, 0.0), detail="full")
    bob = world.spawn("human", (6.0, 3.0, 0.0))
    ada.set_style(arms=1.6, lean=0.2)
    bob.set_style(arms=1.4)
    with pytest.raises(RuntimeInputError, match="lean is 2"):
        bob.set_style(lean=2.0)
    ada.detail = "physics"
    world.step(1.0)
    assert ada.level == bob.level == "physics"
    world.save().write(tmp_path / "state.npz")
    plain = world.state_hash()
    other = World(graph, seed=1)
    other.restore(WorldState.read(tmp_path / "state.npz"))
    assert other.state_hash() == plain
    for each in (world, other):
        for name in (ada.name, bob.name):
            each.agents[name].detail = "full"
        each.step(1.0)
        traits = [each.agents[name].driver.person.row[at.TRAITS] for name in (ada.name, bob.name)]
        assert traits[0][[3, 4]].tolist() == [1.6, 0.2] and traits[1][3] == 1.4
    assert other.state_hash() == world.state_hash() != plain


@pytest.mark.parametrize("level", ["full", "low"])
@pytest.mark.parametrize("size", [0.88, 1.08])
def test_a_person_of_another_size_stands_goes_and_kneels_on_the_ground(graph, level, size):
    world = World(graph, seed=2)
    ada, bob = (world.spawn("human", (1.0, 3.0 + k, 0.0), detail=level) for k in range(2))
    for agent, large in ((ada, size), (bob, 1.0)):
        agent.set_style(size=large, pace=1.0, lean=0.0, head=0.0)
    world.step(2.0)
    ankle, head = ada.figure.bodies.index("right_foot"), ada.figure.bodies.index("head")
    for part in (head, ankle):
        assert ada.pose.transforms[part, 2] == pytest.approx(size * bob.pose.transforms[part, 2], abs=0.01)
    np.testing.assert_allclose(ada.figure.shapes.size, size * bob.figure.shapes.size)
    np.testing.assert_allclose(ada.driver.joints.offsets, size * bob.driver.joints.offsets)
    for agent in (ada, bob):
        agent.go_to((6.0, agent.position[1], 0.0), speed=1.3)
    world.step(2.0)
    cadences = [agent.driver._population.people.cadence(agent.driver.person.index) for agent in (ada, bob)]
    assert (cadences[0] > cadences[1]) == (size < 1.0)  # shorter people take more steps
    lowest = []
    while ada.moving:
        world.step(0.05)
        lowest.append(ada.pose.transforms[:, 2].min())
    assert min(lowest) > 0.01 and max(lowest) < 0.08
    for agent in (ada, bob):
        agent.take_posture("kneel")
    world.step(4.0)
    assert ada.pose.transforms[head, 2] == pytest.approx(size * bob.pose.transforms[head, 2], abs=0.01)
    state = world.save()
    ada.set_style(size=1.0)
    world.restore(state)
    np.testing.assert_allclose(world.agents[ada.name].figure.shapes.size, size * bob.figure.shapes.size)


def test_people_who_come_from_physics_differ_too(graph):
    world = World(graph, seed=2)
    people = [world.spawn("human", (1.0 + 0.7 * k, 3.0, 0.0)) for k in range(3)]
    for agent in people:
        agent.detail = "full"
    world.step(1.0)
    rows = np.array([agent.driver.person.row for agent in people])
    assert len(np.unique(rows[:, at.TRAITS], axis=0)) == 3


@pytest.mark.parametrize("visit", ["detail", "posture"])
def test_traits_by_chance_are_the_same_after_physics(graph, tmp_path, visit):
    """Elsewhere than before, so that chance would give others; also in a world restored in between."""
    world = World(graph, seed=5)
    ada = world.spawn("human", (2.0, 3.0, 0.0), detail="full")
    bob = world.spawn("human", (2.0, 2.0, 0.0), detail="full")
    before = {each.name: dict(each.driver.traits) for each in (ada, bob)}
    assert before[ada.name] != before[bob.name]
    for each in (ada, bob):
        each.detail = "physics"
    world.step(1.0)
    for each in (ada, bob):
        each.go_to((3.5, each.position[1], 0.0), speed=1.3)
    while ada.moving or bob.moving:
        world.step(0.5)
    world.step(1.0)
    assert ada.level == bob.level == "physics" and ada.driver.traits == before[ada.name]
    ada.set_style(arms=1.9)
    before[ada.name]["arms"] = 1.9
    world.save().write(tmp_path / "state.npz")
    other = World(graph, seed=5)
    other.restore(WorldState.read(tmp_path / "state.npz"))
    for each in (world, other):
        for name in before:
            agent = each.agents[name]
            if visit == "detail":
                agent.detail = "low"
            else:
                agent.take_posture("kneel")
        each.step(0.5)
        for name, traits in before.items():
            assert each.agents[name].level != "physics"
            assert each.agents[name].driver.traits == traits
    assert other.state_hash() == world.state_hash()


def test_traits_by_chance_of_who_was_simulated_first_are_the_same_on_every_visit(graph):
    world = World(graph, seed=5)
    ada = world.spawn("human", (2.0, 3.0, 0.0))
    ada.set_style(arms=1.4)
    ada.detail = "low"
    world.step(1.0)
    seen = dict(ada.driver.traits)
    assert ada.level == "low" and seen["arms"] == 1.4
    ada.detail = "physics"
    world.step(1.0)
    ada.go_to((3.5, 3.0, 0.0), speed=1.3)
    while ada.moving:
        world.step(0.5)
    ada.detail = "low"
    world.step(1.0)
    assert ada.level == "low" and ada.driver.traits == seen
