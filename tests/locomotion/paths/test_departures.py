"""How a running person begins a new way: in a bend that it can run, or straight on until it stands."""

import math

import numpy as np
import pytest

import navmesh
from locomotion.paths.departures import can_begin, leads
from locomotion.paths.gait_plan import SLOWS_WITHIN, braking_length
from locomotion.paths.table import TrackingLimits
from runtime.planning.rules import person_walk_rules

LIMITS = TrackingLimits((2.5, 5.0), sideways=1.28, sharpest=0.2, steepest=0.12)


def floor_of(x0, y0, x1, y1):
    corners = np.array([(x0, y0, 0.0), (x1, y0, 0.0), (x1, y1, 0.0), (x0, y1, 0.0)])
    terrain = navmesh.Terrain.from_arrays(corners, np.array([(0, 1, 2), (0, 2, 3)]))
    return navmesh.NodeGraph.build(terrain, person_walk_rules())


@pytest.fixture(scope="module")
def field():
    return floor_of(-50, -50, 50, 50)


@pytest.mark.parametrize("speed", [2.5, 3.5, 4.5])
@pytest.mark.parametrize("angle", [-60, -40, 15, 60])
def test_a_bend_begins_in_its_direction_and_ends_towards_the_target(field, speed, angle):
    yaw, off = 0.7, math.radians(angle)
    velocity = speed * np.array([math.cos(yaw), math.sin(yaw)])
    place = np.array([-4.0, 2.0, 0.0])
    target = place + 30.0 * np.array([math.cos(yaw + off), math.sin(yaw + off), 0.0])
    bend, runs_on = next(leads(field, place, velocity, target, LIMITS, 0.3))
    assert runs_on
    steps = np.diff(bend[:, :2], axis=0)
    headings = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    turned = np.diff(headings) / np.linalg.norm(steps[1:], axis=1)
    assert bend[0] == pytest.approx(place)
    assert np.abs(turned).max() * speed**2 <= LIMITS.sideways * 1.001 and np.sign(turned).min() == np.sign(
        off
    )
    wanted = (target - bend[-1])[:2]
    off_target = headings[-1] - math.atan2(wanted[1], wanted[0])
    assert abs(math.remainder(off_target, 2 * math.pi)) < 0.5 * 0.25 * np.abs(turned).max() + 1e-6
    assert can_begin(np.concatenate([bend, target[None]]), velocity, LIMITS)


def test_what_lies_beside_or_behind_it_is_gone_to_from_a_stand(field):
    place, velocity = np.zeros(3), np.array([3.5, 0.0])
    for target in ([0.0, 3.0, 0.0], [-10.0, 0.0, 0.0], [2.0, -4.0, 0.0]):
        ((way, runs_on),) = leads(field, place, velocity, np.array(target), LIMITS, 0.3)
        assert not runs_on and np.abs(way[:, 1]).max() == 0.0
        assert way[-1, 0] == pytest.approx(braking_length(3.5) + SLOWS_WITHIN + 0.3)


def test_it_goes_straight_on_as_far_as_there_is_room():
    hall = floor_of(-10, -2, 2, 2)
    velocity = np.array([3.5, 0.0])
    ((way, _),) = leads(hall, np.zeros(3), velocity, np.array([-8.0, 1.0, 0.0]), LIMITS, 0.3)
    assert way[-1, 0] == pytest.approx(1.7, abs=0.1)
    at_the_wall = np.array([1.65, 0.0, 0.0])
    assert list(leads(hall, at_the_wall, velocity, np.array([-8.0, 1.0, 0.0]), LIMITS, 0.3)) == []


def test_a_way_can_be_begun_that_leads_on_and_bends_late():
    velocity = np.array([3.5, 0.0])
    at = np.arange(0.0, 12.0, 0.25)[:, None]
    straight = np.hstack([at, 0 * at, 0 * at])
    assert can_begin(straight, velocity, LIMITS)
    assert not can_begin(straight[:10], velocity, LIMITS)  # ends before it stands
    assert not can_begin(straight @ [[0.9, 0.4, 0], [0, 0, 0], [0, 0, 0]], velocity, LIMITS)
    for straight_for, can in ((1.0, False), (5.0, True)):
        bent = straight.copy()
        after = bent[:, 0] > straight_for
        bent[after, 1] = bent[after, 0] - straight_for
        bent[after, 0] = straight_for
        assert can_begin(bent, velocity, LIMITS) == can


@pytest.mark.parametrize("place", [[-10.9, 0.0, 0.0], [-40.0, 0.0, 0.0], [0.0, 30.0, 0.0]])
def test_who_has_left_the_level_has_no_bend_back(place):
    """It has run over the edge, where no floor is: asking ended the process."""
    hall, velocity = floor_of(-10, -2, 2, 2), np.array([-3.5, 0.0])
    for target in ([0.0, 1.0, 0.0], [-60.0, 4.0, 0.0]):
        assert not any(
            runs_on for _, runs_on in leads(hall, np.array(place), velocity, np.array(target), LIMITS, 0.3)
        )
