"""People, animals and walkers tell what happens to them in the same events."""

from dataclasses import FrozenInstanceError

import numpy as np
import pytest

import navmesh
from locomotion import SmoothPath
from locomotion.body_events import Arrived, LostGround, SetOff
from locomotion.crowd import Crowd
from locomotion.ground.ground import Ground
from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.quadruped import Animal, Herd, load_body

START, GOAL = np.array([0.0, 0.5, 0.0]), (3.0, 0.5, 0.0)
CORNERS = np.array([[-9.0, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])


class Straight:
    """A planner of straight lines, for the animal."""

    def way(self, start, goal, direction):
        return SmoothPath(np.stack([start, goal]), (), True)

    def room_to_turn(self, points, length):
        return np.ones(len(points), bool)


def person():
    body = Human(Ground.from_arrays(CORNERS, FACES))
    body.reset(START, 0.0)
    for _ in range(3):
        body.tick()  # its clock began before it sets off
    body.follow([START, GOAL], 1.5)
    return body, body.tick, MOVING


def dog():
    herd = Herd(Ground.from_arrays(CORNERS, FACES))
    body = Animal(herd, herd.add(load_body("dog"), START, 0.0), Straight())
    for _ in range(3):
        herd.tick()
        body.tick()
    body.go_to(GOAL, 1.5)

    def tick():
        herd.tick()
        body.tick()

    return body, tick, ("running",)


def walker():
    terrain = navmesh.Terrain.from_arrays(CORNERS, FACES)
    crowd = Crowd(navmesh.NodeGraph.build(terrain, navmesh.WalkRules(resolution=0.4), obstacle_rules=None))
    body = crowd.add(START)
    for _ in range(3):
        crowd.tick()
    body.go_to([GOAL], 1.5)
    return body, crowd.tick, ("walking",)


@pytest.mark.parametrize("made", [person, dog, walker])
def test_setting_off_and_arriving_say_when_and_where(made):
    body, tick, moving = made()
    while body.status in moving:
        tick()
        assert body.time < 20.0
    setoff, arrived = body.events
    assert (type(setoff), type(arrived)) == (SetOff, Arrived)
    assert setoff.goal == pytest.approx(GOAL, abs=1e-6)
    assert setoff.position == pytest.approx(tuple(START), abs=0.05)
    assert setoff.length == pytest.approx(3.0, abs=0.05)
    assert 0.0 < setoff.time < 0.1 and arrived.time == pytest.approx(body.time)
    assert arrived.position == pytest.approx(tuple(body.position))
    there = body.front if isinstance(body, Animal) else body.position  # animals come with their front feet
    assert arrived.distance == pytest.approx(np.hypot(*np.subtract(there, GOAL)[:2]), abs=1e-9)


def test_events_are_equal_by_what_they_say_and_do_not_change():
    """Saved bodies hold on to them, and runs are compared by them."""
    one = LostGround(1.0, (0.0, 0.0, 0.0))
    assert one == LostGround(1.0, (0.0, 0.0, 0.0)) != LostGround(2.0, (0.0, 0.0, 0.0))
    assert one != Arrived(1.0, (0.0, 0.0, 0.0), 0.0)
    with pytest.raises(FrozenInstanceError):
        one.time = 2.0  # type: ignore[misc]
