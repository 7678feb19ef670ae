"""Typed links: straight ways over obstacles, from floor to floor, that routes take with a skill."""

from pathlib import Path

import numpy as np
import pytest

import navmesh
from benchmarks.obstacle_scenes import box, merged, plate, random_scene
from navmesh.graph.links import LONGEST_RUN_UP
from navmesh.obstacles.kinds import affordances

COURTYARD = Path(__file__).resolve().parents[3] / "examples" / "levels" / "courtyard.obj"


@pytest.fixture(scope="module")
def graph() -> navmesh.NodeGraph:
    return navmesh.NodeGraph.build(navmesh.Terrain.load(COURTYARD))


def test_links_are_straight_and_at_right_angles_to_the_edge(graph: navmesh.NodeGraph) -> None:
    links, obstacles = graph.links, graph.obstacles
    assert len(links) > 50 and set(links.affordance) == set(affordances())
    normal = obstacles.normal[links.obstacle]
    before = links.start - links.edge
    behind = links.end - links.edge
    assert np.allclose(before[:, :2], links.run_up[:, None] * normal[:, :2], atol=1e-9)
    assert np.allclose(behind[:, 0] * normal[:, 1], behind[:, 1] * normal[:, 0], atol=1e-9)
    assert np.all((behind[:, :2] * normal[:, :2]).sum(axis=1) < -0.49)
    assert np.all((links.run_up >= 0.5) & (links.run_up <= LONGEST_RUN_UP))
    assert np.all(np.array(links.affordance) == obstacles.affordance[links.obstacle])


def test_links_cross_the_usable_edge_of_their_obstacle(graph: navmesh.NodeGraph) -> None:
    links, obstacles = graph.links, graph.obstacles
    for k in range(len(links)):
        left, right = obstacles.rim[links.obstacle[k]]
        along = (right - left) / np.linalg.norm(right - left)
        part = (links.edge[k] - left) @ along
        assert np.linalg.norm(left + part * along - links.edge[k]) < 0.02
        assert part - links.radius[k] >= -1e-6
        assert part + links.radius[k] <= np.linalg.norm(right - left) + 1e-6


def test_links_start_and_end_on_the_surface_with_the_room_that_they_promise(graph: navmesh.NodeGraph) -> None:
    links, surface = graph.links, graph.surface
    for points, cells in ((links.start, links.start_cell), (links.end, links.end_cell)):
        centres = surface.centers(cells)
        apart = points - centres
        assert np.all(np.abs(apart[:, :2]) <= surface.resolution / 2 + 1e-9)
        assert np.all(np.abs(apart[:, 2]) <= surface.resolution)
        assert np.all(surface.clearance[cells] - np.linalg.norm(apart[:, :2], axis=1) >= links.radius - 1e-9)
    assert np.all(links.radius >= 0)


def test_heights_of_links_follow_a_slanting_edge() -> None:
    slope = np.array([(-10.0, -8, -1.0), (10, -8, 1.0), (10, 8, 1.0), (-10, 8, -1.0)])
    mesh = merged((slope, np.array([(0, 1, 2), (0, 2, 3)])), box(3, 4, -1.0, 0.6))
    graph = navmesh.NodeGraph.build(navmesh.Terrain.from_arrays(*mesh))
    jumps = graph.links.affordance == "jump"
    assert jumps.sum() >= 4
    for edge, height in zip(graph.links.edge[jumps], graph.links.height[jumps], strict=True):
        assert height == pytest.approx(edge[2] - 0.1 * edge[0], abs=0.01)


def test_every_kind_of_obstacle_gets_a_link() -> None:
    for kind in affordances():
        for seed in range(5):
            scene = random_scene(kind, np.random.default_rng(seed))
            graph = navmesh.NodeGraph.build(scene.terrain)
            assert set(graph.links.obstacle.tolist()) == set(range(len(scene.truths))), scene.what


def test_a_run_up_is_shorter_where_there_is_less_room() -> None:
    mesh = merged(plate(26, 26), box(4, 4, -0.2, 0.4), box(0.4, 20, -0.2, 3, (-4.0, 0.0)))
    graph = navmesh.NodeGraph.build(navmesh.Terrain.from_arrays(*mesh))
    normal = graph.obstacles.normal[graph.links.obstacle]
    short = normal[:, 0] < -0.9
    assert short.any() and np.all(graph.links.run_up[short] < 1.8)
    assert np.all(graph.links.run_up[~short] == LONGEST_RUN_UP)


def test_a_platform_is_reached_only_with_the_skill_for_it(graph: navmesh.NodeGraph) -> None:
    start, goal = (2.4, 26.0, 0.0), (50.0, 3.4, 0.3)
    assert graph.find_path(start, goal).status == "partial"
    assert graph.find_path(start, goal, skills={"jump": (0.31, 0.5)}).status != "complete"
    route = graph.find_path(start, goal, skills={"jump": (0.3, 0.5)})
    assert route.status == "complete" and len(route.links) == 1
    use = route.links[0]
    k = use.link
    assert np.allclose(route.waypoints[use.first], graph.links.start[k], atol=1e-6)
    assert np.allclose(route.waypoints[use.last], graph.links.end[k], atol=1e-6)
    assert graph.obstacles.tag[use.obstacle] == "jump@25.0,3.4,0.3/0"


def test_a_graph_keeps_its_obstacles_and_links_in_a_file(graph: navmesh.NodeGraph, tmp_path: Path) -> None:
    graph.save(tmp_path / "courtyard.npz")
    again = navmesh.NodeGraph.load(tmp_path / "courtyard.npz")
    for one, other in ((graph.obstacles, again.obstacles), (graph.links, again.links)):
        for name, array in one.arrays().items():
            assert np.array_equal(array, getattr(other, name)), name


def test_a_graph_without_obstacles_has_empty_arrays_of_the_right_shape() -> None:
    terrain = navmesh.Terrain.from_arrays(*plate(8, 8))
    for graph in (navmesh.NodeGraph.build(terrain), navmesh.NodeGraph.build(terrain, obstacle_rules=None)):
        assert graph.obstacles.position.shape == (0, 3) and graph.obstacles.rim.shape == (0, 2, 3)
        assert graph.links.start.shape == (0, 3) and len(graph.links) == 0
        assert graph.obstacles.near(np.zeros(3)) == (-1, np.inf)
