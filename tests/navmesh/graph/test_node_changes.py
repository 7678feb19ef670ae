"""Nodes that are chosen anew around a change are those of the whole level; the others keep their places."""

import numpy as np
import pytest

from navmesh import NodeGraph
from navmesh.graph.node_changes import renew_nodes
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
