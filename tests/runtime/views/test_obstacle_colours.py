"""Each kind of obstacle has its colour, in every picture the same."""

import pytest

from locomotion.skills.registry import skill_kinds
from runtime.views.obstacle_colours import in_order, obstacle_colour, parts_of_colour


def test_every_kind_has_a_colour_of_its_own_and_others_are_grey():
    kinds = skill_kinds()
    colours = [obstacle_colour(kind.affordance) for kind in kinds]
    assert colours == [kind.colour for kind in kinds]
    assert len({*colours, obstacle_colour("swim")}) == len(kinds) + 1
    red, green, blue = parts_of_colour(obstacle_colour("swim"))
    assert red == green == blue


@pytest.mark.parametrize(("colour", "parts"), [("#000000", (0, 0, 0)), ("#ff8001", (255, 128, 1))])
def test_parts_are_red_green_and_blue(colour, parts):
    assert parts_of_colour(colour) == parts


def test_kinds_come_in_the_order_of_the_registry_and_unknown_ones_last():
    known = [kind.affordance for kind in skill_kinds()]
    assert in_order(["zip", "swim", *reversed(known), known[0]]) == [*known, "swim", "zip"]
    assert in_order([]) == []
