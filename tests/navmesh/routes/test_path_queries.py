"""Routes: found where there is a way, short, clear of walls, and the same however they are asked for."""

import math

import networkx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navmesh import NavmeshError, NodeGraph
from navmesh.graph.kernel_arrays import make_scratch, net_of
from navmesh.graph.open_to_body import doors_of, portals_of
from navmesh.graph.snapping import snap
from navmesh.routes.graph_search import ALL, BEST, COMPLETE, EXPANDED, advance, begin, resume
from tests.navmesh.routes.path_references import (
    FIELD_ERROR,
    build,
    gap_of,
    pillars,
    pillars_level,
    plain_search,
    scene,
    turned,
)
from tests.navmesh.shapes import box, join, plane, terrain

RADII = st.sampled_from([0.15, 0.3, 0.6, 0.9])
SEEDS = st.integers(0, 10_000)


@settings(max_examples=15, deadline=None, derandomize=True)
@given(SEEDS, RADII)
def test_every_point_of_a_route_has_the_clearance(seed: int, radius: float) -> None:
    rng = np.random.default_rng(seed)
    rectangles = pillars(rng, 7)
    graph = build(*pillars_level(rectangles))
    ends = np.column_stack([rng.uniform(0.0, 14.0, (60, 2)), np.zeros(60)])
    ends = ends[gap_of(rectangles, ends) > 0.03][:12]
    for route in graph.find_paths(ends[:6], ends[6:], radius=radius):
        if len(route.waypoints):
            gap = gap_of(rectangles, route.on_surface(0.02))
            assert gap.min() > radius - FIELD_ERROR


@settings(max_examples=10, deadline=None, derandomize=True)
@given(SEEDS, RADII)
def test_a_route_exists_where_networkx_finds_one(seed: int, radius: float) -> None:
    graph, rng = scene(seed)
    wide = networkx.Graph()
    wide.add_nodes_from(range(len(graph)))
    edges = graph.to_networkx().edges(data="width")
    wide.add_edges_from((a, b) for a, b, width in edges if width >= radius)
    ends = np.column_stack([rng.uniform(0.5, 13.5, (16, 2)), np.zeros(16)])
    net, origin = net_of(graph), graph.surface.origin
    for start, goal in zip(ends[:8], ends[8:], strict=True):
        route = graph.find_path(start, goal, radius)
        nodes = [snap(net, *(end - origin), radius, 2 * radius + 0.5, 2.7, 0.2)[0] for end in (start, goal)]
        if min(nodes) < 0:
            assert route.status == "off_graph"
        elif networkx.has_path(wide, *nodes):
            assert route.status == "complete"
            assert route.nodes[0] == nodes[0] and route.nodes[-1] == nodes[1]
            assert all(wide.has_edge(a, b) for a, b in zip(route.nodes[:-1], route.nodes[1:], strict=True))
        else:
            assert route.status in ("partial", "no_path")


@pytest.mark.parametrize("seed", range(4))
def test_search_agrees_with_the_plain_one(seed: int) -> None:
    graph, rng = scene(seed, 5)
    net, origin = net_of(graph), graph.surface.origin
    doors, scratch = doors_of(graph, 0.3, None, None), make_scratch(graph)
    start, rows = portals_of(graph, 0.3)[:2]
    target, portal = rows["target"], rows["portal"]
    checked = longer = 0
    for _ in range(12):
        s, g = np.column_stack([rng.uniform(0.5, 13.5, (2, 2)), np.zeros(2)])
        first, _, sx, sy = snap(net, *(s - origin), 0.3, 1.1, 1.8, 0.2)
        last, _, gx, gy = snap(net, *(g - origin), 0.3, 1.1, 1.8, 0.2)
        if min(first, last) < 0 or graph.find_path(s, g, 0.3).status != "complete":
            continue
        z = -origin[2]
        begin(net, doors, scratch, first, last, sx, sy, z, gx, gy, z)
        assert advance(net, doors, scratch, 10**6) == COMPLETE
        found = plain_search(start, target, portal, first, last, np.array([sx, sy, z]), np.array([gx, gy, z]))
        if found is not None:
            total = scratch.labels["total"][scratch.numbers[BEST]]
            # a label knows the funnel's two corners, not all portals: it may promise a little too much
            assert 0.95 * found[0] < total < 1.05 * found[0]
            longer += total > 1.01 * found[0]
            checked += 1
    assert checked >= 4 and longer <= 1


