"""Where routes begin and end: on the floor with the body's room, as near as can be to what was asked for."""

import math

import numpy as np
import pytest

from navmesh import NodeGraph
from tests.navmesh.routes.path_references import build, turned
from tests.navmesh.shapes import box, join, plane

FIELD_ERROR = 0.03
"""[m] by which the clearance field may read too wide, see docs/how-it-works/navmesh.md."""


def platform(rng: np.random.Generator) -> tuple[NodeGraph, np.ndarray, float]:
    """A turned rectangle of floor that ends in ledges: the graph, its sides and the angle."""
    sides = rng.uniform(4.0, 9.0, 2)
    angle = rng.uniform(0.0, math.pi / 2)
    vertices, faces = plane(0.0, sides[0], 0.0, sides[1])
    return build(turned(vertices, angle), faces), sides, angle


@pytest.mark.parametrize("seed", range(6))
def test_routes_begin_and_end_on_the_floor_with_room(seed: int) -> None:
    rng = np.random.default_rng(100 + seed)
    graph, sides, angle = platform(rng)
    radius = float(rng.uniform(0.3, 0.6))
    asked = np.column_stack([rng.uniform(-1.0, sides + 1.0, (300, 2)), np.zeros(300)])
    middle = np.array([*sides / 2, 0.0])
    routes = graph.find_paths(turned(asked, angle), np.tile(turned(middle[None], angle), (300, 1)), radius)
    assert (routes.status == "complete").sum() > 150
    for k in np.flatnonzero(routes.status == "complete"):
        way = turned(routes.waypoints_of(k), -angle)[:, :2]
        assert np.minimum(way, sides - way).min() > radius - FIELD_ERROR
        beside = np.clip(asked[k, :2], radius, sides - radius)
        moved = math.dist(way[0], asked[k, :2])
        assert moved < math.dist(beside, asked[k, :2]) + FIELD_ERROR + 0.02 * radius


def test_an_end_in_the_air_stands_for_the_nearest_floor() -> None:
    crate = box(4.0, 6.0, 4.0, 6.0, 0.0, 1.0)
    graph = build(*join(plane(0.0, 10.0, 0.0, 10.0), crate))
    above = graph.find_path((2.0, 2.0, 1.9), (2.0, 3.0, 0.0), 0.3)
    assert above.status == "complete" and np.allclose(above.waypoints[0], (2.0, 2.0, 0.0), atol=1e-9)
    # 0.9 m above the floor, 0.4 m beside the crate and 0.1 m below its top
    on_top = graph.find_path((3.9, 5.0, 0.9), (5.0, 5.0, 1.0), 0.3)
    assert on_top.status == "complete" and on_top.waypoints[0, 2] == pytest.approx(1.0)


def test_the_extent_says_how_far_an_end_may_be_moved() -> None:
    graph = build(*plane(0.0, 10.0, 0.0, 10.0))
    goal = (5.0, 5.0, 0.0)
    for start, extent, status in (
        ((5.0, 4.0, 3.0), None, "off_graph"),
        ((5.0, 4.0, 3.0), (1.0, 3.5), "complete"),
        ((-2.0, 5.0, 0.0), None, "off_graph"),
        ((-2.0, 5.0, 0.0), (3.0, 1.0), "complete"),
        ((-2.0, 5.0, 0.0), (2.2, 1.0), "off_graph"),
    ):
        route = graph.find_path(start, goal, 0.3, extent=extent)
        assert route.status == status
        assert graph.find_paths([start], [goal], 0.3, extent=extent).status[0] == status
        search = graph.begin_path(start, goal, 0.3, extent=extent)
        assert search.advance(10**6) and search.finish().status == status
