"""Doors that do not let the body in, though the way around them is long."""

import numpy as np
import pytest

from runtime.playtest.passages import narrow_passages
from tests.runtime.playtest.levels import FLOOR, D, box, room, site_of


def divided(*doors):
    """A room of 16 by 10 m with a wall at x = 8, and doors (y from, y to) in it."""
    y, wall = 0.0, []
    for begin, end in doors:
        wall.append(box(8, 8.3, y, begin, 0, 3.2))
        y = end
    return site_of(room(FLOOR, *wall, box(8, 8.3, y, D, 0, 3.2)))


def passages(site):
    return narrow_passages(site, np.ones(len(site.areas), dtype=bool))


def test_a_door_too_narrow_is_measured_with_the_way_around():
    (found,) = passages(divided((1.0, 1.5), (8.7, 9.7)))
    assert found.barrier.kind == "narrow" and found.barrier.size == pytest.approx(0.5, abs=0.01)
    assert found.barrier.place[:2] == pytest.approx([8.15, 1.25], abs=0.2)
    assert found.through < 2.5 and 14.0 < found.around < 20.0


@pytest.mark.parametrize(
    "doors",
    [((1.0, 2.0), (8.7, 9.7)), ((4.0, 4.5), (6.0, 7.0)), ((8.7, 9.7),)],
    ids=["wide enough", "hardly a way around", "no second door"],
)
def test_other_doors_are_not_worth_a_word(doors):
    assert passages(divided(*doors)) == []


def test_where_nobody_is_no_passage_is_looked_for():
    site = divided((1.0, 1.5), (8.7, 9.7))
    assert narrow_passages(site, np.zeros(len(site.areas), dtype=bool)) == []
