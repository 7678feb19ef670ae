"""How far each cell is from where walking ends."""

import math

import numpy as np
import pytest

from tests.navmesh.shapes import box, plane
from tests.navmesh.surface.levels import build


def test_clearance_is_exact_beside_slanting_edges():
    angle = 0.3
    turn = np.array(
        [[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]]
    )
    flat, faces = plane(-4, 4, -3, 3)
    graph = build((flat @ turn.T, faces))
    centers = graph.surface.centers() @ turn
    truth = np.minimum(4 - np.abs(centers[:, 0]), 3 - np.abs(centers[:, 1]))
    error = np.abs(graph.surface.clearance - truth)
    assert error.max() < 0.05
    assert error.mean() < 0.005


def test_it_is_carried_over_the_links_and_not_from_storey_to_storey():
    graph = build(plane(0, 6, 0, 6), plane(0, 6, 0, 6, 3.0), box(2.9, 3.1, 2.9, 3.1, 3.0, 5.0))
    low, high = graph.clearance_at((3.0, 2.0, 0.0)), graph.clearance_at((3.0, 2.0, 3.0))
    assert low == pytest.approx(2.0, abs=0.01) and high == pytest.approx(0.9, abs=0.01)
