"""Gates are the narrow passages of a level."""

import numpy as np
import pytest

from locomotion.crowd.gates import find_gates
from navmesh.graph.kernel_arrays import net_of
from tests.locomotion.crowd.levels import corner


def test_gates_are_the_narrow_passages():
    gates = find_gates(corner().surface, net_of(corner()), 3.25 * 0.3)
    assert len(gates.width) == 1 and gates.width[0] == pytest.approx(0.5, abs=0.01)
    centres = corner().surface.centers(np.flatnonzero(gates.of_cell >= 0))
    assert 5.0 < centres[:, 0].min() < 6.5 and 11.5 < centres[:, 0].max() < 13.0
    inside = (centres[:, 0] > 7.0) & (centres[:, 0] < 11.0)
    assert np.abs(gates.axis[gates.of_cell >= 0][inside, 0]) == pytest.approx(1.0)
    walls = find_gates(corner().surface, net_of(corner()), 0.3)
    assert len(walls.width) == 0
