"""Which obstacles count: wrong rules are named, and they go through a file."""

import pytest

import navmesh
from navmesh.obstacles.kinds import kind_of
from navmesh.obstacles.rules import ObstacleRules


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"jump_rise": (0.7, 0.1)}, "jump_rise"),
        ({"gap_width": 2.0}, "gap_width"),
        ({"vault_depth": -1.0}, "vault_depth"),
        ({"body_radius": True}, "body_radius"),
        ({"landing": float("nan")}, "landing"),
    ],
)
def test_wrong_rules_are_named(values: dict, said: str) -> None:
    with pytest.raises(navmesh.NavmeshError, match=said):
        navmesh.ObstacleRules(**values)


def test_rules_survive_a_file_header() -> None:
    rules = navmesh.ObstacleRules(vault_depth=0.5, gap_width=(0.3, 3.0))
    assert navmesh.ObstacleRules.from_dict(rules.to_dict()) == rules
    with pytest.raises(navmesh.NavmeshError, match="obstacle rules"):
        navmesh.ObstacleRules.from_dict({"jump": 1})


def test_the_range_of_a_kind_is_that_of_its_rule():
    rules = ObstacleRules(jump_rise=(0.2, 0.6))
    assert rules.range_of(kind_of("jump")) == (0.2, 0.6)
    assert rules.range_of(kind_of("gap")) == rules.gap_width
