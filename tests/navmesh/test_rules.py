"""Walk rules: what is no rule is named, and they go through a file."""

import math

import pytest

from navmesh.errors import NavmeshError
from navmesh.rules import WalkRules


@pytest.mark.parametrize(
    "wrong",
    [
        {"max_slope": 2.0},
        {"max_slope": -0.1},
        {"max_step": 1.0, "headroom": 1.5},
        {"headroom": 0.0},
        {"resolution": 0.0},
        {"resolution": math.nan},
        {"min_radius": "wide"},
        {"max_step": True},
    ],
)
def test_rules_say_what_is_wrong(wrong):
    with pytest.raises(NavmeshError, match=next(iter(wrong))):
        WalkRules(**wrong)


def test_rules_go_through_a_file():
    rules = WalkRules(max_step=0.3, resolution=0.2)
    assert WalkRules.from_dict(rules.to_dict()) == rules
    with pytest.raises(NavmeshError, match="walk rules"):
        WalkRules.from_dict({"max_stepp": 1})


def test_whole_numbers_are_numbers():
    rules = WalkRules(max_step=0, headroom=2)
    assert (rules.max_step, rules.headroom) == (0.0, 2.0) and type(rules.headroom) is float
