"""The three levels of the person."""

import pytest

from locomotion.body.person import BODY_NAMES, JOINT_NAMES
from locomotion.errors import LocomotionError
from locomotion.recorded.skeletons import LEVELS, level_number, skeleton


def test_the_full_level_is_the_person():
    full = skeleton("full")
    assert full.channels == JOINT_NAMES
    assert set(full.bodies) == set(BODY_NAMES)


def test_lower_levels_have_about_half_of_the_joints_and_about_a_dozen():
    full, medium, low = (skeleton(level) for level in LEVELS)
    assert 0.4 <= len(medium.channels) / len(full.channels) <= 0.6
    assert len(low.bodies) - 1 <= 12
    assert set(low.channels) < set(medium.channels) < set(full.channels)


def test_parents_come_before_their_children():
    for level in LEVELS:
        own = skeleton(level)
        assert own.parents[0] == -1
        assert (own.parents[1:] < range(1, len(own.bodies))).all()
        assert own.first[0] == 0 and own.first[-1] == len(own.channels)


def test_an_unknown_level_is_refused_with_the_known_ones():
    with pytest.raises(LocomotionError, match="'hi': valid: full, medium, low"):
        skeleton("hi")
    assert [level_number(level) for level in LEVELS] == [0, 1, 2]
