"""The order in which chunks come and go."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from navmesh.streaming.choosing import distances, in_order, nearness

BOXES = np.array([[[0, 0, 0], [1, 1, 9]], [[2, 0, 0], [3, 1, 9]], [[2, 5, 0], [3, 6, 9]]], float)


def test_distances_are_seen_from_above_and_zero_inside():
    points = np.array([[0.5, 0.5, 100.0], [5.0, 3.0, 0.0]])
    expected = [[0, 1.5, np.hypot(1.5, 4.5)], [np.hypot(4, 2), np.hypot(2, 2), np.hypot(2, 2)]]
    assert distances(points, BOXES).tolist() == expected
    assert nearness(BOXES, points).tolist() == [0.0, 1.5, np.hypot(2, 2)]
    assert (nearness(BOXES, np.empty((0, 3))) == np.inf).all()


chunks = st.lists(st.tuples(st.integers(0, 4), st.sampled_from(["comes", "goes", "stays"])), max_size=12)


@given(chunks)
def test_the_nearest_come_first_and_then_the_farthest_go(found):
    off = np.array([each for each, _ in found], float)
    comes, goes = (np.array([what == each for _, what in found], bool) for each in ("comes", "goes"))
    numbered = [(distance, k, what) for k, (distance, what) in enumerate(found)]
    come = sorted((distance, k) for distance, k, what in numbered if what == "comes")
    go = sorted(((distance, k) for distance, k, what in numbered if what == "goes"), reverse=True)
    assert in_order(off, comes, goes) == [k for _, k in [*come, *go]]
