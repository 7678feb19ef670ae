"""Spatial queries on a level with known distances: one point at a time and in batches."""

import numpy as np
import pytest

from navmesh import NavmeshError, NodeGraph, WalkRules
from tests.navmesh.shapes import box, plane, terrain

RULES = WalkRules(max_step=0.2, headroom=2.0)


@pytest.fixture(scope="module")
def graph() -> NodeGraph:
    """Two halls of 6 by 6 m joined by a doorway of 1 m, one storey above the first, an island apart."""
    wall = [box(6, 6.5, 0, 2.5, 0, 3), box(6, 6.5, 3.5, 6, 0, 3)]
    floors = [plane(0, 12.5, 0, 6), plane(0, 5, 0, 6, 3.0), plane(20, 23, 0, 3)]
    return NodeGraph.build(terrain(*floors, *wall), RULES, obstacle_rules=None)


def test_project_takes_the_nearest_storey(graph):
    cells, heights = graph.project([[2, 3, 0.4], [2, 3, 2.4], [16, 3, 0], [2, 3, 9]])
    assert heights[:2] == pytest.approx([0, 3])
    assert (cells[:2] >= 0).all()
    assert (cells[2:] == -1).all() and np.isnan(heights[2:]).all()
    cell, height = graph.project((2, 3, 0.4))
    assert (cell, height) == (cells[0], heights[0])


def test_clearance_and_nearest_edge(graph):
    points = np.array([[1.125, 3.125, 0], [6.125, 3.125, 0], [9.125, 3.125, 0], [16, 3, 0]])
    distance, place = graph.nearest_edge(points)
    assert distance == pytest.approx([1.125, 0.375, np.hypot(2.625, 0.375), 0], abs=0.02)
    assert place[0] == pytest.approx([0, 3.125], abs=0.02)
    assert np.isnan(place[3]).all()
    assert graph.clearance_at(points[1]) == distance[1]


def test_nodes_around_a_point(graph):
    points = graph.random_points(np.random.default_rng(0), 200, 0.2)
    nearest = graph.nearest_node(points)
    between = np.linalg.norm(graph.positions[None] - points[:, None], axis=2)
    np.testing.assert_array_equal(nearest, between.argmin(axis=1))
    owner = graph.containing_node(points)
    reach = np.linalg.norm(graph.positions[owner, :2] - points[:, :2], axis=1)
    assert (owner >= 0).all()
    assert (reach <= graph.radii[owner] + RULES.resolution).all()
    assert graph.containing_node((16, 3, 0)) == -1


def test_ray_stops_at_walls_and_passes_doors(graph):
    starts = [[3, 3, 0], [3, 1, 0], [3, 3, 0], [16, 3, 0]]
    ends = [[9, 3, 0], [9, 1, 0], [9, 3, 0], [17, 3, 0]]
    ray = graph.cast_ray(starts, ends, 0.3)
    assert ray.clear.tolist() == [True, False, True, False]
    assert ray.end[1] == pytest.approx([5.7, 1, 0], abs=0.05)
    assert ray.share[1] == pytest.approx(2.7 / 6, abs=0.01)
    assert not graph.cast_ray(starts[0], ends[0], 0.6).clear
    thin = graph.cast_ray(starts[1], ends[1])
    assert thin.end == pytest.approx([6, 1, 0], abs=0.05)


def test_random_points_fit_and_are_reachable_and_repeat(graph):
    points = graph.random_points(np.random.default_rng(7), 300, 0.4)
    np.testing.assert_array_equal(points, graph.random_points(np.random.default_rng(7), 300, 0.4))
    assert (graph.clearance_at(points) >= 0.4).all()
    assert {round(z) for z in points[:, 2]} == {0, 3}
    assert points[:, 0].max() > 20
    near = graph.random_points(np.random.default_rng(7), 300, 0.4, reachable_from=(3, 3, 0))
    assert (near[:, 0] < 12.5).all() and (near[:, 2] < 1).all()
    with pytest.raises(NavmeshError, match="no place"):
        graph.random_points(np.random.default_rng(7), 1, 50.0)


def test_reachable_set_depends_on_the_radius(graph):
    for radius, joined in ((0.3, True), (0.6, False)):
        nodes = graph.reachable_nodes((3, 3, 0), radius)
        assert (graph.containing_node((9, 3, 0)) in nodes) == joined
        assert graph.containing_node((21.5, 1.5, 0)) not in nodes
    assert len(graph.reachable_nodes((16, 3, 0), 0.3)) == 0


def test_room_to_turn(graph):
    points = [[3, 3, 0], [6.25, 3, 0], [0.5, 0.5, 0], [16, 3, 0]]
    assert graph.room_to_turn(points, 0.8).tolist() == [True, True, True, False]
    assert graph.room_to_turn((21.5, 1.5, 0), 2.5)
    assert not graph.room_to_turn((21.5, 1.5, 0), 3.5)


@pytest.mark.parametrize("wrong", [(1, 2), "here", [[1, 2, np.nan]], [[[1, 2, 3]]]])
def test_wrong_points_are_refused(graph, wrong):
    with pytest.raises(NavmeshError, match="points"):
        graph.project(wrong)


def test_wrong_sizes_are_refused(graph):
    with pytest.raises(NavmeshError, match="radius"):
        graph.cast_ray((1, 1, 0), (2, 2, 0), -1.0)
    with pytest.raises(NavmeshError, match="ends"):
        graph.cast_ray((1, 1, 0), [(2, 2, 0)] * 2)
    with pytest.raises(NavmeshError, match="length"):
        graph.room_to_turn((1, 1, 0), float("nan"))
