"""Of all places where two parts of a level come near each other the easiest one to mend is told."""

import numpy as np
import pytest

from runtime.playtest.barriers import Barriers, _first_to_join
from runtime.playtest.sides import Side
from tests.runtime.playtest.levels import FLOOR, D, W, box, gap_of, room, site_of, unreached


def test_a_gap_is_not_called_a_wall():
    for width, body, says in (
        (2.2, "human", "2.20 m wide; a person leaps 0.38 to 1.82 m"),
        (1.0, "dog", "1.00 m wide; a dog does not leap gaps"),
    ):
        (fault,) = (each for each in unreached(gap_of(width), body=body) if each.kind != "open_edge")
        assert fault.kind in ("gap", "unreachable")
        assert "gap at" in fault.text and says in fault.text
    assert not [each for each in unreached(gap_of(1.0), body="human") if each.kind != "open_edge"]


def kept_apart(*parts, high=3.2, beyond=8.15):
    """What keeps the west of a room from its east: ``beyond`` [m] is where the east begins."""
    site = site_of(room(*parts, high=high))
    x = site.graph.surface.centers(np.arange(len(site.graph.surface)))[:, 0]
    inside, surface = site.cell_part >= 0, site.graph.surface
    west, east = (Side(surface, np.flatnonzero(inside & side)) for side in (x < beyond, x > beyond))
    return Barriers(site), west, east


def test_the_wider_of_two_narrow_doors_is_the_one_to_mend():
    a, b = box(8, 8.3, 0, 3, 0, 3.2), box(8, 8.3, 3.4, 6, 0, 3.2)  # doors of 0.4 m and of 0.5 m
    barriers, west, east = kept_apart(FLOOR, a, b, box(8, 8.3, 6.5, D, 0, 3.2))
    found = barriers.between(west, east, 1.0)
    assert found.kind == "narrow" and found.size == pytest.approx(0.5, abs=0.01)
    assert found.place[:2] == pytest.approx([8.15, 6.25], abs=0.2)


def test_without_a_door_it_is_the_wall():
    found = Barriers.between(*kept_apart(FLOOR, box(8, 8.3, 0, D, 0, 3.2)), 1.0)
    assert found.kind == "wall" and found.size == pytest.approx(0.3, abs=0.05)


def test_a_step_is_a_rise_from_below_and_a_fall_from_above():
    barriers, low, high = kept_apart(FLOOR, box(8, W, 0, D, 0, 0.5), beyond=8.0)
    up, down = barriers.between(low, high, 1.0), barriers.between(high, low, 1.0)
    assert (up.kind, down.kind) == ("rise", "rise")
    assert up.size == pytest.approx(0.5, abs=0.01) and down.size == pytest.approx(-0.5, abs=0.01)


def test_the_ledge_on_the_easiest_way_is_told_however_high_the_others_are():
    """A terrace of 1.5 m with a block of 0.9 m before a part of it."""
    barriers, low, high = kept_apart(
        FLOOR, box(10, W, 0, D, 0, 1.5), box(9, 10, 4, 6, 0, 0.9), high=5.0, beyond=10.0
    )
    low = Side(barriers.site.graph.surface, low.cells[low.places[:, 2] < 0.1])
    found = barriers.ledge(low, high)
    assert found.kind == "rise" and found.size == pytest.approx(0.9, abs=0.01)
    assert barriers.ledge(high, low).size == pytest.approx(-0.9, abs=0.01)


@pytest.mark.parametrize("seed", range(5))
def test_joining_pairs_in_their_order_finds_the_one_that_joins(seed):
    """Against trying each number of pairs with all walks through them."""
    rng = np.random.default_rng(seed)
    count = 12
    pairs = rng.integers(0, count, (25, 2))
    kind = rng.integers(0, 4, count)
    of, to = kind == 0, kind == 1

    def joined(k):
        reached = of.copy()
        for _ in range(count):
            for a, b in pairs[:k]:
                reached[a] = reached[b] = reached[a] or reached[b]
        return (reached & to).any()

    first = next((k for k in range(len(pairs)) if joined(k + 1)), -1)
    assert _first_to_join(pairs.astype(np.int64), of, to)[0] == first
