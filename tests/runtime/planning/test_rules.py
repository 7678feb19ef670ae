"""Walk rules that suit every body, and what counts as an obstacle for its skills."""

import math

import pytest

import navmesh
from locomotion import PERSON_RULES
from navmesh.obstacles.kinds import kind_of
from runtime.errors import RuntimeInputError
from runtime.planning.rules import obstacle_rules, person_walk_rules, walk_rules


def test_rules_suit_every_body_of_a_mission():
    both, dog, person = walk_rules(["dog", "human"]), walk_rules(["dog"]), walk_rules(["human"])
    assert both.headroom == max(dog.headroom, person.headroom)
    assert both.max_slope == min(dog.max_slope, person.max_slope)
    assert walk_rules(["dog"], headroom=2.0).headroom == 2.0


def test_what_is_given_takes_the_place_of_what_the_body_needs():
    usual = person_walk_rules()
    assert usual.max_step == PERSON_RULES["max_step"]
    given = person_walk_rules(max_slope_deg=30.0, max_step=0.1)
    assert given.max_slope == pytest.approx(math.radians(30.0)) and given.max_step == 0.1
    assert (given.headroom, given.resolution) == (usual.headroom, usual.resolution)


@pytest.mark.parametrize("degrees", [-1.0, 90.0, math.nan])
def test_slopes_are_degrees_below_a_right_angle(degrees):
    with pytest.raises(RuntimeInputError, match=r"max_slope_deg = .*: expected degrees"):
        walk_rules(["dog"], max_slope_deg=degrees)


def test_obstacles_are_looked_for_as_far_as_skills_go_and_never_less_than_usual():
    usual = navmesh.ObstacleRules()
    low, high = usual.range_of(kind_of("jump"))
    wide = obstacle_rules({"jump": (0.0, high + 1.0)}, body_radius=0.5)
    assert wide.body_radius == 0.5
    assert wide.range_of(kind_of("jump")) == (1e-3, high + 1.0)
    narrow = obstacle_rules({"jump": (low + 0.1, high - 0.1)})
    assert narrow.range_of(kind_of("jump")) == (low, high)
