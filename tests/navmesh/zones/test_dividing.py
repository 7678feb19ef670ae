"""A divided graph against one that is built with walls in the place of what is blocked."""

import numpy as np
import pytest

from benchmarks.apartments import apartment, with_walls
from navmesh import NavmeshError, NodeGraph
from navmesh.zones.dividing import divide
from tests.navmesh.shapes import box, plane
from tests.navmesh.surface.levels import build


@pytest.mark.parametrize("seed", [101, 102])
def test_routes_are_those_of_a_level_with_walls_there(seed):
    level = apartment(2, seed)
    base = NodeGraph.build(level.terrain, obstacle_rules=None)
    graph = base.with_zones(level.doors)
    rng = np.random.default_rng(seed)
    ratios = []
    for share in (0.0, 0.4, 1.0):
        shut = [name for name in level.doors if rng.random() < share]
        graph.open(*level.doors)
        graph.block(*shut)
        walls = with_walls(level.terrain, [level.doors[name] for name in shut])
        built = NodeGraph.build(walls, obstacle_rules=None, extent=base.extent)
        for radius in (0.2, 0.45):
            places = built.positions[built.radii >= radius + 0.05]
            starts, goals = places[rng.integers(len(places), size=(2, 40))]
            inside = [graph.clearance_at(each) < radius for each in (starts, goals)]
            one, other = built.find_paths(starts, goals, radius), graph.find_paths(starts, goals, radius)
            for i in np.flatnonzero(~inside[0] & ~inside[1]):
                assert one.status[i] == other.status[i]
                if one.status[i] == "complete" and one.length[i] > 1.0:
                    ratios.append(other.length[i] / one.length[i])
    ratios = np.array(ratios)
    assert np.mean(ratios) < 1.01
    assert np.mean(ratios > 1.02) < 0.05 and np.mean(ratios < 0.98) < 0.05


def test_a_zone_in_the_open_is_led_round():
    graph = build(plane(0, 20, 0, 12)).with_zones({"pond": [(8, 3, 0), (12, 3, 0), (12, 9, 0), (8, 9, 0)]})
    straight = graph.find_path((2, 6, 0), (18, 6, 0), 0.5)
    assert straight.length == pytest.approx(16.0)
    graph.block("pond")
    round_it = graph.find_path((2, 6, 0), (18, 6, 0), 0.5)
    assert 17.0 < round_it.length < 18.2
    assert not straight.holds(graph) and round_it.holds(graph)
    on = np.concatenate([round_it.on_surface(0.05), round_it.waypoints])
    dx = np.maximum(np.abs(on[:, 0] - 10.0) - 2.0, 0.0)
    dy = np.maximum(np.abs(on[:, 1] - 6.0) - 3.0, 0.0)
    assert np.hypot(dx, dy).min() >= 0.5 - 1e-3
    assert graph.find_path((10, 6, 0), (18, 6, 0), 0.5).status == "off_graph"


def test_a_zone_without_floor_is_refused():
    graph = build(plane(0, 6, 0, 6), box(2, 3, 2, 3, 0, 2))
    with pytest.raises(NavmeshError, match=r"zone 'moon'.*floor"):
        graph.with_zones({"moon": [(1, 1, 9), (2, 1, 9), (2, 2, 9)]})
    nowhere = {"moon": np.array([(1.0, 1.0, 9.0), (2.0, 1.0, 9.0), (2.0, 2.0, 9.0)])}
    assert not len(divide(graph, nowhere, {"moon"}).switches["row_cell"])
