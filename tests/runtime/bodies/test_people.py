"""People in a world: how much they rehearse, and that they do not step as one."""

import numpy as np
import pytest

import navmesh
from benchmarks.giving_way import floor
from locomotion.clips import clip
from locomotion.ground.ground import extruded
from locomotion.rehearsal.lookahead import Lookahead
from locomotion.skills.jump.skill import jump_clip
from locomotion.skills.vault.skill import vault_clip
from runtime import RuntimeInputError, World
from runtime.bodies.human_driver import HumanDriver
from runtime.bodies.people import People
from runtime.evaluation.courses import make_course
from runtime.planning.level import Level


def test_people_rehearse_as_much_as_their_world_says(graph, monkeypatch):
    def fails(body):
        yield
        return 0.0, []

    monkeypatch.setattr(Lookahead, "go_on", lambda *_: 0)  # all at the moment
    with pytest.raises(RuntimeInputError, match="rehearsals must be"):
        World(graph, rehearsals=-1)
    course = make_course([("jump", 0.4, 0.0)], [10.0])
    terrain = navmesh.Terrain.from_arrays(course.vertices, course.faces)
    tried = []
    for most in (0, 1, 3):
        world = World(terrain, rehearsals=most, rehearsal_ticks=None)
        human = world.spawn("human", (0.0, 0.0, 0.0)).human
        seen = []
        choose = human.decider.best
        human.decider.best = lambda body, choices, do, goes, takes, seen=seen, choose=choose: choose(
            body, choices, lambda body, choice: (seen.append(choice), do(body, choice)), fails, takes
        )
        world.agents["human1"].go_to((20.0, 0.0, 0.4), speed=3.0)
        while not seen and world.time < 12.0:
            world.step(0.01)
        tried.append(len(seen))
    assert tried == [0, 1, 3]


def test_people_who_are_told_the_same_do_not_step_as_one():
    graph = floor((-5.0, -15.0, 25.0, 15.0))

    def eight(seed):
        world = World(graph, seed=seed)
        return world, [world.spawn("human", (0.0, 3.0 * k - 10.5, 0.0)) for k in range(8)]

    def pauses(seed):
        return [agent.driver.hesitates for agent in eight(seed)[1]]

    assert pauses(4) == pauses(4) != pauses(5)
    world, agents = eight(4)
    for k, agent in enumerate(agents):
        agent.go_to((20.0, 3.0 * k - 10.5, 0.0), speed=1.4)
    world.step(3.0)
    along = np.array([agent.position[0] for agent in agents])
    assert len(set(along.round(3))) >= 7
    assert np.ptp(along) < 0.8  # none is left behind by it


@pytest.fixture
def people(graph):
    return People(Level.of(graph), seed=3)


def test_they_are_where_they_were_put_and_go_one_by_one(people):
    first, second = (people.spawn("human", np.array([x, 3.0, 0.0]), 0.5, 0.3) for x in (2.0, 4.0))
    assert first.facing == pytest.approx(0.5, abs=0.05)
    assert people.in_the_way()[:, [0, 1, 5]] == pytest.approx(np.array([[2, 3, 0.3], [4, 3, 0.3]]), abs=0.05)
    people.remove(first)
    assert people.followers() == [second]
    people.remove(second)
    assert people.in_the_way().shape == (0, 6)


def test_one_that_is_revived_hesitates_as_long_as_before(people):
    driver = people.spawn("human", np.array([2.0, 3.0, 0.0]), 0.0, 0.3)
    assert isinstance(driver, HumanDriver) and 0.0 <= driver.hesitates <= 0.4
    again = people.revive("human", driver.save())
    assert isinstance(again, HumanDriver) and again.hesitates == driver.hesitates
    assert again.state_hash() == driver.state_hash()


def test_people_walk_as_their_world_says():
    level = floor((0.0, 0.0, 20.0, 4.0))
    with pytest.raises(RuntimeInputError, match="walk must be one of 'learned', 'planned', not 'limp'"):
        World(level, walk="limp")
    world = World(level, walk="learned")
    agent = world.spawn("human", (2.0, 2.0, 0.0))
    agent.go_to((18.0, 2.0, 0.0), speed=1.2)
    while not agent.human.on_feet.walks_as_learned and world.time < 10.0:
        world.step(0.01)
    assert agent.human.on_feet.walks_as_learned
    assert not World(level, walk="planned").spawn("human", (2.0, 2.0, 0.0)).human.on_feet.walks_as_learned


def crowd(graph, threads):
    """Hashes of five people who run about in a world, and are told to stop and go on."""
    world, chance = World(graph, seed=2, threads=threads), np.random.default_rng(2)
    for k in range(5):
        world.spawn("human", (2.0, 1.5 * k - 3.0, 0.0))
    seen = []
    for tick in range(400):
        if tick % 130 == 0:
            for agent in world.agents.values():
                agent.go_to((float(chance.uniform(10.0, 22.0)), float(chance.uniform(-4.0, 4.0)), 0.0), 3.0)
        if tick == 300:
            world.agents["human1"].stop()
        world.step(0.01)
        seen.append(world.state_hash())
    return seen


def test_any_number_of_threads_gives_the_same_run():
    graph = floor((-5.0, -8.0, 25.0, 8.0))
    alone = crowd(graph, 1)
    assert crowd(graph, 2) == crowd(graph, 4) == alone


@pytest.mark.parametrize(
    "wrong", [{"threads": 0}, {"threads": 1.5}, {"rehearsal_ticks": -1}, {"rehearsal_ticks": "all"}]
)
def test_wrong_numbers_of_threads_and_ticks_are_refused(graph, wrong):
    with pytest.raises(RuntimeInputError, match=f"{next(iter(wrong))} must be a whole number of at least"):
        World(graph, **wrong)


def test_people_of_a_world_without_ticks_for_it_do_not_rehearse(graph):
    assert World(graph, rehearsal_ticks=0).spawn("human", (2.0, 3.0, 0.0)).human.decider.answer is None
    assert World(graph).spawn("human", (2.0, 3.0, 0.0)).human.decider.answer is not None


def test_one_that_was_spawned_has_read_and_made_what_it_will_need(people, monkeypatch):
    """Its double, and the clips of its skills: a tick that has to do that is a frame that stalls."""
    jump_clip.cache_clear(), vault_clip.cache_clear()
    human = people.spawn("human", np.array([2.0, 3.0, 0.0]), 0.0, 0.3).human
    made = []
    monkeypatch.setattr(clip, "read_yaml", lambda *_: made.append("a clip"))
    monkeypatch.setattr(type(human), "_double", lambda self: made.append("a double"))
    human._lookahead._double_now()
    for skill in human.clearing:
        skill.approach(skill.heights[1])
    assert not made


def test_bodies_for_another_level_are_made_before_it_comes(graph, people, monkeypatch):
    usual, small = (people.spawn("human", np.array([x, 3.0, 0.0]), 0.0, 0.3) for x in (2.0, 4.0))
    small.set_style({"size": 0.9})
    other = graph.update({"step": navmesh.Terrain.from_arrays(*extruded([(7.0, 0.1), (8.0, 0.1)], 0.5))})
    people.foresee(other)
    monkeypatch.setattr("locomotion.body.models.build_person", None)  # nothing is made from here on
    people._level.graph, people._level.ground = other, Level.of(other).ground
    people.change_level()
    assert (
        usual.human.ground is people._level.ground and small.human.ground.high[0] > usual.human.ground.high[0]
    )
