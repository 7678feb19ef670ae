"""Zones of a graph: blocking, opening, and what queries make of it."""

import math

import networkx
import numpy as np
import pytest

from benchmarks.apartments import apartment
from navmesh import NavmeshError, NodeGraph, Terrain
from navmesh.graph.open_to_body import portals_of, regions_of
from navmesh.zones.zones import Zones
from tests.navmesh.shapes import box, join, plane, terrain
from tests.navmesh.zones.test_switching import assert_alike

DOOR = {"door": [(4.9, 1.5, 0), (5.1, 1.5, 0), (5.1, 2.5, 0), (4.9, 2.5, 0)]}
START, GOAL = (2.0, 2.0, 0.0), (8.0, 2.0, 0.0)
ROOMS = (plane(0, 10, 0, 4), box(4.9, 5.1, 0, 1.5, 0, 2.5), box(4.9, 5.1, 2.5, 4, 0, 2.5))


@pytest.fixture
def rooms() -> NodeGraph:
    return NodeGraph.build(terrain(*ROOMS)).with_zones(DOOR)


def test_a_door_is_shut_and_opened(rooms):
    assert rooms.zones == {"door": False}
    before = rooms.find_path(START, GOAL)
    assert before.status == "complete" and before.holds(rooms)
    rooms.block("door")
    assert rooms.zones == {"door": True}
    shut = rooms.find_path(START, GOAL)
    assert shut.status == "partial" and not before.holds(rooms)
    assert shut.waypoints[-1, 0] == pytest.approx(4.9 - 0.3, abs=0.02)
    assert not rooms.cast_ray(START, GOAL, 0.3).clear
    assert rooms.nearest_edge((4.5, 2.0, 0.0)).distance == pytest.approx(0.4)
    assert len(rooms.reachable_nodes(START)) < len(rooms)
    rooms.open("door")
    again = rooms.find_path(START, GOAL)
    np.testing.assert_array_equal(again.waypoints, before.waypoints)
    assert rooms.nearest_edge((4.5, 2.0, 0.0)).distance == pytest.approx(math.hypot(0.4, 0.5))


def test_what_is_reachable_is_what_the_doors_that_are_there_join():
    level = apartment(3, 21)
    graph = NodeGraph.build(level.terrain, obstacle_rules=None).with_zones(level.doors)
    rng = np.random.default_rng(3)
    for share in (0.2, 0.7):
        graph.open(*level.doors)
        graph.block(*(name for name in level.doors if rng.random() < share))
        for radius in (0.2, 0.5):
            start, doors = portals_of(graph, radius)[:2]
            walks = networkx.Graph()
            walks.add_nodes_from(np.flatnonzero(graph.radii > 0.0))
            for node in range(len(graph)):
                there = [int(t) for t in doors["target"][start[node] : start[node + 1]] if t >= 0]
                walks.add_edges_from((node, other) for other in there)
            region = regions_of(graph, radius)
            assert (graph.radii[list(walks)] > 0.0).all()
            for members in networkx.connected_components(walks):
                assert len(set(region[sorted(members)].tolist())) == 1
            assert len(set(region[list(walks)].tolist())) == networkx.number_connected_components(walks)


def test_batches_and_searches_in_slices_agree_with_single_queries():
    level = apartment(2, 22)
    graph = NodeGraph.build(level.terrain, obstacle_rules=None).with_zones(level.doors)
    rng = np.random.default_rng(4)
    graph.find_path(*graph.positions[:2])  # works out a radius with all open
    graph.block(*list(level.doors)[::2])
    wide = graph.positions[graph.radii > 0.3]
    starts, goals = wide[rng.integers(len(wide), size=(2, 30))]
    routes = graph.find_paths(starts, goals)
    fresh = graph.with_zones({})
    assert fresh.zones == graph.zones
    for i, (start, goal) in enumerate(zip(starts, goals, strict=True)):
        one, other = graph.find_path(start, goal), fresh.find_path(start, goal)
        search = graph.begin_path(start, goal)
        while not search.advance(3):
            pass
        for each in (one, other, search.finish()):
            assert each.status == routes.status[i]
            np.testing.assert_array_equal(each.waypoints, routes.waypoints_of(i))


