"""Vertices at one place are one, wherever they are listed."""

import numpy as np
import pytest

from navmesh.level.welding import WELD, weld


@pytest.mark.parametrize("far", [0.0, 1e5, -1e9])
def test_vertices_at_the_same_place_are_one(far):
    rng = np.random.default_rng(4)
    places = np.unique(rng.integers(0, 50, (60, 3)), axis=0) * 10.0 * WELD + far
    order = rng.integers(0, len(places), 300)
    index, count = weld(places[order])
    assert count == len(set(order.tolist())) and index.max() == count - 1
    for a, b in rng.integers(0, 300, (500, 2)):
        assert (index[a] == index[b]) == (order[a] == order[b])


def test_places_spread_too_far_for_one_number_are_told_apart_as_well():
    places = np.array([[0.0, 0, 0], [1e9, 1e9, 1e9], [0.0, 0, 0], [1e9, 0, 0]])
    index, count = weld(places)
    assert count == 3 and index[0] == index[2] and len(set(index.tolist())) == 3


def test_nearly_the_same_place_is_the_same():
    index, count = weld(np.array([[0.0, 0, 0], [0.2 * WELD, 0, 0], [3.0 * WELD, 0, 0]]))
    assert count == 2 and index.tolist() == [0, 0, 1]
