"""Which stretch of the pulled path each disc covers, and where the waypoints lie on it."""

from itertools import pairwise

import numpy as np
import pytest

from pathsmooth import placement
from pathsmooth.placement import COVERED, END_OUTSIDE, GAP, START_OUTSIDE, cover, place, point_at

SLACK = 1e-9


def straight(length, *more):
    """A path along x, with more corners beside it; its points and arc lengths."""
    path = np.array([[0.0, 0.0], [length, 0.0], *more])
    return path, np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])


def covered(path, arc, *discs):
    """``discs``: x, y, radius."""
    rows = np.array(discs, float)
    return cover(path, arc, rows[:, :2].copy(), rows[:, 2].copy(), SLACK)


def test_each_disc_covers_the_part_of_the_path_inside_it():
    code, disc, reached, begin, end = covered(*straight(6.0), (0, 0, 2), (3, 0, 2), (6, 0, 2))
    assert (code, disc, reached) == (COVERED, 3, 6.0)
    assert begin == pytest.approx([0.0, 1.0, 4.0]) and end == pytest.approx([2.0, 5.0, 6.0])


def test_a_disc_beside_the_path_covers_its_chord():
    """A disc of 1 m with its centre 0.6 m off the path."""
    *_, begin, end = covered(*straight(3.0), (0, 0, 2), (2, 0.6, 1), (3, 0, 1))
    assert (begin[1], end[1]) == pytest.approx((1.2, 2.8))


def test_a_path_that_comes_back_is_covered_in_the_order_of_the_discs():
    """Along a hairpin: the first and the last disc are the same, and hold both its ends."""
    path, arc = straight(4.0, [4.0, 0.5], [0.0, 0.5])
    code, _, _, begin, end = covered(path, arc, (0, 0.25, 2), (3, 0.25, 2), (0, 0.25, 2))
    half = np.sqrt(2.0**2 - 0.25**2)
    assert code == COVERED
    assert begin == pytest.approx([0.0, 3.0 - half, 8.5 - half])
    assert end == pytest.approx([half, 8.5 - (3.0 - half), 8.5])


@pytest.mark.parametrize(
    ("discs", "answer"),
    [
        ([(1, 0, 0.5), (3, 0, 3)], (START_OUTSIDE, 0, 0.0)),
        ([(0, 0, 1), (3, 0, 1.5), (6, 0, 2)], (GAP, 1, 1.0)),
        ([(0, 0, 1), (2, 0, 1.5), (4, 0, 1.5)], (END_OUTSIDE, 2, 5.5)),
    ],
)
def test_the_first_disc_that_fails_is_told_and_how_far_the_path_is_covered(discs, answer):
    code, disc, reached, *_ = covered(*straight(6.0), *discs)
    assert (code, disc) == answer[:2] and reached == pytest.approx(answer[2])


def placed(path, arc, discs, spacing):
    rows = np.array(discs, float)
    code, _, _, begin, end = covered(path, arc, *discs)
    assert code == COVERED
    return place(path, arc, rows[:, :2].copy(), rows[:, 2].copy(), begin, end, spacing)


def test_one_disc_is_divided_evenly():
    places, discs = placed(*straight(3.0), [(1.5, 0, 2)], 0.4)
    assert places == pytest.approx(np.linspace(0.0, 3.0, 9)) and not discs.any()


def test_a_narrow_overlap_gets_a_waypoint_where_the_rims_are_equally_near():
    """Overlap from 1.9 to 2.1 m: a waypoint in its middle, and even spacing on both sides of it."""
    places, discs = placed(*straight(4.0), [(0.9, 0, 1.2), (3.1, 0, 1.2)], 0.5)
    middle = int(np.argmin(np.abs(places - 2.0)))
    assert places[middle] == pytest.approx(2.0, abs=1e-5)
    assert discs.tolist() == [0] * middle + [1] * (len(places) - 1 - middle)
    assert np.diff(places).max() <= 0.5 + 1e-9


def test_a_wide_overlap_takes_a_waypoint_that_is_there_already():
    places, discs = placed(*straight(4.0), [(1, 0, 2), (3, 0, 2)], 0.5)
    assert places == pytest.approx(np.linspace(0.0, 4.0, 9))
    assert discs.tolist() == [0, 0, 0, 0, 1, 1, 1, 1]


def test_both_ends_of_every_segment_are_in_its_disc():
    path, arc = straight(5.0, [5.0, 5.0])
    discs = [(1, 0, 1.3), (3, 0.2, 1.4), (4.9, 0.4, 1.1), (5.2, 2.5, 1.5), (5, 4.5, 1.2)]
    places, segment = placed(path, arc, discs, 0.25)
    points = np.array([point_at(path, arc, s) for s in places])
    for ends, disc in zip(pairwise(points), segment, strict=True):
        x, y, radius = discs[disc]
        assert all(np.hypot(px - x, py - y) <= radius + 0.25 * placement.SHIFT for px, py in ends)
    assert set(segment) == set(range(5))


def test_the_point_at_an_arc_length():
    path, arc = straight(3.0, [3.0, 4.0])
    told = [point_at(path, arc, s) for s in (-1.0, 0.0, 1.5, 3.0, 5.0, 7.0, 9.0)]
    expected = [(0, 0), (0, 0), (1.5, 0), (3, 0), (3, 2), (3, 4), (3, 4)]
    assert np.array(told) == pytest.approx(np.array(expected))
