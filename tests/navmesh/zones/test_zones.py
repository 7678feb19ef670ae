"""Zones of a graph: blocking, opening, and what queries make of it."""

import copy
import math
import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from benchmarks.apartments import apartment
from benchmarks.navmesh_zones import walled
from navmesh import NavmeshError, NodeGraph, Terrain
from navmesh.zones.zones import Zones
from tests.navmesh.shapes import box, join, plane, terrain
from tests.navmesh.zones.alike import assert_alike

DOOR = {"door": [(4.9, 1.5, 0), (5.1, 1.5, 0), (5.1, 2.5, 0), (4.9, 2.5, 0)]}
START, GOAL = (2.0, 2.0, 0.0), (8.0, 2.0, 0.0)
ROOMS = (plane(0, 10, 0, 4), box(4.9, 5.1, 0, 1.5, 0, 2.5), box(4.9, 5.1, 2.5, 4, 0, 2.5))


@pytest.fixture
def rooms() -> NodeGraph:
    return NodeGraph.build(terrain(*ROOMS)).with_zones(DOOR)


@pytest.fixture(scope="module")
def flat() -> tuple[NodeGraph, dict]:
    level = apartment(3, 21)
    return NodeGraph.build(level.terrain, obstacle_rules=None), level.doors


def places_in(graph: NodeGraph, count: int, radius: float, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    wide = graph.positions[graph.radii >= radius]
    return wide[rng.integers(len(wide), size=(2, count))]


def assert_same_routes(one, other) -> None:
    for name in ("status", "length", "waypoints", "waypoint_start", "nodes", "leaps"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), name)


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
    assert rooms.containing_node((5.0, 2.0, 0.0)) == -1
    assert rooms.radii[rooms.nearest_node((5.0, 2.0, 0.0))] > 0.0
    reached = rooms.reachable_nodes(START)
    assert (rooms.positions[reached, 0] < 4.9).all() and len(reached)
    points = rooms.random_points(np.random.default_rng(0), 50, 0.3, reachable_from=START)
    assert (points[:, 0] < 4.61).all()
    rooms.open("door")
    again = rooms.find_path(START, GOAL)
    np.testing.assert_array_equal(again.waypoints, before.waypoints)
    assert rooms.nearest_edge((4.5, 2.0, 0.0)).distance == pytest.approx(math.hypot(0.4, 0.5))


def test_what_is_open_costs_nothing(flat):
    base, doors = flat
    graph = base.with_zones(doors)
    for turn in range(2):
        for radius in (0.2, 0.3, 0.6, 0.9):
            starts, goals = places_in(base, 60, radius, turn)
            assert_same_routes(
                base.find_paths(starts, goals, radius), graph.find_paths(starts, goals, radius)
            )
        graph.block(*doors)
        graph.find_path(*base.positions[:2], radius=0.6)
        graph.open(*doors)


def test_three_wings_of_one_gate_are_one_way():
    """Whoever is wider than one wing, or two, gets through as many as are open side by side."""
    edges = (2.2, 3.2, 4.2, 5.2)
    level = terrain(
        plane(0, 12, 0, 8), box(5.9, 6.1, 0, edges[0], 0, 2.5), box(5.9, 6.1, edges[-1], 8, 0, 2.5)
    )
    gate = {
        name: [(5.9, low, 0), (6.1, low, 0), (6.1, high, 0), (5.9, high, 0)]
        for name, low, high in zip("abc", edges[:-1], edges[1:], strict=True)
    }
    graph = NodeGraph.build(level).with_zones(gate)
    ends = (2.0, 3.7, 0.0), (10.0, 3.7, 0.0)
    for shut, widest in (("", 1.45), ("a", 0.95), ("b", 0.45), ("ab", 0.45), ("ac", 0.45), ("abc", 0.0)):
        graph.open(*gate)
        graph.block(*shut)
        for radius in (0.4, 0.9, 1.4):
            status = graph.find_path(*ends, radius=radius).status
            assert status == ("complete" if radius <= widest else "partial"), (shut, radius)


@pytest.mark.parametrize("seed", [31, 32])
def test_a_blocked_door_is_a_wall(seed):
    """Whether one arrives, and how long the way is, compared with levels that have walls there."""
    level = apartment(3, seed)
    base = NodeGraph.build(level.terrain, obstacle_rules=None)
    graph = base.with_zones(level.doors)
    rng = np.random.default_rng(seed)
    ratios, arrived = [], 0
    for share in (0.3, 0.6):
        shut = [name for name in level.doors if rng.random() < share]
        graph.open(*level.doors)
        graph.block(*shut)
        built = walled(base, level.terrain, [level.doors[name] for name in shut])
        for radius in (0.2, 0.45):
            places = built.positions[built.radii >= radius]
            places = places[graph.clearance_at(places) >= radius]
            starts, goals = places[rng.integers(len(places), size=(2, 80))]
            walls, zones = built.find_paths(starts, goals, radius), graph.find_paths(starts, goals, radius)
            complete = walls.status == "complete"
            np.testing.assert_array_equal(zones.status == "complete", complete)
            long = complete & (walls.length > 0.5)
            ratios.append(zones.length[long] / walls.length[long])
            arrived += complete.sum()
    ratio = np.concatenate(ratios)
    assert arrived > 60 and (np.abs(ratio - 1.0) < 0.15).all() and abs(ratio.mean() - 1.0) < 0.005


