"""Blocking and opening zones: what there is follows from what is blocked, not from what was."""

import numpy as np
import pytest

from benchmarks.apartments import apartment
from navmesh import NodeGraph
from tests.navmesh.shapes import box, plane, terrain
from tests.navmesh.surface.levels import random_level
from tests.navmesh.zones.alike import assert_alike

SQUARES = {
    f"{x}, {y}": [(x, y, 0.0), (x + 1.2, y, 0.0), (x + 1.2, y + 0.3, 0.0), (x, y + 0.3, 0.0)]
    for x in (1.0, 2.5, 4.0, 7.0)
    for y in (2.0, 2.4, 6.0)
}
"""Zones in the open, some of them close to each other."""


def in_the_open() -> tuple[NodeGraph, dict]:
    level = terrain(plane(0, 10, 0, 9), box(5.5, 6.0, 4.0, 9.0, 0.0, 2.0))
    return NodeGraph.build(level, obstacle_rules=None), SQUARES


def in_an_apartment() -> tuple[NodeGraph, dict]:
    level = apartment(2, 5)
    return NodeGraph.build(level.terrain, obstacle_rules=None), level.doors


@pytest.mark.parametrize("level", [in_the_open, in_an_apartment])
def test_the_order_of_changes_leaves_no_trace(level):
    base, outlines = level()
    graph = base.with_zones(outlines)
    names = list(outlines)
    rng = np.random.default_rng(1)
    for turn in range(60):
        (graph.block if rng.random() < 0.5 else graph.open)(*rng.choice(names, 2))
        if rng.random() < 0.4:  # doors of this body are brought up to date now and then
            graph.find_path(*graph.positions[:2], radius=0.45)
        if turn % 20 == 19:
            fresh = base.with_zones(outlines)
            fresh.block(*(name for name, blocked in graph.zones.items() if blocked))
            assert_alike(graph, fresh)
            graph.cache.clear()
            assert_alike(graph, fresh)
    graph.open(*names)
    assert_alike(graph, base.with_zones(outlines))


@pytest.mark.parametrize("seed", [165, 437, 535])
def test_many_zones_in_each_others_way_leave_no_trace(seed):
    rng = np.random.default_rng(seed)
    base = NodeGraph.build(terrain(*random_level(seed)), obstacle_rules=None)
    outlines = {}
    for number, place in enumerate(base.random_points(rng, 12, 0.3)):
        angles, wide = np.sort(rng.uniform(0.0, 2.0 * np.pi, 4)), rng.uniform(0.3, 1.5)
        corners = wide * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(4)])
        outlines[str(number)] = place + corners - corners.mean(axis=0)
    graph = base.with_zones(outlines)
    for _ in range(40):
        (graph.block if rng.random() < 0.5 else graph.open)(*rng.choice(list(outlines), 2))
        for radius in (0.2, 0.45):
            graph.find_path(*base.positions[:2], radius=radius)
    fresh = base.with_zones(outlines)
    fresh.block(*(name for name, blocked in graph.zones.items() if blocked))
    assert_alike(graph, fresh)
    graph.open(*outlines)
    assert_alike(graph, base.with_zones(outlines))


@pytest.mark.parametrize("level", [in_the_open, in_an_apartment])
def test_cells_are_as_wide_as_they_say_and_have_a_node_as_wide(level):
    base, outlines = level()
    graph = base.with_zones(outlines)
    rng = np.random.default_rng(2)
    slack = 0.01  # [m], as in graphs without zones: what is nearest is known to the passes of the clearance
    for share in (0.2, 0.6, 1.0):
        graph.open(*outlines)
        graph.block(*(name for name in outlines if rng.random() < share))
        surface, label = graph.surface, graph.label
        owned = label >= 0
        assert (graph.radii[label[owned]] >= surface.clearance[owned] - slack).all()
        assert owned[surface.clearance >= graph.rules.min_radius].all()
        np.testing.assert_allclose(np.hypot(*surface.nearest.T), surface.clearance, atol=1e-9)
        there = graph.radii > 0.0
        gap = graph.clearance_at(graph.positions[there])
        assert (gap >= graph.radii[there] - slack).all()
