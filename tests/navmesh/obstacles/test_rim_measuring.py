"""The limits between which something counts as an obstacle."""

import math

import pytest

import navmesh
from navmesh.obstacles.kinds import kind_of
from navmesh.obstacles.rim_measuring import FOUND, Limits


def test_what_is_walked_over_is_no_obstacle():
    low = navmesh.ObstacleRules(jump_rise=(0.1, 0.7), drop_height=(0.1, 2.0))
    limits = Limits.of(low, navmesh.WalkRules(max_step=0.3))
    assert 0.3 < limits.jump_low < 0.302 and 0.3 < limits.drop_low < 0.302
    assert limits.vault_low == pytest.approx(low.vault_height[0], abs=1e-5)


def test_bounds_belong_to_what_is_looked_for():
    rules = navmesh.ObstacleRules(jump_rise=(0.4, 0.7))
    limits = Limits.of(rules, navmesh.WalkRules(max_slope=math.radians(45.0)))
    assert limits.jump_low < 0.4 and limits.jump_high > 0.7 and limits.gap_high > rules.gap_width[1]
    assert limits.run_up < rules.run_up and limits.slope == pytest.approx(1.0)


def test_kinds_have_codes_of_their_own():
    assert len({code for _, code, _ in FOUND}) == len(FOUND) == 4
    assert all(kind_of(affordance).rule for affordance, *_ in FOUND)
