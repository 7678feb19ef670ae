"""Edges join nodes whose cells touch, and say how wide a body passes, and where."""

import numpy as np

from navmesh.graph.edges import _by_ends
from tests.navmesh.shapes import plane
from tests.navmesh.surface.levels import build, parts, random_level


def test_edges_are_symmetric_and_widths_fit():
    graph = build(*random_level(3))
    source = np.repeat(np.arange(len(graph)), np.diff(graph.edge_start))
    there = dict(
        zip(zip(source.tolist(), graph.edge_target.tolist(), strict=True), graph.edge_width, strict=True)
    )
    assert all(there[b, a] == width for (a, b), width in there.items())
    assert (graph.edge_width <= np.minimum(graph.radii[source], graph.radii[graph.edge_target]) + 1e-9).all()
    assert (graph.label[graph.edge_cells[:, 0]] == source).all()
    assert (graph.label[graph.edge_cells[:, 1]] == graph.edge_target).all()
    analysis = graph.to_networkx()
    assert analysis.number_of_nodes() == len(graph)
    assert analysis.number_of_edges() == len(graph.edge_target) // 2
    assert all(analysis.edges[a, b]["width"] == there[a, b] for a, b in analysis.edges)


def test_corridor_narrower_than_two_cells_lets_a_dog_pass():
    wide = 0.34
    graph = build(plane(0, 4, 0, 4), plane(4, 8, 2, 2 + wide), plane(8, 12, 0, 4))
    ends = ((1, 1, 0), (11, 1, 0))
    a, b = parts(graph, 0.12, *ends)
    assert a == b >= 0
    a, b = parts(graph, 0.2, *ends)
    assert a != b


def test_borders_are_sorted_by_their_ends_and_then_stay_in_order():
    rng = np.random.default_rng(2)
    ends = rng.integers(0, 9, (500, 2))
    key = (ends[:, 0] << 32) | ends[:, 1]
    np.testing.assert_array_equal(_by_ends(key, 9), np.argsort(key, kind="stable"))
