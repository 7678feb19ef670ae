"""Straight courses of obstacles."""

import pytest

from locomotion import Ground
from locomotion.skills.course import AFTER, make_course


def test_a_course_is_the_level_that_it_says():
    course = make_course([("jump", 0.4, 0.0), ("vault", 0.7, 0.2), ("drop", 1.5, 0.0)], [10.0, 9.0, 8.0])
    ground = Ground.from_arrays(course.vertices, course.faces)
    for x, height in ((9.9, 0.0), (10.1, 0.4), (19.1, 1.1), (19.3, 0.4), (26.9, 0.4), (27.1, -1.1)):
        assert ground.surface_below([[x, 0.3, 5.0]])[0][0] == pytest.approx(height)
    assert course.path[-1] == pytest.approx([27.0 + AFTER, 0.0, -1.1])
    assert [obstacle.arc_length for obstacle in course.obstacles] == [10.0, 19.0, 27.0]
