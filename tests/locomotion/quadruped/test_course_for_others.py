"""The course that others see of an animal, and trails that swing out to one side."""

import numpy as np
import pytest

from locomotion.avoidance.yielding import HORIZON, SPACING
from locomotion.quadruped import lay_trail, load_body
from locomotion.quadruped.course_for_others import course_back, course_on, head_length, shifted_points
from tests.locomotion.quadruped.bends import follow
from tests.locomotion.quadruped.scenes import plane

DOG = load_body("dog")


def test_it_is_the_trail_from_its_rear_feet_on():
    herd, index, trail = follow(DOG, 1.2)
    for _ in range(200):
        herd.tick()
    course = course_on(trail, herd.state[index], DOG)
    assert course.points[0, :2] == pytest.approx(herd.root(index)[:2], abs=0.02)
    assert course.points[-1] == pytest.approx(trail.points[-1], abs=SPACING)
    gaps = np.linalg.norm(np.diff(course.points[:, :2], axis=0), axis=1)
    assert gaps == pytest.approx(SPACING, abs=2e-3)
    assert course.speed == pytest.approx(1.2, abs=0.1) and course.speeds.max() <= 1.2
    assert course.whole and course.reach == pytest.approx(head_length(DOG) - DOG.spine.length)
    assert course.length == head_length(DOG) > DOG.spine.length


def test_of_a_long_trail_it_is_what_can_be_foreseen():
    herd, index, trail = follow(DOG, 1.2, np.array([[-19.0, 0, 0], [19.0, 0, 0]]))
    course = course_on(trail, herd.state[index], DOG)
    assert len(course.points) * SPACING == pytest.approx(2.0 * HORIZON * 1.2 + DOG.length, abs=0.2)
    assert not course.whole and course.reach == 0.0


def test_backwards_it_begins_at_the_front_feet_and_cannot_be_changed():
    herd, index, trail = follow(DOG, 1.0, np.array([[0.0, 0, 0], [6.0, 0, 0]]))
    while not herd.resting(index):
        herd.tick()
    arc = 4.0
    herd.follow(index, trail, 0.6, start=arc, end=1.0, backwards=True)
    course = course_back(herd.rows(index), herd.state[index], DOG)
    assert course.points[0, 0] == pytest.approx(arc + DOG.spine.length)
    assert course.points[-1, 0] == pytest.approx(1.0, abs=SPACING)
    assert (course.speeds == 0.6).all() and not course.aside and not course.whole


def test_a_shift_moves_what_lies_ahead_and_leads_back():
    trail = lay_trail([[0, 0, 0], [8, 0, 0]], DOG, plane())
    shift = np.zeros((31, 2))
    shift[5:25, 1] = -0.5
    points = shifted_points(trail, 2.0, shift)
    assert points[:, [0, 2]] == pytest.approx(trail.points[:, [0, 2]])
    x, y = points[:, 0], points[:, 1]
    assert not y[x < 2.4].any() and not y[x > 4.6].any()
    assert y[(x > 2.55) & (x < 4.35)] == pytest.approx(-0.5)