def test_an_update_keeps_zones_and_what_is_blocked(rooms):
    rooms.block("door")
    crate = Terrain.from_arrays(*box(7, 8, 1, 3, 0, 2.5))
    graph = rooms.update({"crate": crate})
    built = NodeGraph.build(graph.terrain, extent=graph.extent).with_zones(DOOR)
    built.block("door")
    assert graph.zones == {"door": True}
    assert_alike(graph, built)
    hole = Terrain.from_arrays(*join(plane(0, 4, 0, 4), plane(6, 10, 0, 4)))
    gone = graph.update({"level": hole})
    assert gone.zones == {"door": True}
    gone.open("door")
    assert gone.find_path(START, GOAL).status == "partial"


def test_zones_are_added_and_replaced(rooms):
    rooms.block("door")
    more = rooms.with_zones({"corner": [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)]})
    assert more.zones == {"door": True, "corner": False}
    assert more.with_zones(DOOR).zones == {"door": False, "corner": False}
    assert NodeGraph.build(terrain(*ROOMS)).zones == {}


def test_it_is_saved_without_zones(rooms, tmp_path):
    rooms.block("door")
    rooms.save(tmp_path / "graph.npz")
    loaded = NodeGraph.load(tmp_path / "graph.npz")
    assert loaded.zones == {}
    assert_alike(loaded.with_zones(DOOR), NodeGraph.build(terrain(*ROOMS)).with_zones(DOOR))


def test_obstacles_in_a_zone_are_taken_only_if_it_is_open():
    level = terrain(plane(0, 10, 0, 4), box(4, 6, 0, 4, 0, 0.5))
    skills = {"jump": (0.3, 0.7), "drop": (0.3, 0.7)}
    graph = NodeGraph.build(level).with_zones(
        {"block": [(3.9, 0, 0.4), (6.1, 0, 0.4), (6.1, 4, 0.4), (3.9, 4, 0.4)]}
    )
    over = graph.find_path(START, (5.0, 2.0, 0.5), skills=skills)
    assert over.status == "complete" and over.links
    graph.block("block")
    assert graph.find_path(START, (5.0, 2.0, 0.5), skills=skills, extent=(0.5, 0.5)).status != "complete"
    graph.open("block")
    again = graph.find_path(START, (5.0, 2.0, 0.5), skills=skills)
    np.testing.assert_array_equal(again.waypoints, over.waypoints)


def test_routes_with_costs_keep_to_open_zones():
    floor = join(*ROOMS[1:], plane(0, 9, 0, 4), plane(9, 10, 0, 4))
    mud = floor[0][floor[1]].mean(axis=1)[:, 0] > 9.0
    level = Terrain.from_arrays(*floor, materials=np.where(mud, "mud", "grass"))
    graph = NodeGraph.build(level, obstacle_rules=None).with_zones(DOOR)
    asked = {"radius": 0.3, "costs": {"mud": 3.0}}
    before = graph.find_path(START, GOAL, **asked)
    assert before.status == "complete"
    graph.block("door")
    assert graph.find_path(START, GOAL, **asked).status == "partial"
    graph.open("door")
    np.testing.assert_array_equal(graph.find_path(START, GOAL, **asked).waypoints, before.waypoints)


def test_names_that_there_are_not_are_refused(rooms):
    with pytest.raises(NavmeshError, match="no zone 'gate'; there are door"):
        rooms.block("gate")
    with pytest.raises(NavmeshError, match="no zones"):
        NodeGraph.build(terrain(*ROOMS)).open("door")
    assert isinstance(rooms.zone_state, Zones)
