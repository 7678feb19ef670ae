"""Discs and edges that zones add when they are open."""

import numpy as np
import pytest

from benchmarks.apartments import apartment
from navmesh import NodeGraph
from navmesh.zones.views import Views

SLACK = 0.01  # [m], as in graphs without zones: what is nearest is known to the passes of the clearance


@pytest.fixture(scope="module")
def graph() -> NodeGraph:
    level = apartment(3, 11)
    return NodeGraph.build(level.terrain, obstacle_rules=None).with_zones(level.doors)


def test_every_cell_wide_enough_has_a_node_as_wide_whatever_is_blocked(graph):
    rng = np.random.default_rng(0)
    names = list(graph.zones)
    for share in (0.0, 0.3, 0.6, 1.0):
        graph.open(*names)
        graph.block(*(name for name in names if rng.random() < share))
        surface, label = graph.surface, graph.label
        owned = label >= 0
        assert (graph.radii[label[owned]] >= surface.clearance[owned] - SLACK).all()
        assert owned[surface.clearance >= graph.rules.min_radius].all()


def test_discs_hold_what_they_say(graph):
    """No place where walking ends lies in a disc that is there."""
    rng = np.random.default_rng(1)
    names = list(graph.zones)
    for _ in range(3):
        graph.open(*names)
        graph.block(*(name for name in names if rng.random() < 0.5))
        there = graph.radii > 0.0
        gap = graph.clearance_at(graph.positions[there])
        assert (gap >= graph.radii[there] - SLACK).all()
    blocked = np.flatnonzero(~there)
    assert len(blocked) and not np.isin(graph.label, blocked).any()


def test_the_two_wings_of_a_door_are_one_way_for_wide_bodies(graph):
    views = graph.zone_state.zones_of_view
    assert (views[:, 0] != views[:, 1]).any()
    assert Views.find.__doc__
