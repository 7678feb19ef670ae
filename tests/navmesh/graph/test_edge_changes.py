"""Edges that are measured anew around a change, and the others, are those of the whole level."""

import numpy as np

from navmesh.graph.edge_changes import renew_edges
from navmesh.graph.node_changes import RenewedNodes
from tests.navmesh.surface.levels import build, random_level


def test_nothing_changes_where_nothing_changed():
    graph = build(*random_level(2))
    assert graph.kept_build is not None
    built = graph.kept_build.built
    same = RenewedNodes(built.nodes, np.arange(len(graph), dtype=np.int32), (6, 5, 20, 18))
    found = renew_edges(built.edges, built.nodes, graph.surface, same, graph.surface)
    for one, other in zip(found, built.edges, strict=True):
        np.testing.assert_array_equal(one, other)


def test_what_was_measured_in_the_window_is_measured_anew():
    graph = build(*random_level(2))
    assert graph.kept_build is not None
    built = graph.kept_build.built
    start, target, width, gate, cells = built.edges
    ix, iy = np.divmod(graph.surface.cell_column[cells], graph.surface.shape[1])
    inside = (np.minimum(ix, iy) >= 10).all(axis=1) & (np.maximum(ix, iy) < 30).all(axis=1)
    assert inside.any() and not inside.all()
    wrong = start, target, np.where(inside, 7.0, width), gate, cells
    same = RenewedNodes(built.nodes, np.arange(len(graph), dtype=np.int32), (10, 10, 30, 30))
    found = renew_edges(wrong, built.nodes, graph.surface, same, graph.surface)
    np.testing.assert_array_equal(found[2], width)
