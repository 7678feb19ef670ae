"""Where routes begin and end: on the floor with the body's room, as near as can be to what was asked for."""

import math

import numpy as np
import pytest
from scipy.ndimage import label

from benchmarks.visibility import Boxes, boxes_level, gaps_to_boxes, random_boxes
from navmesh import NodeGraph, Terrain, WalkRules
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


def brute_force(graph: NodeGraph, boxes, start, goal, radius: float) -> float:
    """Least distance from ``goal`` to a point with ``radius`` clear that can be walked to from ``start``, by
    flooding a fine grid."""
    step = 0.02
    nx, ny = (int(side / step) for side in boxes.floor)
    x, y = np.meshgrid((np.arange(nx) + 0.5) * step, (np.arange(ny) + 0.5) * step, indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel()])
    free = (gaps_to_boxes(boxes, points) >= radius).reshape(nx, ny)
    parts = label(free)[0]
    here = parts[int(start[0] / step), int(start[1] / step)]
    assert here > 0
    reached = (parts == here).ravel()
    return float(np.hypot(*(points[reached] - goal[:2]).T).min())


@pytest.mark.parametrize("seed", range(4))
def test_a_partial_route_ends_at_the_nearest_place_that_can_be_reached(seed: int) -> None:
    rng = np.random.default_rng(50 + seed)
    loose = random_boxes(rng, 4, (14.0, 8.0))
    # a wall from edge to edge, at any angle, makes two parts
    wall = np.array([[rng.uniform(6.0, 8.0), 4.0]]), np.array([[9.0, 0.1]]), rng.uniform(1.2, 1.9, 1)
    boxes = Boxes(
        (14.0, 8.0),
        np.concatenate([loose.centre, wall[0]]),
        np.concatenate([loose.half, wall[1]]),
        np.concatenate([loose.angle, wall[2]]),
    )
    graph = NodeGraph.build(boxes_level(boxes), WalkRules(), None)
    radius = float(rng.choice([0.2, 0.3, 0.5]))
    points = rng.uniform((0.0, 0.0), boxes.floor, (200, 2))
    points = points[gaps_to_boxes(boxes, points) > radius + 0.1]
    checked = 0
    for a, b in zip(points[:40], points[40:80], strict=False):
        route = graph.find_path((*a, 0.0), (*b, 0.0), radius)
        if route.status not in ("partial", "no_path"):
            continue
        best = brute_force(graph, boxes, a, b, radius)
        end = route.waypoints[-1, :2] if route.status == "partial" else a
        assert math.dist(end, b) < best + 0.125  # half a cell
        checked += 1
    assert checked >= 3


def test_an_unreachable_goal_costs_no_more_than_one_that_can_be_reached() -> None:
    level = join(plane(0.0, 80.0, 0.0, 20.0), box(39.9, 40.1, 0.0, 20.0, -0.1, 2.5))
    graph = build(*level)
    near = graph.find_path((1.0, 10.0, 0.0), (39.0, 16.0, 0.0), 0.3)
    far = graph.find_path((1.0, 10.0, 0.0), (79.0, 16.0, 0.0), 0.3)
    assert near.status == "complete" and far.status == "partial"
    assert np.allclose(far.waypoints[-1], (39.6, 16.0, 0.0), atol=0.05)
    assert far.expanded <= 2 * near.expanded + 64


def test_a_part_that_only_a_link_leads_to_counts_as_reachable() -> None:
    platform_ = box(10.0, 20.0, 0.0, 10.0, -0.5, 0.45)
    terrain = Terrain.from_arrays(*join(plane(0.0, 10.0, 0.0, 10.0), platform_))
    graph = NodeGraph.build(terrain, WalkRules())
    start, goal = (2.0, 5.0, 0.0), (18.0, 5.0, 0.45)
    without = graph.find_path(start, goal, 0.3)
    assert without.status == "partial" and without.waypoints[-1, 0] > 9.5
    over = graph.find_path(start, goal, 0.3, skills={"jump": (0.3, 0.6)})
    assert over.status == "complete" and len(over.links) == 1
