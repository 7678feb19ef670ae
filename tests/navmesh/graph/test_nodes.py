"""Nodes are the largest discs that fit, until every cell wide enough is covered."""

import numpy as np
import pytest

from navmesh.graph.nodes import order_by_clearance
from tests.navmesh.shapes import plane
from tests.navmesh.surface.levels import build, random_level


def test_disc_of_a_square_room():
    graph = build(plane(0, 6, 0, 6))
    widest = graph.radii.argmax()
    assert graph.radii[widest] == pytest.approx(2.875, abs=1e-9)  # the cell next to the middle
    assert graph.positions[widest] == pytest.approx([3, 3, 0], abs=0.126)


@pytest.mark.parametrize("seed", range(3))
def test_every_wide_cell_has_a_node_and_lies_in_its_disc(seed):
    graph = build(*random_level(seed))
    surface = graph.surface
    wide = surface.clearance >= graph.rules.min_radius
    assert (graph.label[wide] >= 0).all()
    cells = np.flatnonzero(graph.label >= 0)
    away = np.linalg.norm((surface.centers(cells) - graph.positions[graph.label[cells]])[:, :2], axis=1)
    assert (away <= graph.radii[graph.label[cells]] + 1e-9).all()
    room = np.array([graph.clearance_at(place) for place in graph.positions])
    assert (graph.radii <= room + 0.02).all() and (graph.radii >= graph.rules.min_radius).all()


def test_wide_cells_come_first_in_steps():
    clearance = np.array([0.1, 0.52, 0.9, 0.5, 0.91])
    assert order_by_clearance(clearance, 0.1).tolist() == [2, 4, 1, 3, 0]
