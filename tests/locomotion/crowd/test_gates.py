"""Gates are the narrow passages of a level."""

import numpy as np
import pytest

from locomotion.crowd.gates import find_gates
from tests.locomotion.crowd import gates_reference
from tests.locomotion.crowd.levels import corner, graph_of


def test_gates_are_the_narrow_passages():
    gates = find_gates(corner(), 3.25 * 0.3)
    assert len(gates.width) == 1 and gates.width[0] == pytest.approx(0.5, abs=0.01)
    centres = corner().surface.centers(np.flatnonzero(gates.row >= 0))
    assert 5.0 < centres[:, 0].min() < 6.5 and 11.5 < centres[:, 0].max() < 13.0
    inside = (centres[:, 0] > 7.0) & (centres[:, 0] < 11.0)
    assert np.abs(gates.axis[gates.row[gates.row >= 0]][inside, 0]) == pytest.approx(1.0)
    walls = find_gates(corner(), 0.3)
    assert len(walls.width) == 0


def test_gates_are_those_found_one_by_one():
    graph = graph_of(
        (0.0, 0.0, 6.0, 6.0, 0.0), (6.0, 2.0, 9.0, 3.1, 0.0), (8.0, 3.1, 9.0, 7.0, 0.0),
        (4.0, 7.0, 10.0, 12.0, 0.0), (2.0, 6.0, 2.7, 9.0, 0.0), (2.0, 8.2, 4.0, 9.0, 0.0),
        (5.0, 0.5, 9.0, 1.6, 3.0), (9.0, 0.0, 12.0, 4.0, 3.0),
    )  # fmt: skip
    for limit, least in ((0.45, 1), (0.7, 2), (1.3, 1)):
        found = find_gates(graph, limit)
        gate, along, axis, width = gates_reference.gates(graph.surface, limit)
        assert len(width) >= least and (found.width == width).all()
        covered = found.row >= 0
        assert ((gate >= 0) == covered).all()
        rows = found.row[covered]
        assert (found.gate[rows] == gate[covered]).all() and (found.along[rows] == along[covered]).all()
        assert found.axis[rows] == pytest.approx(axis[covered])