def test_ways_set_aside_lead_to_what_a_search_of_all_ways_finds() -> None:
    expanded, kept, at_once, checked = [0, 0], 0, 0, 0
    for seed in range(4):
        graph, rng = scene(seed, 25)
        net, origin = net_of(graph), graph.surface.origin
        doors, scratch = doors_of(graph, 0.3, None, None), make_scratch(graph)
        for _ in range(40):
            places = rng.uniform(0.5, 13.5, (2, 2))
            (first, _, *s), (last, _, *g) = (
                snap(net, *(np.append(place, 0.0) - origin), 0.3, 1.1, 1.8, 0.2) for place in places
            )
            if min(first, last) < 0:
                continue
            totals = []
            for every in (1, 0):
                begin(net, doors, scratch, first, last, *s, -origin[2], *g, -origin[2])
                scratch.numbers[ALL] = every
                if advance(net, doors, scratch, 10**6) == COMPLETE:
                    totals.append(scratch.labels["total"][scratch.numbers[BEST]])
                expanded[every] += scratch.numbers[EXPANDED]
            if not totals:
                continue
            best, found = totals
            assert found >= best - 1e-9
            at_once += found <= best + 1e-9
            while resume(net, doors, scratch, 10**6) == COMPLETE:
                found = min(found, scratch.labels["total"][scratch.numbers[BEST]])
            kept += found <= best + 1e-9
            checked += 1
    assert kept == checked > 100
    assert 0.85 * checked < at_once < checked
    assert expanded[0] < 0.8 * expanded[1]


def test_a_search_ended_early_gives_a_partial_route() -> None:
    graph, _ = scene(4, 12)
    search = graph.begin_path((1.0, 1.0, 0.0), (13.0, 13.0, 0.0), 0.3)
    assert not search.advance(4)
    early = search.finish()
    assert early.status == "partial"
    end = early.waypoints[-1]
    assert math.dist(end, (13.0, 13.0, 0.0)) < math.dist((1.0, 1.0, 0.0), (13.0, 13.0, 0.0)) - 0.2


def test_results_do_not_depend_on_the_order_of_triangles() -> None:
    rng = np.random.default_rng(8)
    vertices, faces = pillars_level(pillars(rng, 8))
    graph = build(vertices, faces)
    shuffled = build(vertices, np.roll(rng.permutation(faces), 1, axis=1))
    ends = np.column_stack([rng.uniform(0.5, 13.5, (60, 2)), np.zeros(60)])
    one, two = (g.find_paths(ends[:30], ends[30:], radius=0.3) for g in (graph, shuffled))
    assert np.array_equal(one.status, two.status)
    assert np.allclose(one.waypoints, two.waypoints, atol=1e-9)


@settings(max_examples=8, deadline=None, derandomize=True)
@given(SEEDS, st.floats(0.1, 6.2))
def test_turning_the_level_turns_the_answer(seed: int, angle: float) -> None:
    rng = np.random.default_rng(seed)
    vertices, faces = pillars_level(pillars(rng, 5))
    ends = np.column_stack([rng.uniform(1.5, 12.5, (20, 2)), np.zeros(20)])
    one = build(vertices, faces).find_paths(ends[:10], ends[10:], radius=0.4)
    ends = turned(ends, angle)
    two = build(turned(vertices, angle), faces).find_paths(ends[:10], ends[10:], radius=0.4)
    both = (one.status == "complete") & (two.status == "complete")
    assert both.sum() >= 0.7 * (one.status == "complete").sum()
    if both.any():
        ratio = two.length[both] / np.maximum(one.length[both], 1.0)
        assert np.median(np.abs(ratio - 1.0)) < 0.03


def test_turning_by_a_quarter_changes_nothing_but_the_direction() -> None:
    rng = np.random.default_rng(5)
    vertices, faces = pillars_level(pillars(rng, 8))
    ends = np.column_stack([rng.uniform(1.0, 13.0, (60, 2)), np.zeros(60)])
    one = build(vertices, faces).find_paths(ends[:30], ends[30:], radius=0.4)
    ends = turned(ends, math.pi / 2)
    two = build(turned(vertices, math.pi / 2), faces).find_paths(ends[:30], ends[30:], radius=0.4)
    assert np.array_equal(one.status, two.status)
    assert np.median(np.abs(one.length - two.length)) < 0.02


