"""The parts that one body radius leaves of a graph."""

import networkx
import numpy as np
import pytest

from navmesh.graph.open_to_body import parts_of, portals_of
from navmesh.graph.parts import leaps_by_part, parts_in_tiles
from tests.navmesh.shapes import plane
from tests.navmesh.surface.levels import build, random_level


@pytest.mark.parametrize("radius", [0.2, 0.6])
@pytest.mark.parametrize("seed", range(3))
def test_nodes_of_a_part_can_be_walked_to_from_each_other(seed, radius):
    graph = build(*random_level(seed))
    start, doors = portals_of(graph, radius)[:2]
    target = doors["target"]
    walks = networkx.DiGraph()
    walks.add_nodes_from(range(len(graph)))
    for node in range(len(graph)):
        walks.add_edges_from((node, int(other)) for other in target[start[node] : start[node + 1]])
    part = parts_of(graph, radius)[0]
    for members in networkx.weakly_connected_components(walks):
        assert len(set(part[sorted(members)].tolist())) == 1
    assert len(set(part.tolist())) == networkx.number_weakly_connected_components(walks)
    _, first = np.unique(part, return_index=True)
    assert (np.diff(first) > 0).all()  # numbered by their first nodes


def test_leaps_are_grouped_by_the_part_that_they_start_in():
    start, leap = leaps_by_part(np.array([0, 0, 1, 2, 0]), 4)
    assert [leap[start[p] : start[p + 1]].tolist() for p in range(4)] == [[0, 1, 4], [2], [3], []]


def test_a_part_is_added_to_tiles():
    surface = build(plane(0, 9, 0, 9)).surface
    cells = np.flatnonzero(surface.centers()[:, 0] < 1.0).astype(np.int32)
    tiles = np.array([0, 2, *[2] * 8], np.int32), np.array([1, 4], np.int32), np.array([(5.0, 6.0)] * 2)
    start, part, span = parts_in_tiles(tiles, surface, cells, 9)
    by_tile = [part[start[t] : start[t + 1]].tolist() for t in range(9)]
    assert by_tile == [[1, 4, 9], [9], [9], *[[]] * 6]
    assert span[:2].tolist() == [[5.0, 6.0]] * 2
    np.testing.assert_allclose(span[2], surface.height[0])
