"""Graphs with zones as graphs without."""

import numpy as np

from benchmarks.apartments import apartment
from navmesh import NodeGraph, Terrain
from navmesh.zones.plain import plain_graph
from tests.navmesh.shapes import join, plane
from tests.navmesh.zones.test_zones import DOOR, GOAL, ROOMS, START, places_in


def test_it_answers_as_the_graph_with_zones_does():
    level = apartment(3, 41)
    base = NodeGraph.build(level.terrain, obstacle_rules=None)
    graph = base.with_zones(level.doors)
    assert plain_graph(graph) is base and plain_graph(base) is base
    graph.block(*list(level.doors)[::2])
    plain = graph.without_zones()
    assert plain.zones == {} and plain is graph.without_zones()
    assert (plain.radii > 0.0).all() and len(plain) == (graph.radii > 0.0).sum()
    for radius in (0.2, 0.45):
        starts, goals = places_in(graph, 60, radius, 1)
        one, other = graph.find_paths(starts, goals, radius), plain.find_paths(starts, goals, radius)
        np.testing.assert_array_equal(one.status, other.status)
        np.testing.assert_array_equal(one.waypoints, other.waypoints)
    network = graph.to_networkx()
    assert len(network) == len(plain) and network.number_of_edges() == len(plain.edge_target) // 2


def test_routes_with_costs_keep_to_open_zones():
    floor = join(*ROOMS[1:], plane(0, 9, 0, 4), plane(9, 10, 0, 4))
    mud = floor[0][floor[1]].mean(axis=1)[:, 0] > 9.0
    level = Terrain.from_arrays(*floor, materials=np.where(mud, "mud", "grass"))
    base = NodeGraph.build(level, obstacle_rules=None)
    graph = base.with_zones(DOOR)
    asked = {"radius": 0.3, "costs": {"mud": 3.0}}
    before = graph.find_path(START, GOAL, **asked)
    assert before.status == "complete" and before.cost == base.find_path(START, GOAL, **asked).cost
    graph.block("door")
    assert graph.find_path(START, GOAL, **asked).status == "partial"
    assert graph.find_paths([START], [GOAL], **asked).status[0] == "partial"
    search = graph.begin_path(START, GOAL, **asked)
    while not search.advance(100):
        pass
    assert search.finish().status == "partial"
    graph.open("door")
    np.testing.assert_array_equal(graph.find_path(START, GOAL, **asked).waypoints, before.waypoints)
