"""Stops of a roadmap are where a body has room, on the portals and beside the borders of areas."""

import math

import numpy as np
import pytest

from benchmarks.area_costs import COSTS, RADIUS
from navmesh import Terrain
from navmesh.areas.areas import checked_costs
from navmesh.areas.pricing import priced_of
from navmesh.graph.open_to_body import doors_of
from tests.navmesh.areas.painted import built
from tests.navmesh.shapes import box, join, plane


@pytest.mark.parametrize("angle", [0.0, 0.3, 0.7])
def test_a_door_hardly_wider_than_the_body_is_passed(angle: float) -> None:
    wide = 0.31
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    walls = box(5.9, 6.1, 0, 6.03 - wide, 0, 3), box(5.9, 6.1, 6.03 + wide, 12, 0, 3)
    vertices, faces = join(plane(0, 6, 0, 12), plane(6, 12, 0, 12), *walls)
    materials = ["grass"] * 2 + ["mud"] * 2 + ["brick"] * 24
    graph = built(Terrain.from_arrays(vertices @ turn, faces, materials=materials))
    start, goal = np.array([[2.0, 2.0, 0.0], [10.0, 2.0, 0.0]]) @ turn
    route = graph.find_path(start, goal, 0.3, costs={"mud": 4.0})
    plain = graph.find_path(start, goal, 0.3)
    assert route.status == plain.status == "complete"
    assert route.length <= 1.05 * plain.length
    narrow = graph.find_path(start, goal, 0.32, costs={"mud": 4.0})
    assert narrow.status == graph.find_path(start, goal, 0.32).status == "partial"


def test_stops_are_where_the_body_has_room(scene):
    _, graph, _, _ = scene
    road = priced_of(graph, doors_of(graph, RADIUS, None, None), checked_costs(graph, COSTS)).road
    places = np.column_stack([road.stops[axis] for axis in "xyz"]) + graph.surface.origin
    gaps = np.array([graph.clearance_at(place) for place in places[::5]])
    assert len(gaps) > 50 and gaps.min() >= RADIUS - 0.02
