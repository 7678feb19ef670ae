"""The arrays that kernels read: made once for a graph, and with room for all that a search can need."""

import numpy as np
import pytest

from navmesh.graph.kernel_arrays import make_scratch, net_of
from tests.navmesh.surface.levels import build, random_level


@pytest.fixture(scope="module")
def graph():
    return build(*random_level(2))


def test_the_net_of_a_graph_is_made_once_of_its_own_arrays(graph):
    net = net_of(graph)
    assert net is net_of(graph)
    assert net.clearance is graph.surface.clearance and net.storey is graph.surface.storey
    assert net.label is graph.label
    assert (net.nx, net.ny) == graph.surface.shape and net.cell == graph.surface.resolution
    assert np.array_equal(net.edge_target, graph.edge_target)
    assert net is not net_of(build(*random_level(2)))


def test_the_memory_of_a_search_is_its_own_and_large_enough(graph):
    one, other = make_scratch(graph), make_scratch(graph)
    assert not np.shares_memory(one.labels, other.labels) and not one.cell_stamp.any()
    assert len(one.cell_stamp) == len(one.cell_best) == len(one.cell_parent) == len(graph.surface)
    assert len(one.nodes) == len(one.labels) + 1  # a chain through every label
    assert len(one.heap_key) == len(one.heap_item) > len(graph.edge_target)
