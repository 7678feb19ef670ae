"""A game asks an agent for its odds at an obstacle, and gives it bravery."""

import numpy as np
import pytest

import navmesh
from locomotion.human.composition import Composition
from locomotion.skills.course import make_course
from runtime import RuntimeInputError, Stuck, TurnedAway, World
from runtime.bodies.obstacle_odds import odds_at


@pytest.fixture(scope="module")
def graph():
    course = make_course([("jump", 0.5, 0.0)], [10.0], margin=2.0)
    from runtime.planning.rules import obstacle_rules, person_walk_rules

    terrain = navmesh.Terrain.from_arrays(course.vertices, course.faces)
    return navmesh.NodeGraph.build(terrain, person_walk_rules(), obstacle_rules({}))


def test_odds_are_asked_by_number_or_tag(graph):
    world = World(graph, rehearsals=0)
    ada = world.spawn("human", (0.5, 0.0, 0.0))
    number = int(np.flatnonzero(graph.obstacles.affordance == "jump")[0])
    odds = ada.odds(number)
    assert 0.4 < odds < 1.0 and odds == ada.odds(str(graph.obstacles.tag[number]))
    assert odds == odds_at(ada.human, graph, number, "")
    with pytest.raises(RuntimeInputError, match="obstacle 'moon': the level has"):
        ada.odds("moon")
    with pytest.raises(RuntimeInputError, match="a whole number below"):
        ada.odds(10_000)
    with pytest.raises(RuntimeInputError, match="only those of a human with physics are"):
        world.spawn("walker", (0.5, 2.0, 0.0)).odds(number)


def test_a_timid_person_says_that_it_turns_away_and_stays_so_when_restored(graph, monkeypatch):
    monkeypatch.setattr(Composition, "odds", lambda self, obstacle, room: 0.2)
    world = World(graph, rehearsals=0)
    with pytest.raises(RuntimeInputError, match="bravery must be a number from 0 to 1"):
        world.spawn("human", (0.5, 0.0, 0.0), bravery=2.0)
    with pytest.raises(RuntimeInputError, match="only a human has"):
        world.spawn("dog", (0.5, 0.0, 0.0), bravery=0.5)
    assert not world.agents
    ada = world.spawn("human", (0.5, 0.0, 0.0), bravery=0.3)
    saved, before = world.save(), world.state_hash()
    ada.bravery = None
    assert world.state_hash() != before
    world.restore(saved)
    assert ada.bravery == 0.3 == ada.human.bravery and world.state_hash() == before
    assert ada.go_to((20.0, 0.0, 0.5)) == "walking"
    told = []
    while ada.moving and world.time < 15.0:
        world.step(0.1)
        told += world.events
    (away,) = [event for event in told if isinstance(event, TurnedAway)]
    assert (away.skill, away.odds) == ("jump", 0.2) and away.height == pytest.approx(0.5, abs=0.01)
    assert str(away) == "human1 turns away from a jump of 0.50 m: odds 20 %"
    assert isinstance(told[-1], Stuck)


def test_the_next_person_is_not_brave_because_the_last_one_was(graph):
    world = World(graph, rehearsals=0)
    ada = world.spawn("human", (0.5, 0.0, 0.0), bravery=0.3)
    brave = ada.human
    ada.detail = "full"
    world.step(0.5)
    assert ada.level == "full" and ada.bravery == 0.3
    bob = world.spawn("human", (2.0, 0.0, 0.0))
    assert bob.human is brave and bob.bravery is None and bob.human.bravery is None
