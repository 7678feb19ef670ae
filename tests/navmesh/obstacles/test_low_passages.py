"""Ways under beams and through low openings: where they are, how low and how long, and who takes them."""

import math

import numpy as np
import pytest

import navmesh
from navmesh.obstacles.low_passages import find_low_passages
from tests.navmesh.shapes import box, join, plane, quad, terrain

HEIGHTS = (0.9, 1.7)


@pytest.fixture
def crouch():
    navmesh.register_kind(navmesh.crouch_kind(HEIGHTS))
    yield
    navmesh.unregister_kind("crouch")


def turned(mesh, angle):
    vertices, faces = mesh
    c, s = math.cos(angle), math.sin(angle)
    return vertices @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]), faces


def hall(height, thick, angle=0.0):
    """A hall of 12 x 6 m between walls, with a beam across it at x = 5."""
    walls = box(0, 12, -0.2, 0, -0.1, 3), box(0, 12, 6, 6.2, -0.1, 3)
    beam = box(5, 5 + thick, 0, 6, height, height + 1.0)
    return terrain(turned(join(plane(0, 12, 0, 6), beam, *walls), angle))


def passages(level):
    graph = navmesh.NodeGraph.build(level, obstacle_rules=None)
    return find_low_passages(level, graph.surface, graph.rules, HEIGHTS, 0.6)


@pytest.mark.parametrize("seed", range(6))
def test_the_way_under_a_beam_is_as_low_and_as_long_as_the_beam(seed):
    rng = np.random.default_rng(seed)
    height, thick, angle = rng.uniform(0.95, 1.65), rng.choice([0.03, 0.3, 1.7]), rng.uniform(0, math.pi)
    found = passages(hall(height, thick, angle))
    assert len(found) == 2
    np.testing.assert_allclose(found.height, height, atol=2e-4)
    np.testing.assert_allclose(found.depth, thick, atol=2e-3)
    assert (found.width > 5.4).all() and (found.width < 6.0 + 1e-6).all()
    facing = found.normal[:, :2] @ np.array([math.cos(angle), math.sin(angle)])
    np.testing.assert_allclose(np.sort(facing), [-1.0, 1.0], atol=1e-3)


def test_who_bends_down_far_enough_gets_under_it(crouch):
    graph = navmesh.NodeGraph.build(hall(1.3, 0.6, 0.4))
    start, goal = turned((np.array([[2.0, 3, 0], [10.0, 3, 0]]), None), 0.4)[0]
    assert graph.find_path(start, goal).status == "partial"
    assert graph.find_path(start, goal, skills={"crouch": (1.4, 1.8)}).status == "partial"
    route = graph.find_path(start, goal, skills={"crouch": (1.2, 1.8)})
    assert route.status == "complete" and route.length < 8.2
    assert [graph.links.affordance[use.link] for use in route.links] == ["crouch"]
    back = graph.find_path(goal, start, skills={"crouch": (1.2, 1.8)})
    assert back.status == "complete"


def test_ways_under_a_table_lead_between_its_legs():
    legs = [box(x, x + 0.08, y, y + 0.08, 0, 1.1) for x in (3, 4.92) for y in (3, 4.12)]
    found = passages(terrain(plane(0, 8, 0, 8), box(3, 5, 3, 4.2, 1.1, 1.2), *legs))
    sides = {(round(x), round(y)): (depth, width) for (x, y, _), depth, width in
             zip(found.normal, found.depth, found.width, strict=True)}  # fmt: skip
    assert set(sides) == {(-1, 0), (1, 0), (0, -1), (0, 1)}
    for (x, _), (depth, width) in sides.items():
        assert depth == pytest.approx(2.0 if x else 1.2, abs=2e-3)
        assert 1.0 - 0.16 <= width <= 1.2 - 0.16 + 0.1 if x else 1.8 - 0.16 <= width <= 2.0 - 0.16 + 0.1


def test_a_curtain_has_no_thickness():
    found = passages(terrain(plane(0, 8, 0, 8), quad((4, 0, 1.2), (4, 8, 1.2), (4, 8, 3), (4, 0, 3))))
    assert len(found) == 2
    np.testing.assert_allclose(found.depth, 0.0, atol=2e-3)
    np.testing.assert_allclose(found.height, 1.2, atol=0.011)


@pytest.mark.parametrize("height", [0.8, 1.75, 1.9])
def test_what_is_too_low_or_high_enough_to_walk_under_is_no_low_passage(height):
    assert len(passages(hall(height, 0.4))) == 0


@pytest.mark.parametrize(("width", "count"), [(0.9, 2), (0.5, 0)])
def test_a_hole_in_a_wall_is_wide_enough_or_not(width, count):
    wall = box(4, 4.3, 0, 3 - width / 2, 0, 3), box(4, 4.3, 3 + width / 2, 6, 0, 3)
    lintel = box(4, 4.3, 3 - width / 2, 3 + width / 2, 1.2, 3)
    found = passages(terrain(plane(0, 8, 0, 6), *wall, lintel))
    assert len(found) == count
    assert (found.width <= width + 1e-6).all()


def test_a_body_wider_than_the_hole_does_not_get_through(crouch):
    wall = box(4, 4.3, -1, 2.5, 0, 3), box(4, 4.3, 3.5, 7, 0, 3), box(4, 4.3, 2.5, 3.5, 1.2, 3)
    graph = navmesh.NodeGraph.build(terrain(plane(0, 8, 0, 6), *wall))
    start, goal, skills = (2, 3, 0), (6, 3, 0), {"crouch": (1.0, 1.8)}
    assert graph.find_path(start, goal, 0.3, skills).status == "complete"
    assert graph.find_path(start, goal, 0.6, skills).status == "partial"


def test_a_beam_over_a_ramp_leaves_the_same_height_all_the_way():
    slope = 0.2
    ramp = quad((0, 0, 0), (10, 0, 10 * slope), (10, 6, 10 * slope), (0, 6, 0))
    lid = [(x, y, z) for z in (1.3, 2.3) for x, y in ((5, -1), (6, -1), (6, 7), (5, 7))]
    vertices = np.array([(x, y, z + slope * x) for x, y, z in lid])
    sides = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    faces = np.array([f for a, b, c, d in sides for f in ((a, b, c), (a, c, d))])
    found = passages(terrain(ramp, (vertices, faces)))
    assert len(found) == 2
    np.testing.assert_allclose(found.height, 1.3, atol=0.02)
    np.testing.assert_allclose(np.sort(found.rise), [-slope, slope], atol=0.02)


def test_nothing_changes_for_who_does_not_register_the_kind():
    graph = navmesh.NodeGraph.build(hall(1.3, 0.6))
    assert "crouch" not in graph.obstacles.affordance


def test_a_graph_with_low_passages_comes_back_from_its_file(crouch, tmp_path):
    level = hall(1.3, 0.6)
    graph = navmesh.NodeGraph.build(level)
    graph.save(tmp_path / "hall.graph")
    back = navmesh.NodeGraph.load(tmp_path / "hall.graph", level)
    assert (back.obstacles.affordance == graph.obstacles.affordance).all()
    assert (back.obstacles.affordance == "crouch").sum() == 2


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"heights": (1.7, 1.0)}, "heights"),
        ({"heights": 1.0}, "heights"),
        ({"heights": (0.0, 1.0)}, "heights"),
        ({"width": 0.0}, "width"),
        ({"effort": (-1.0, 0.0)}, "effort"),
    ],
)
def test_a_wrong_kind_is_refused(values, says):
    with pytest.raises(navmesh.NavmeshError, match=says):
        navmesh.crouch_kind(**values)