def two_plates() -> NodeGraph:
    return build(*join(plane(0.0, 6.0, 0.0, 6.0), plane(8.0, 14.0, 0.0, 6.0), plane(0.0, 6.0, 0.0, 6.0, 3.0)))


def test_a_goal_in_another_part_is_approached() -> None:
    graph = two_plates()
    route = graph.find_path((1.0, 3.0, 0.0), (12.0, 3.0, 0.0), 0.3)
    assert route.status == "partial"
    assert route.waypoints[-1, 0] > 5.0 and abs(route.waypoints[-1, 1] - 3.0) < 1.5


def test_storeys_are_told_apart_by_height() -> None:
    graph = two_plates()
    above = graph.find_path((1.0, 1.0, 3.0), (5.0, 5.0, 3.1), 0.3)
    assert above.status == "complete" and np.allclose(above.waypoints[:, 2], 3.0, atol=1e-6)
    assert graph.find_path((3.0, 3.0, 0.0), (3.0, 3.0, 3.0), 0.3).status == "no_path"


def test_ends_off_the_graph_are_said_to_be() -> None:
    graph = two_plates()
    inside, outside = (3.0, 3.0, 0.0), (3.0, 30.0, 0.0)
    for start, goal in ((inside, outside), (outside, inside), ((3.0, 3.0, 80.0), inside)):
        route = graph.find_path(start, goal, 0.3)
        assert route.status == "off_graph"
        assert route.waypoints.shape == (0, 3) and route.length == 0.0 and len(route.corridor.radii) == 0


def test_ends_too_close_to_a_wall_are_moved_off_it() -> None:
    graph = build(*join(plane(0.0, 10.0, 0.0, 10.0), box(4.0, 6.0, 4.0, 6.0, 0.0, 3.0)))
    route = graph.find_path((3.9, 5.0, 0.0), (6.1, 5.0, 0.0), 0.5)
    assert route.status == "complete"
    assert np.allclose(route.waypoints[0], (3.5, 5.0, 0.0), atol=0.1)
    assert np.allclose(route.waypoints[-1], (6.5, 5.0, 0.0), atol=0.1)


def test_a_wide_body_does_not_fit_a_narrow_door() -> None:
    wall = (box(0.0, 4.5, 4.9, 5.1, 0.0, 3.0), box(5.5, 10.0, 4.9, 5.1, 0.0, 3.0))
    graph = build(*join(plane(0.0, 10.0, 0.0, 10.0), *wall))
    start, goal = (5.0, 1.0, 0.0), (5.0, 9.0, 0.0)
    assert graph.find_path(start, goal, 0.35).status == "complete"
    assert graph.find_path(start, goal, 0.6).status == "partial"


def test_costly_nodes_are_gone_round() -> None:
    graph = build(
        *join(plane(0.0, 20.0, 0.0, 20.0), *(box(x, x + 1, 6.0, 14.0, 0.0, 3.0) for x in (5.0, 14.0)))
    )
    start, goal = (10.0, 2.0, 0.0), (10.0, 18.0, 0.0)
    free = graph.find_path(start, goal, 0.3)
    middle = (np.abs(graph.positions[:, 0] - 10.0) < 3.9) & (np.abs(graph.positions[:, 1] - 10.0) < 4.0)
    costly = graph.find_path(start, goal, 0.3, node_costs=np.where(middle, 20.0, 1.0))
    assert np.abs(free.on_surface()[:, 0] - 10.0).max() < 1.0
    assert np.abs(costly.on_surface()[:, 0] - 10.0).max() > 4.0
    assert costly.status == "complete" and costly.length > free.length


