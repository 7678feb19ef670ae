"""The path that a person means to take, as others see it."""

import math

import numpy as np
import pytest

from locomotion.avoidance.yielding import HORIZON, SPACING
from locomotion.gaits.limits import walk_limits
from locomotion.gaits.walk.skill import load_walk_skill
from locomotion.human.intent import TURN_FIRST, course_on_way, course_to_rest
from locomotion.human.on_feet import RUN_GAINS
from locomotion.paths.follower import PathFollower
from locomotion.paths.tracking import make_path

WALK = walk_limits(load_walk_skill())


def follower(points=((0, 0, 0), (8, 0, 0)), at=0.0):
    made = PathFollower()
    made.begin(make_path(points, 1.2, WALK, 1.2, walk=WALK), 0)
    for x in np.arange(0.0, at + 0.05, 0.1):
        made.track(RUN_GAINS, float(x), 0.0, 1.2, 0, np.zeros(4))
    return made


def course(made, place=(0.0, 0.0, 0.0), velocity=(1.2, 0.0, 0.0), facing=0.0, aside=True):
    return course_on_way(made, WALK, np.array(place), np.array(velocity), True, facing, aside)


def spacing(points):
    return np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1)


def test_on_its_path_it_is_the_rest_of_the_path_with_its_speeds():
    found = course(follower(at=3.0), place=(3.0, 0.0, 0.0))
    assert found.points[0] == pytest.approx([3.0, 0.0, 0.0], abs=0.02)
    assert found.points[-1, 0] == pytest.approx(8.0, abs=SPACING)
    assert spacing(found.points) == pytest.approx(SPACING) and len(found.speeds) == len(found.points)
    assert found.speed == pytest.approx(1.2) and found.turns == 0.0 and found.pace == 1.0
    assert found.aside and found.whole and found.speeds[-1] < 0.5 < found.speeds[10]


def test_of_a_long_path_only_as_much_as_is_foreseen():
    found = course(follower(((0, 0, 0), (90, 0, 0))))
    assert len(found.points) * SPACING == pytest.approx(2.0 * HORIZON * WALK.speeds[1], abs=1.0)
    assert not found.whole


@pytest.mark.parametrize("facing", [TURN_FIRST - 0.05, TURN_FIRST + 0.3, -2.5])
def test_one_that_faces_elsewhere_turns_before_it_goes(facing):
    found = course(follower(), velocity=(0.0, 0.0, 0.0), facing=facing)
    if abs(facing) < TURN_FIRST:
        assert found.turns == 0.0
    else:
        assert found.turns == pytest.approx((abs(facing) - TURN_FIRST) / 1.2 + 0.5)


def test_one_that_moves_elsewhere_comes_to_a_stand_first_and_then_goes_to_its_path():
    found = course(follower(), velocity=(0.0, 1.0, 0.0), facing=0.5 * math.pi)
    halt = 1.0 / (2.0 * WALK.deceleration)
    assert found.points[:, 1].max() == pytest.approx(halt, abs=SPACING)
    assert found.points[-1] == pytest.approx([8.0, 0.0, 0.0], abs=SPACING)
    assert not found.aside  # it has no path of its own to change yet


def test_one_beside_its_path_walks_there_first():
    found = course(follower(at=3.0), place=(3.0, 0.5, 0.0))
    assert found.points[0] == pytest.approx([3.0, 0.5, 0.0]) and not found.aside
    assert course(follower(at=3.0), place=(3.0, 0.2, 0.0)).points[0, 1] == 0.0


def test_one_that_goes_back_keeps_to_its_path():
    made = follower(at=5.0)
    made.go_back(1.0, WALK, 0)
    found = course(made, place=(5.0, 0.0, 0.0), velocity=(-0.5, 0.0, 0.0), facing=math.pi)
    assert not found.aside and not found.whole
    assert found.points[-1, 0] == pytest.approx(1.0, abs=SPACING)


def test_one_that_stops_comes_as_far_as_its_brakes_let_it():
    found = course_to_rest(np.array([1.0, 2.0, 0.0]), np.array([0.0, 1.2, 0.3]), WALK)
    far = 1.2**2 / (2.0 * WALK.deceleration)
    assert found.points[-1] == pytest.approx([1.0, 2.0 + far, 0.0], abs=SPACING)
    assert not found.speeds.any() and found.pace == 0.0 and not found.aside
    still = course_to_rest(np.zeros(3), np.zeros(3), WALK)
    assert len(still.points) == 2 and np.isfinite(still.points).all()
