"""On hands and feet over steep ground."""

import math

import mujoco
import numpy as np
import pytest

from locomotion import Human
from locomotion.body.person import STEPS_PER_TICK
from locomotion.body_events import Fell
from locomotion.recovery.layout import SEEN_LIMBS
from locomotion.recovery.scrambling import lie_of, steeper
from tests.locomotion.recovery.falling import go_on, plane


@pytest.mark.parametrize("slope", [0.6, 0.85])
def test_scrambles_into_every_direction_over_a_steep_plane(slope):
    human, kept = Human(plane(slope), clearing=(), gets_up=True), 0
    for degrees in (0, 45, 90, 135, 180):
        way = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
        points = np.array([[*(k * way), slope * k * way[0]] for k in np.arange(0.0, 10.0, 0.5)])
        human.events.clear()
        human.reset(points[0], math.radians(degrees))
        human.follow(points, 3.0)
        assert human.status == "scrambling"
        go_on(human, 10.0, Fell)
        kept += not any(isinstance(event, Fell) for event in human.events) and human.arc_length > 1.0
        assert abs(human.lateral_error) < 0.3
    assert kept >= 4


@pytest.mark.parametrize(("slope", "speed"), [(0.001, 0.0), (0.001, 0.15), (0.2, 0.15)])
def test_turns_on_hands_and_feet_without_falling(slope, speed):
    human, rng = Human(plane(slope), clearing=(), gets_up=True), np.random.default_rng(3)
    fours, data, falls, turned = human.fours, human.data, 0, 0.0
    fours.crouch(human.simulation.lookup, data, np.zeros(3), 0.0)
    for _ in range(20):
        command, before = np.array([rng.uniform(-math.pi, math.pi), speed, 0.0, 0.0]), fours.facing
        for _ in range(600):
            fours.tick(human.simulation.lookup, command, data, stand=False)
            mujoco.mj_step(fours.model, data, STEPS_PER_TICK)
            fours.observe(human.simulation.lookup, data, human.observed)
            if fours.fallen:
                fours.crouch(human.simulation.lookup, data, np.zeros(3), command[0])
                falls += 1
        turned += abs(math.remainder(fours.facing - before, 2.0 * math.pi))
    assert falls <= 1
    assert turned > 8.0


@pytest.mark.parametrize("slope", [0.0, 0.4, 0.8])
def test_the_lie_of_the_ground_is_its_gradient(slope):
    found = np.empty(2)
    lie_of(plane(slope).lookup, 3.0, -2.0, 3.0 * slope, found)
    assert found == pytest.approx([slope, 0.0], abs=1e-9)


@pytest.mark.parametrize("place", [(39.9, 3.0), (-39.7, 3.0), (3.0, 39.9), (3.0, -39.5)])
def test_the_lie_of_the_ground_beside_a_rim_is_its_gradient(place):
    found, (x, y) = np.empty(2), place
    lie_of(plane(0.7).lookup, x, y, 0.7 * x, found)
    assert found == pytest.approx([0.7, 0.0], abs=1e-9)


@pytest.mark.parametrize("place", [(39.6, 0.0), (0.0, 39.65), (-39.6, 39.6)])
def test_hands_and_feet_hold_on_beside_a_rim(place):
    human, start = Human(plane(0.8), clearing=(), gets_up=True), np.array([*place, 0.8 * place[0]])
    human.reset(start, 0.0)
    limbs = human.fours.memory[SEEN_LIMBS].reshape(4, 3)
    assert (np.abs(limbs[:, :2]) <= 40.0).all()
    for _ in range(500):
        human.tick()
    assert human.fours.borne and np.linalg.norm(human.position - start) < 0.35


def test_only_ground_that_is_steep_somewhere_near_is_steeper():
    ground, points = plane(0.5), np.array([[x, 0.0, 0.5 * x] for x in np.arange(-2.0, 2.0)])
    assert steeper(ground.lookup, points, 0.45) and not steeper(ground.lookup, points, 0.55)
