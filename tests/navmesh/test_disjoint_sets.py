"""Sets that are joined two by two."""

import networkx
import numpy as np
import pytest

from navmesh.disjoint_sets import root


@pytest.mark.parametrize("seed", range(5))
def test_members_of_a_set_have_one_root(seed):
    rng = np.random.default_rng(seed)
    count = 40
    parent = np.arange(count)
    graph = networkx.empty_graph(count)
    for a, b in rng.integers(0, count, (25, 2)):
        parent[root(parent, a)] = root(parent, b)
        graph.add_edge(a, b)
    for members in networkx.connected_components(graph):
        roots = {int(root(parent, k)) for k in members}
        assert len(roots) == 1 and roots <= members


def test_long_ways_to_the_root_are_halved():
    parent = np.array([0, 0, 1, 2, 3, 4, 5, 6])
    assert root(parent, 7) == 0
    assert parent.tolist() == [0, 0, 1, 1, 3, 3, 5, 5]
