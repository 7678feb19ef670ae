"""Nodes that are chosen anew around a change are those of the whole level; the others keep their places."""

from dataclasses import replace

import numpy as np
import pytest

from navmesh import NodeGraph
from navmesh.graph.node_changes import Nodes, renew_nodes
from tests.navmesh.shapes import box, plane, terrain


def plain(*pillars):
    return terrain(plane(0, 24, 0, 18), *(box(x, x + 0.6, y, y + 0.6, 0, 2.5) for x, y in pillars))


@pytest.mark.parametrize("seed", range(3))
def test_a_pillar_moves(seed):
    rng = np.random.default_rng(seed)
    others = [tuple(place) for place in rng.uniform(1, 16, (4, 2))]
    here, there = rng.uniform(4, 14, (2, 2))
    old, new = (
        NodeGraph.build(plain(*others, tuple(at)), obstacle_rules=None) for at in (here, there)
    )  # fmt: skip
    assert old.kept_build is not None and new.kept_build is not None
    nodes, expected = old.kept_build.built.nodes, new.kept_build.built.nodes
    apart = np.zeros(new.surface.shape, bool)  # columns in which anything is other than before
    for graph, other in ((old, new), (new, old)):
        known = {
            (int(column), float(x), float(y))
            for column, (x, y) in zip(other.surface.cell_column, other.surface.nearest, strict=True)
        }
        for column, (x, y) in zip(graph.surface.cell_column.tolist(), graph.surface.nearest, strict=True):
            apart.flat[column] |= (column, float(x), float(y)) not in known
    ix, iy = np.nonzero(apart)
    window = int(ix.min()) - 1, int(iy.min()) - 1, int(ix.max()) + 2, int(iy.max()) + 2
    found = renew_nodes(nodes, old.surface, new.surface, window, new.rules.min_radius, 1.0)
    assert found is not None
    for name in ("cell", "place", "maker", "label"):
        np.testing.assert_array_equal(getattr(found.nodes, name), getattr(expected, name), name)
    stay = np.flatnonzero(found.number >= 0)
    assert 0 < len(stay) < len(old)
    np.testing.assert_array_equal(nodes.place[stay], found.nodes.place[found.number[stay]])
    assert (np.diff(found.number[stay]) > 0).all()  # nobody overtakes anybody


def test_a_disc_whose_turn_has_changed_is_new():
    graph = NodeGraph.build(plain((4.1, 7.3), (12.2, 6.1), (15.5, 13.4)), obstacle_rules=None)
    assert graph.kept_build is not None
    nodes, surface = graph.kept_build.built.nodes, graph.surface
    late, early = 60, 40  # before, the cell that made one of the discs had its turn sooner
    clearance = surface.clearance.copy()
    clearance[nodes.maker[late]] = surface.clearance[nodes.maker[early - 1]] - 1e-9
    order = np.concatenate([np.arange(early), [late], np.delete(np.arange(early, len(graph)), late - early)])
    rank = np.append(np.argsort(order), -1).astype(np.int32)
    before = Nodes(
        nodes.cell[order], nodes.place[order], nodes.maker[order], rank[nodes.label], nodes.position[order]
    )
    ix, iy = np.divmod(int(surface.columns(nodes.maker[late : late + 1])[0]), surface.shape[1])
    window = ix - 1, iy - 1, ix + 2, iy + 2
    least = graph.rules.min_radius
    found = renew_nodes(before, replace(surface, clearance=clearance), surface, window, least, 1.0)
    assert found is not None
    for name in ("cell", "place", "maker", "label"):
        np.testing.assert_array_equal(getattr(found.nodes, name), getattr(nodes, name), name)
    assert found.number[early] == -1
    assert (np.diff(found.number[found.number >= 0]) > 0).all()
