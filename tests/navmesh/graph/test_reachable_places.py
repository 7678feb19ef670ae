"""Goals that cannot be reached: the nearest place that can be."""

import math

import numpy as np
import pytest
from scipy.ndimage import label

from benchmarks.visibility import Boxes, boxes_level, gaps_to_boxes, random_boxes
from navmesh import NodeGraph, Terrain, WalkRules
from navmesh.graph.kernel_arrays import make_scratch, net_of
from navmesh.graph.open_to_body import doors_of
from navmesh.graph.reachable_places import nearest_reachable, off_disc
from navmesh.graph.snapping import node_at, place_in
from tests.navmesh.routes.path_references import build, scene
from tests.navmesh.shapes import box, join, plane


def over_all_cells(graph: NodeGraph, doors, scratch, goal: np.ndarray) -> float:
    """Distance of the nearest place in the parts marked: each cell of the level is asked."""
    net, radius, mark = net_of(graph), doors.radius, scratch.numbers[0]

    def is_reached(node: int) -> bool:
        return node >= 0 and scratch.reached[doors.part[node]] == mark

    best = math.inf
    centre = graph.surface.centers() - graph.surface.origin
    for k in np.flatnonzero(graph.surface.clearance >= radius - 0.7072 * graph.surface.resolution):
        square, x, y = place_in(net, k, *goal, radius, 0.0, 1e300)
        if square < 1e300 and is_reached(node_at(net, k, x, y, radius)):
            best = min(best, math.sqrt(square))
        if graph.surface.clearance[k] >= radius and is_reached(graph.label[k]):
            best = min(best, math.dist(centre[k], goal))
    return best


@pytest.mark.parametrize("seed", range(3))
def test_no_place_in_the_parts_is_nearer(seed: int) -> None:
    graph, rng = scene(seed, 9)
    net, scratch, doors = net_of(graph), make_scratch(graph), doors_of(graph, 0.45, None, None)
    parts = np.unique(doors.tile_part)
    for goal in rng.uniform((-2.0, -2.0, -1.0), (16.0, 16.0, 3.0), (5, 3)):
        scratch.numbers[0] += 1
        chosen = rng.choice(parts, max(1, len(parts) // 3), replace=False)
        scratch.reached[chosen] = scratch.numbers[0]
        scratch.part_stack[: len(chosen)] = chosen
        rows = int(np.isin(doors.tile_part, chosen).sum())
        node, _, _, _, far = nearest_reachable(net, doors, scratch, len(chosen), rows, *goal, 1e300)
        nearest = over_all_cells(graph, doors, scratch, goal)
        assert far == pytest.approx(nearest, abs=1e-12) if node >= 0 else nearest == math.inf


@pytest.mark.parametrize("seed", range(3))
def test_how_far_what_a_disc_leaves_of_a_square_is(seed: int) -> None:
    rng = np.random.default_rng(seed)
    fine = np.stack(np.meshgrid(*[np.linspace(-1.0, 1.0, 401)] * 2), axis=-1).reshape(-1, 2)
    covered = 0
    for _ in range(60):
        half, radius = rng.uniform(0.05, 0.3), rng.uniform(0.1, 0.8)
        centre, blocker, goal = rng.uniform(-0.5, 0.5, (3, 2))
        places = centre + half * fine
        free = places[np.hypot(*(places - blocker).T) >= radius]
        found = math.sqrt(off_disc(*centre, half, *blocker, radius, *goal))
        if len(free):
            assert found == pytest.approx(np.hypot(*(free - goal).T).min(), abs=half / 100)
        else:
            covered += 1
            assert found > 1e100 or radius - np.hypot(*(places - blocker).T).max() < half / 100
    assert covered > 2


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