def test_batches_threads_slices_and_fresh_graphs_agree(flat):
    base, doors = flat
    graph = base.with_zones(doors)
    graph.find_path(*base.positions[:2])  # works out a radius with all open
    graph.block(*list(doors)[::2])
    starts, goals = places_in(graph, 30, 0.3, 4)
    routes = graph.find_paths(starts, goals)
    assert_same_routes(routes, graph.find_paths(starts, goals, workers=3))
    fresh = base.with_zones(doors)
    fresh.block(*list(doors)[::2])
    for i, (start, goal) in enumerate(zip(starts, goals, strict=True)):
        one, other = graph.find_path(start, goal), fresh.find_path(start, goal)
        search = graph.begin_path(start, goal)
        while not search.advance(3):
            pass
        for each in (one, other, search.finish()):
            assert each.status == routes.status[i]
            np.testing.assert_array_equal(each.waypoints, routes.waypoints_of(i))


def test_new_radii_are_asked_for_by_four_threads_while_doors_are_blocked(flat):
    base, doors = flat
    graph, other = base.with_zones(doors), base.with_zones(doors)
    for each in (graph, other):
        each.block(*list(doors)[::3])
    starts, goals = places_in(base, 12, 0.6, 6)
    radii = [round(0.2 + 0.03 * k, 3) for k in range(12)]

    def ask(radius: float) -> list:
        return [graph.find_path(*ends, radius=radius) for ends in zip(starts, goals, strict=True)]

    with ThreadPoolExecutor(4) as pool:
        answers = list(pool.map(ask, radii * 4))
    for radius, found in zip(radii * 4, answers, strict=True):
        wanted = other.find_paths(starts, goals, radius)
        for i, route in enumerate(found):
            assert route.status == wanted.status[i]
            np.testing.assert_array_equal(route.waypoints, wanted.waypoints_of(i))


@pytest.mark.parametrize(
    "copied", [copy.copy, copy.deepcopy, lambda graph: pickle.loads(pickle.dumps(graph))]
)
def test_a_copy_has_doors_of_its_own(rooms, copied):
    rooms.block("door")
    rooms.find_path(START, GOAL)
    other = copied(rooms)
    assert other.zones == {"door": True}
    assert_alike(other, rooms)
    rooms.open("door")
    assert other.zones == {"door": True} and other.find_path(START, GOAL).status == "partial"
    other.open("door")
    rooms.block("door")
    assert other.find_path(START, GOAL).status == "complete"
    assert rooms.find_path(START, GOAL).status == "partial"


def test_copies_of_graphs_without_zones_still_answer():
    graph = NodeGraph.build(terrain(*ROOMS))
    wanted = graph.find_path(START, GOAL)
    for other in (copy.copy(graph), copy.deepcopy(graph), pickle.loads(pickle.dumps(graph))):
        np.testing.assert_array_equal(other.find_path(START, GOAL).waypoints, wanted.waypoints)


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


def test_a_search_in_slices_ends_where_a_zone_is_turned(rooms):
    search = rooms.begin_path(START, GOAL)
    rooms.block("door")
    with pytest.raises(NavmeshError, match="expected a new search"):
        search.advance(5)


def test_names_that_there_are_not_are_refused(rooms):
    with pytest.raises(NavmeshError, match="no zone 'gate'; expected one of 'door'"):
        rooms.block("door", "gate")
    assert rooms.zones == {"door": False}
    with pytest.raises(NavmeshError, match="no zones"):
        NodeGraph.build(terrain(*ROOMS)).open("door")
    assert isinstance(rooms.zone_state, Zones)


def test_a_zone_without_floor_is_refused():
    with pytest.raises(NavmeshError, match=r"'attic'.*on the floor"):
        NodeGraph.build(terrain(*ROOMS)).with_zones({"attic": [(1, 1, 5), (2, 1, 5), (2, 2, 5)]})


def test_a_zone_between_the_centres_of_cells_is_in_the_way():
    """A bollard of 6 cm, and a bar of 15 cm, in a floor that is sampled every 25 cm."""
    graph = NodeGraph.build(terrain(plane(0, 10, 0, 4)))
    for shift in np.linspace(0.0, 0.24, 7):
        x, y = 5.0 + shift, 2.0 + 0.7 * shift
        corners = [(x + dx, y + dy, 0.0) for dx, dy in ((0, 0), (0.06, 0), (0.06, 0.06), (0, 0.06))]
        zoned = graph.with_zones({"bollard": corners, "bar": [(x, y + 1, 0.0), (x, y + 1.15, 0.0)]})
        zoned.block("bollard", "bar")
        assert zoned.clearance_at((x, y - 0.3, 0.0)) == pytest.approx(0.3)
        assert zoned.clearance_at((x - 0.2, y + 1.1, 0.0)) == pytest.approx(0.2)
        route = zoned.find_path((2.0, y, 0.0), (8.0, y, 0.0), radius=0.3)
        assert route.status == "complete" and route.length > 6.01
