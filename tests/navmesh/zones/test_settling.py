"""Which parts are joined with the zones that are blocked now."""

import networkx
import numpy as np
import pytest

from benchmarks.apartments import apartment
from navmesh import NodeGraph
from navmesh.graph.open_to_body import doors_of, regions_of
from navmesh.zones.bodies import zoned_body
from navmesh.zones.settling import join_regions
from navmesh.zones.zones import zones_of
from tests.navmesh.zones.alike import doors_seen


@pytest.fixture(scope="module")
def flat() -> tuple[NodeGraph, dict]:
    level = apartment(3, 21)
    return NodeGraph.build(level.terrain, obstacle_rules=None), level.doors


def test_what_is_reachable_is_what_the_doors_that_are_there_join(flat):
    base, doors = flat
    graph = base.with_zones(doors)
    rng = np.random.default_rng(3)
    for share in (0.2, 0.7, 0.0):
        graph.open(*doors)
        graph.block(*(name for name in doors if rng.random() < share))
        for radius in (0.2, 0.5):
            source, target, *_ = doors_seen(graph, radius)
            walks = networkx.Graph()
            walks.add_nodes_from(np.flatnonzero(graph.radii > 0.0))
            walks.add_edges_from(zip(source.tolist(), target.tolist(), strict=True))
            region = regions_of(graph, radius)
            assert (graph.radii[list(walks)] > 0.0).all()
            for members in networkx.connected_components(walks):
                assert len(set(region[sorted(members)].tolist())) == 1
            assert len(set(region[list(walks)].tolist())) == networkx.number_connected_components(walks)
            bundle = doors_of(graph, radius, None, None)
            for root in set(region[list(walks)].tolist()):
                ring, part = [], root
                while part not in ring:
                    ring.append(part)
                    part = int(bundle.ring[part])
                mine = {int(bundle.part[node]) for node in walks if region[node] == root}
                assert part == root and mine <= set(ring)


def test_joining_again_changes_nothing(flat):
    base, doors = flat
    graph = base.with_zones(doors)
    graph.block(*list(doors)[::2])
    bundle = doors_of(graph, 0.3, None, None)
    region = bundle.region.copy()
    join_regions(
        zones_of(graph).switches, bundle, zones_of(graph).divided.fringe, *zoned_body(graph, 0.3).ways
    )
    np.testing.assert_array_equal(bundle.region, region)


def test_there_is_one_body_for_each_radius_and_it_grows_with_the_slots(flat):
    base, doors = flat
    graph = base.with_zones(doors)
    graph.block(*list(doors)[::2])
    body = zoned_body(graph, 0.3)
    assert zoned_body(graph, 0.3) is body and zoned_body(graph, 0.4) is not body
    before = doors_seen(graph, 0.3)
    zones_of(graph)._with_slots(2 * zones_of(graph).slots)
    bundle = doors_of(graph, 0.3, None, None)
    for mine, theirs in zip(doors_seen(graph, 0.3), before, strict=True):
        np.testing.assert_array_equal(mine, theirs)
    graph.block(*doors)
    assert (
        doors_of(graph, 0.3, None, None) is bundle and bundle.following is zones_of(graph).switches.following
    )
    fresh = base.with_zones(doors)
    fresh.block(*doors)
    for mine, theirs in zip(doors_seen(graph, 0.3), doors_seen(fresh, 0.3), strict=True):
        np.testing.assert_array_equal(mine, theirs)
