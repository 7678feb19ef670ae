"""Blocking and opening zones: what there is follows from what is blocked, not from what was."""

import numpy as np

from benchmarks.apartments import apartment
from navmesh import NodeGraph
from navmesh.graph.kernel_arrays import net_of
from navmesh.zones.switching import SWITCHES

STATE = ("label", "radii", "positions", "edge_start", "edge_target", "edge_width")
SURFACE = ("link", "clearance", "nearest", "blocker", "source")
NET = ("clearance", "link", "label", "nearby")


def assert_alike(one: NodeGraph, other: NodeGraph) -> None:
    for name in STATE:
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), name)
    for name in SURFACE:
        np.testing.assert_array_equal(getattr(one.surface, name), getattr(other.surface, name), name)
    a, b = net_of(one), net_of(other)
    for name in NET:
        np.testing.assert_array_equal(a.cells[name], b.cells[name], name)
    np.testing.assert_array_equal(a.nodes["node_radius"], b.nodes["node_radius"])


def test_the_order_of_changes_leaves_no_trace():
    level = apartment(2, 5)
    base = NodeGraph.build(level.terrain, obstacle_rules=None)
    graph = base.with_zones(level.doors)
    names = list(level.doors)
    rng = np.random.default_rng(1)
    for turn in range(60):
        (graph.block if rng.random() < 0.5 else graph.open)(*rng.choice(names, 2))
        if turn % 20 == 19:
            fresh = base.with_zones(level.doors)
            fresh.block(*(name for name, blocked in graph.zones.items() if blocked))
            assert_alike(graph, fresh)
            graph.cache.clear()
            assert_alike(graph, fresh)
    graph.open(*names)
    assert_alike(graph, base.with_zones(level.doors))


def test_with_all_open_cells_near_no_two_zones_are_as_without_zones():
    level = apartment(2, 6)
    base = NodeGraph.build(level.terrain, obstacle_rules=None)
    graph = base.with_zones(level.doors)
    np.testing.assert_array_equal(graph.surface.link, base.surface.link)
    points = base.random_points(np.random.default_rng(0), 300, 0.2)
    np.testing.assert_array_equal(graph.clearance_at(points), base.clearance_at(points))
    assert set(SWITCHES.fields) == set(graph.zone_state.switches)
