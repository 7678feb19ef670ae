"""A game asks an agent for its odds at an obstacle, and gives it bravery."""

import numpy as np
import pytest
import trimesh

import navmesh
from locomotion import ObstacleAhead
from locomotion.human.composition import Composition
from locomotion.human.sized_human import SizedHuman
from locomotion.paths.run_up_room import straight_before
from locomotion.preconditions.precondition import Precondition
from locomotion.skills.course import make_course
from runtime import RuntimeInputError, Stuck, TurnedAway, World
from runtime.bodies.obstacle_odds import link_prices, odds_at
from runtime.planning.rules import obstacle_rules, person_walk_rules
from tests.runtime.playtest.levels import box


@pytest.fixture(scope="module")
def graph():
    course = make_course([("jump", 0.5, 0.0)], [10.0], margin=2.0)
    terrain = navmesh.Terrain.from_arrays(course.vertices, course.faces)
    return navmesh.NodeGraph.build(terrain, person_walk_rules(), obstacle_rules({}))


def test_odds_are_asked_by_number_or_tag(graph):
    world = World(graph, rehearsals=0)
    ada = world.spawn("human", (0.5, 0.0, 0.0))
    number = int(np.flatnonzero(graph.obstacles.affordance == "jump")[0])
    odds = ada.odds(number)
    assert 0.4 < odds < 1.0 and odds == ada.odds(str(graph.obstacles.tag[number]))
    assert odds == odds_at(SizedHuman(ada.human, 1.0), graph, number, "")
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


@pytest.fixture(scope="module")
def wall():
    """A wall of 0.8 m across a floor, round which there is a way, too."""
    floor, fence = box(0, 24, -3, 12, -0.5, 0), box(12.0, 12.3, -3, 8, -0.2, 0.8)
    level = trimesh.util.concatenate([floor, fence])
    terrain = navmesh.Terrain.from_arrays(level.vertices, level.faces)
    return navmesh.NodeGraph.build(terrain, person_walk_rules(), obstacle_rules({}))


def over(world, **told):
    """The obstacles on the way of somebody to the other side of the wall."""
    ada = world.spawn("human", (2.0, 0.0, 0.0), **told)
    ada.go_to((22.0, 0.0, 0.0))
    return [obstacle.affordance for obstacle in ada.plans[-1].obstacles]


def test_who_goes_by_odds_goes_round_what_it_would_fail_at(wall, monkeypatch):
    for odds, leads_over in ((0.95, ["vault"]), (0.3, [])):
        monkeypatch.setattr(Precondition, "odds_before", lambda self, rows, p=odds: np.full(len(rows), p))
        wall.cache.clear()
        assert over(World(wall, rehearsals=0), bravery=0.9) == leads_over
        assert over(World(wall, rehearsals=0)) == over(World(wall), bravery=0.9) == ["vault"]


@pytest.mark.parametrize("size", [1.0, 0.9])
def test_a_link_is_as_much_dearer_as_tries_fail_before_one_holds(wall, size):
    wall.cache.clear()
    human = World(wall, rehearsals=0).spawn("human", (2.0, 0.0, 0.0)).human
    body = SizedHuman(human, size)
    prices, links = link_prices(body, wall), wall.links
    for k in np.flatnonzero(links.affordance == "vault")[::7]:
        number = links.obstacle[k]
        ahead = ObstacleAhead(
            9.0, "vault", links.height[k], links.edge[k],
            wall.obstacles.normal[number], wall.obstacles.depth[number],
        )  # fmt: skip
        odds = human.composition.odds(body.own(ahead), straight_before(wall, 0.3, 16.0)[k] / size)
        assert prices[k] == pytest.approx(30.0 * (1.0 - odds) / odds, rel=1e-3) and prices[k] > 0.0
    human.composition.preconditions = {}
    assert not link_prices(body, wall).any()