def test_wrong_arguments_are_refused() -> None:
    graph = two_plates()
    a = (1.0, 1.0, 0.0)
    for call, words in (
        (lambda: graph.find_path((1.0, 2.0), a), "start: expected three numbers"),
        (lambda: graph.find_path(a, (1.0, math.nan, 0.0)), "goal: expected finite"),
        (lambda: graph.find_path(a, a, radius=0.0), "radius = 0.0: expected"),
        (lambda: graph.find_path(a, a, radius="wide"), "radius: expected .* not 'wide'"),
        (lambda: graph.find_path(a, a, radius=None), "radius: expected .* not None"),
        (lambda: graph.find_path(a, a, radius=[0.3]), r"radius: expected .* not \[0.3\]"),
        (lambda: graph.find_paths([a], [a], radius=True), "radius: expected .* not True"),
        (lambda: graph.begin_path(a, a, radius="wide"), "radius"),
        (lambda: graph.find_path(a, a, extent=1.0), "extent: expected"),
        (lambda: graph.find_path(a, a, extent=(-1.0, 1.0)), "extent: expected"),
        (lambda: graph.find_paths([a], [a], extent=(1.0, math.nan)), "extent: expected"),
        (lambda: graph.find_path(a, a, radius=math.inf), "radius"),
        (lambda: graph.find_path(a, a, skills={"fly": (0.0, 1.0)}), "expected one of jump"),
        (lambda: graph.find_path(a, a, skills={"jump": (1.0, 0.0)}), "least <= greatest"),
        (lambda: graph.find_path(a, a, node_costs=np.full(len(graph), 0.5)), "node_costs"),
        (lambda: graph.find_paths([a], [a, a]), "1 starts but 2 goals"),
        (lambda: graph.find_paths([(0.0, 0.0)], [a]), "expected shape"),
        (lambda: graph.find_paths([a], [(math.inf, 0.0, 0.0)]), r"goals\[0\]"),
        (lambda: graph.find_paths([a], [a], workers=0), "workers"),
        (lambda: graph.begin_path(a, a).advance(0), "nodes = 0"),
    ):
        with pytest.raises(NavmeshError, match=words):
            call()
    assert len(graph.find_paths(np.empty((0, 3)), np.empty((0, 3)))) == 0


def test_wrong_arguments_of_other_questions_are_refused() -> None:
    graph, rng = two_plates(), np.random.default_rng(0)
    a = (1.0, 1.0, 0.0)
    for call, words in (
        (lambda: graph.cast_ray(a, a, "wide"), "radius: expected a number"),
        (lambda: graph.room_to_turn(a, [1.0]), "length: expected a number"),
        (lambda: graph.reachable_nodes(a, None), "radius: expected a number"),
        (lambda: graph.reachable_nodes("here"), "start: expected coordinates"),
        (lambda: graph.random_points(rng, -1), "count: expected a whole number"),
        (lambda: graph.random_points(7, 1), "rng: expected a numpy.random.Generator"),
        (lambda: graph.find_paths("here", [a]), "starts: expected coordinates"),
        (lambda: graph.find_paths([a], [a], workers="2"), "workers = '2'"),
        (lambda: graph.find_path(a, a, skills=("jump",)), "skills: expected heights by affordance"),
        (lambda: graph.find_path(a, a, node_costs="dear"), "node_costs"),
        (lambda: graph.update({3: graph.terrain}), "chunk 3: expected a name that is a text"),
        (lambda: graph.update([graph.terrain]), "changes: expected chunks by name"),
        (lambda: NodeGraph.build("level.obj"), "terrain: expected a navmesh.Terrain"),
        (lambda: NodeGraph.build(graph.terrain, 0.3), "rules: expected navmesh.WalkRules"),
    ):
        with pytest.raises(NavmeshError, match=words):
            call()


def test_bodies_wider_than_the_level_fit_nowhere_at_once() -> None:
    graph = two_plates()
    for radius in (50.0, 2000.0, 1e9):
        assert graph.find_path((1.0, 1.0, 0.0), (5.0, 5.0, 0.0), radius).status == "off_graph"
        assert not graph.room_to_turn((3.0, 3.0, 0.0), radius)


def test_another_thread_takes_the_last_memory_for_a_search() -> None:
    class TakenMeanwhile(list):
        def __bool__(self) -> bool:
            return True  # as it was when it was looked at

    graph = NodeGraph.build(terrain(plane(0, 4, 0, 4)))
    ends = (0.5, 0.5, 0.0), (3.5, 3.5, 0.0)
    expected = graph.find_path(*ends)
    graph.cache["scratch"] = TakenMeanwhile()
    assert graph.find_path(*ends).length == expected.length
    assert len(graph.cache["scratch"]) == 1
