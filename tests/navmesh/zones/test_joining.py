"""Edges of pieces are what the whole graph's edges would be."""

import numpy as np
import pytest

from navmesh.graph.edges import border_pairs, measure_edges
from navmesh.graph.kernel_arrays import net_of
from navmesh.zones.zones import zones_of
from tests.navmesh.zones.alike import edges_of_pieces
from tests.navmesh.zones.test_switching import in_an_apartment


def test_edges_of_pieces_are_those_that_the_whole_would_have():
    base, outlines = in_an_apartment()
    graph = base.with_zones(outlines)
    graph.block(*list(outlines)[::2])
    net, pieces = net_of(graph), zones_of(graph).switches.first_piece
    place = np.column_stack([net.nodes["position"][:, :2], graph.radii])
    surface = graph.surface
    key, pair, clear = border_pairs(graph.label, surface.field, 0, len(surface))
    ends, width, gate, _ = measure_edges(key, pair, clear, surface.field, place)
    found = {(a, b): (wide, *where) for a, b, wide, *where, _, _ in edges_of_pieces(graph) if a < b}
    wanted = {
        (int(a), int(b)): (w, *where)
        for (a, b), w, where in zip(ends, width, gate.tolist(), strict=True)
        if max(a, b) >= pieces
    }
    assert found.keys() == wanted.keys() and len(found) > 50
    same = [found[key] == pytest.approx(wanted[key], abs=1e-9) for key in found]
    assert np.mean(same) > 0.9  # of equally wide pairs of cells another may come first
    assert all(found[key][0] == pytest.approx(wanted[key][0], abs=0.01) for key in found)
