"""The parts that one body radius leaves of a graph."""

import networkx
import numpy as np
import pytest

from navmesh.graph.open_to_body import parts_of, portals_of
from navmesh.graph.parts import leaps_by_part
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
    part = np.array([0, 0, 1, 2, 1], np.int32)
    start, target = leaps_by_part(part, np.array([0, 1, 2, 4]), np.array([2, 3, 0, 3]))
    found = [sorted(set(target[start[p] : start[p + 1]].tolist())) for p in range(len(start) - 1)]
    assert found[:2] == [[1, 2], [0, 2]] and all(each == [] for each in found[2:])
