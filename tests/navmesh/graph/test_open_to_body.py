"""What one body makes of a graph is worked out once, and wrong offers are refused."""

import numpy as np
import pytest

from navmesh import NavmeshError
from navmesh.graph.open_to_body import checked_radius, doors_of, parts_of, portals_of
from tests.navmesh.surface.levels import build, random_level


@pytest.fixture(scope="module")
def graph():
    return build(*random_level(1))


@pytest.mark.parametrize("radius", [0.0, -1.0, float("nan"), float("inf"), "wide", None, True])
def test_a_radius_is_a_number_above_nought(radius):
    with pytest.raises(NavmeshError, match="radius"):
        checked_radius(radius)


def test_a_radius_of_any_library_is_a_float():
    assert type(checked_radius(np.float32(0.5))) is float and checked_radius(1) == 1.0


def test_portals_and_parts_are_kept(graph):
    assert portals_of(graph, 0.3) is portals_of(graph, 0.3)
    assert parts_of(graph, 0.3) is parts_of(graph, 0.3)
    assert doors_of(graph, 0.3, None, None) is doors_of(graph, 0.3, None, None)
    assert doors_of(graph, 0.3, {"jump": (0.1, 0.5)}, None).doors is doors_of(graph, 0.3, None, None).doors
    assert doors_of(graph, 0.4, None, None) is not doors_of(graph, 0.3, None, None)


def test_wider_bodies_have_fewer_portals(graph):
    counts = [len(portals_of(graph, radius)[1]) for radius in (0.15, 0.3, 0.6, 1.2, 9.0)]
    assert counts == sorted(counts, reverse=True) and counts[0] > counts[-1] == 0
