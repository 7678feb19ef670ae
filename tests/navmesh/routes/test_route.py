"""What a query answers: a route with its links, legs and places on the surface."""

import numpy as np
import pytest

from navmesh import NavmeshError, NodeGraph, join_chunks
from navmesh.routes.route import STATUSES, Route
from tests.navmesh.pieces import SKILLS, piece


@pytest.fixture(scope="module")
def over():
    """A route over a fence."""
    level = {"0": piece("floor", (0, 0)), "1": piece("fence", (1, 0)), "2": piece("floor", (2, 0))}
    found = NodeGraph.build(join_chunks(level)).find_path((1, 2, 0), (11, 2, 0), 0.3, SKILLS)
    assert isinstance(found, Route) and found.status == STATUSES[0]
    return found


def test_legs_are_what_is_walked_between_the_links(over):
    (use,) = over.links
    before, behind = over.legs()
    assert np.array_equal(before.waypoints, over.waypoints[: use.first + 1])
    assert np.array_equal(behind.waypoints, over.waypoints[use.last :])
    assert len(over.corridor.centers) == len(before.centers) + len(behind.centers)


def test_its_length_is_that_of_its_lines_and_its_cost_without_costs_the_same(over):
    assert over.length == pytest.approx(np.linalg.norm(np.diff(over.waypoints, axis=0), axis=1).sum())
    assert over.cost == over.length
    assert repr(over).startswith(f"<Route complete: {over.length:.2f} m, ") and ", over vault@" in repr(over)


@pytest.mark.parametrize("spacing", [0.0, -1.0, "1", float("nan")])
def test_a_spacing_is_a_distance(over, spacing):
    with pytest.raises(NavmeshError, match=r"spacing = .*: expected a distance"):
        over.on_surface(spacing)


def test_without_a_way_there_are_no_legs(over):
    nowhere = over.graph.find_path((1, 2, 0), (90, 2, 0), 0.3)
    assert nowhere.legs() == [] and nowhere.on_surface().shape == (0, 3)
    assert nowhere.corridor.centers.shape == (0, 3)
