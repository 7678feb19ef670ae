"""A person of another size lives in the world's measure, and its own clock keeps up with the world's."""

import math

import numpy as np
import pytest

from locomotion import Ground, Human
from locomotion.body_events import GotStuck, TurnedAway
from locomotion.ground.ground import extruded
from locomotion.human.simulation import movements
from locomotion.human.sized_human import SizedHuman, movements_of
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.preconditions.precondition import Precondition, load_preconditions

FLOOR = extruded([(0.0, 0.0), (6.0, 0.1), (20.0, 0.1)], 3.0)
PATH = np.array([(2.0, 0.0, 0.0333), (18.0, 0.0, 0.1)])


def walker(size: float) -> SizedHuman:
    ground = Ground.from_arrays(*FLOOR).scaled(1.0 / size)
    body = SizedHuman(Human(ground, clearing=(), rehearsals=0), size)
    body.reset(PATH[0], 0.0)
    body.follow(PATH, 1.2)
    return body


@pytest.mark.parametrize("size", [0.85, 1.15])
def test_it_walks_in_the_world_as_the_usual_person_in_its_own(size):
    body = walker(size)
    twin = Human(Ground.from_arrays(*FLOOR).scaled(1.0 / size), clearing=(), rehearsals=0)
    twin.reset(PATH[0] / size, 0.0)
    twin.follow(PATH / size, 1.2 / math.sqrt(size))
    for _ in range(300):
        body.tick(since_foresees=False)
    while twin.ticks < body.human.ticks:
        twin.tick()
    assert body.human.state_hash() == twin.state_hash()
    np.testing.assert_allclose(body.position, size * twin.position)
    np.testing.assert_allclose(body.velocity, math.sqrt(size) * twin.velocity)
    assert body.time == pytest.approx(3.0, abs=body.tick_seconds)
    assert 0.0 <= body.owed < 1.0
    assert body.arc_length == pytest.approx(body.position[0] - PATH[0, 0], abs=0.1)


@pytest.mark.parametrize("size", [0.85, 1.15])
def test_it_is_seen_to_move_evenly_though_its_ticks_are_not_the_worlds(size):
    body, seen = walker(size), []
    for _ in range(400):
        body.tick(since_foresees=False)
        seen.append(body.pose()[0])
    steps = np.diff(seen)[200:]
    own = np.diff(steps)  # a tick more or less would show as a step of a centimetre
    assert np.abs(own).max() < 0.25 * steps.mean()


def test_the_usual_person_is_told_as_it_is():
    body = walker(1.0)
    for _ in range(50):
        body.tick(since_foresees=False)
    human = body.human
    assert human.ticks == 50 and body.owed == 0.0
    assert body.pose().tolist() == human.pose().tolist()
    assert body.position.tolist() == human.position.tolist() and body.limits == human.on_feet.limits
    human.events.clear()


def test_bodies_of_a_pose_are_where_the_person_is():
    body = walker(0.9)
    for _ in range(30):
        body.tick(since_foresees=False)
    bodies = body.transforms(body.pose(), 20)
    np.testing.assert_allclose(bodies[0, :3], body.pose()[:3])
    assert bodies[:, 2].max() - body.position[2] == pytest.approx(0.9 * 1.4, abs=0.05)


def test_the_reasons_that_it_gives_are_in_the_worlds_measure(monkeypatch):
    body = SizedHuman(Human(rehearsals=0), 0.9)
    monkeypatch.setattr(Precondition, "odds_before", lambda self, rows: np.full(len(rows), 0.1))
    body.human.composition.preconditions, body.human.bravery = load_preconditions(), 0.4
    wall = ObstacleAhead(9.0, "vault", 0.81, np.array([9.0, 0.0, 0.81]), np.array([-1.0, 0.0, 0.0]), 0.3)
    body.follow(np.array([(0.0, 0.0, 0.0), (18.0, 0.0, 0.0)]), 3.5, [wall])
    while body.human.status == "walking":
        body.tick(since_foresees=False)
    *_, turned, stuck = map(body.in_world, body.human.events)
    assert isinstance(turned, TurnedAway) and turned.size == pytest.approx(0.81)
    assert isinstance(stuck, GotStuck)
    assert stuck.reason == "its odds of clearing the vault of 0.81 m are 10 %"


def test_people_of_all_sizes_are_looked_for_at_once():
    people = [walker(size) for size in (1.0, 0.9, 1.0, 1.1)]
    for body in people:
        for _ in range(80):
            body.tick(since_foresees=False)
    places, velocities = movements_of(people)
    for body, place, velocity in zip(people, places, velocities, strict=True):
        np.testing.assert_allclose(place[:2], body.position[:2])
        np.testing.assert_allclose(velocity, body.velocity)
    usual = movements([people[0].human.simulation])
    assert movements_of(people[:1])[0].tolist() == usual[0].tolist()
    assert movements_of([])[0].shape == (0, 3)
