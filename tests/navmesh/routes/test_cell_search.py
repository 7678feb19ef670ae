"""The search over cells, where no straight line can be mended: as short as cells allow, and where the body
fits."""

import math
from itertools import pairwise
from pathlib import Path

import networkx
import numpy as np
import pytest

from navmesh import NodeGraph, Terrain, WalkRules
from navmesh.graph.kernel_arrays import make_scratch, net_of
from navmesh.graph.open_to_body import doors_of
from navmesh.routes.cell_search import over_cells, search_cells
from tests.navmesh.routes.path_references import dense_walk, scene

COURTYARD = Path(__file__).resolve().parents[3] / "examples" / "levels" / "courtyard.obj"


def test_a_way_whose_corners_fall_away_in_turns_is_found() -> None:
    # mending this line took turns between two corners for ever
    rules = WalkRules(headroom=1.9, max_slope=math.radians(20.0), max_step=0.15)
    graph = NodeGraph.build(Terrain.load(COURTYARD), rules)
    start, goal = (47.625, 17.625, 1.2), (55.375, 20.625, 0.0)
    narrow, wide = (graph.find_path(start, goal, radius=radius) for radius in (0.12, 0.3))
    assert narrow.status == wide.status == "complete"
    assert 0.95 * wide.length < narrow.length <= wide.length


@pytest.mark.parametrize("seed", range(3))
def test_it_is_the_cheapest_way_over_cells_with_room(seed):
    """Against Dijkstra's algorithm."""
    graph, rng = scene(seed, 9)
    surface, net, scratch, radius = graph.surface, net_of(graph), make_scratch(graph), 0.4
    h = surface.resolution
    cost = np.where(
        surface.clearance >= radius, h, np.where(surface.clearance >= radius - 0.75 * h, 25.0 * h, np.inf)
    )
    cells = networkx.DiGraph()
    for k, links in enumerate(surface.link):
        cells.add_weighted_edges_from((k, int(m), cost[m]) for m in links if m >= 0 and cost[m] < np.inf)
    wide = np.flatnonzero(surface.clearance >= radius)
    for start, goal in rng.choice(wide, (6, 2)):
        found = search_cells(net, scratch, start, goal, radius)
        if not networkx.has_path(cells, start, goal):
            assert len(found) == 0
            continue
        assert (found[0], found[-1]) == (start, goal)
        assert all(m in surface.link[k] for k, m in pairwise(found))
        least = networkx.dijkstra_path_length(cells, start, goal)
        assert cost[found[1:]].sum() == pytest.approx(least)


@pytest.mark.parametrize("seed", range(2))
def test_the_line_that_follows_the_cells_can_be_walked(seed):
    graph, rng = scene(seed, 9)
    net, scratch, radius = net_of(graph), make_scratch(graph), 0.4
    doors = doors_of(graph, radius, None, None)
    centre = graph.surface.centers() - graph.surface.origin
    wide = np.flatnonzero((graph.surface.clearance >= radius) & (graph.label >= 0))
    found = 0
    for start, goal in rng.choice(wide, (12, 2)):
        if doors.part[graph.label[start]] != doors.part[graph.label[goal]]:
            continue
        scratch.points[0], scratch.cells[0] = centre[start], start
        count, fits = over_cells(net, doors, scratch, 0, 1, 1, *centre[goal, :2], goal)
        line, cells = scratch.points[:count, :2], scratch.cells
        assert fits and np.array_equal(line[-1], centre[goal, :2])
        for i in range(count - 1):
            reached, _, gap = dense_walk(graph.surface, int(cells[i]), line[i], line[i + 1], 0.01)
            assert reached and gap > radius - 1e-3
        found += count > 2
    assert found >= 3
