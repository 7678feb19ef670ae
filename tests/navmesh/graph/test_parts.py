"""The parts that one body radius leaves of a graph."""

import networkx
import numpy as np
import pytest

from navmesh.graph.open_to_body import parts_of, portals_of
from navmesh.graph.parts import regions_of_parts, ways_by_part, with_more_parts
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


def test_ways_are_grouped_by_the_part_that_they_start_in():
    part = np.array([0, 0, 1, 2, 1], np.int32)
    source, target = np.array([0, 1, 2, 4, 0, 0]), np.array([2, 3, 0, 3, 1, 2])
    start, found, view = ways_by_part(part, source, target, np.array([-1, 7, -1, -1, -1, -1]))
    assert start.tolist() == [0, 2, 4, 4]
    assert found.tolist() == [1, 2, 0, 2] and view.tolist() == [-1, 7, -1, -1]


def test_regions_are_what_ways_that_are_there_join():
    ways = ways_by_part(
        np.arange(5, dtype=np.int32), np.array([1, 2, 2, 4, 0]), np.array([2, 1, 4, 2, 3]),
        np.array([0, 0, 1, 1, -1]),
    )  # fmt: skip
    region = np.arange(5, dtype=np.int32)
    for missing, expected in (
        ((0, 0), [0, 1, 1, 3, 1]),
        ((1, 0), [0, 1, 2, 3, 2]),
        ((2, 1), [0, 1, 2, 3, 4]),
    ):
        regions_of_parts(np.array([1, 2, 4], np.int32), *ways, np.array(missing, np.int32), region)
        assert region.tolist() == expected


def test_parts_are_added_to_tiles():
    tiles = np.array([0, 2, 2, 3], np.int32), np.array([4, 1, 0], np.int32), np.array([(0.0, 1.0)] * 3)
    more = np.array([1, 0, 0]), np.array([3, 4, 6]), np.array([(5.0, 6.0), (-1.0, 0.5), (2.0, 3.0)])
    start, part, span = with_more_parts(tiles, *more)
    assert start.tolist() == [0, 3, 4, 5]
    assert part.tolist() == [1, 4, 6, 3, 0]
    assert span.tolist() == [[0.0, 1.0], [-1.0, 1.0], [2.0, 3.0], [5.0, 6.0], [0.0, 1.0]]
