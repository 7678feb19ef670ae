"""Routes and thin walls: no leg of a route crosses one, wherever it stands and however it is turned."""

import numpy as np
import pytest

from benchmarks.thin_walls import count_crossings


@pytest.mark.parametrize("radius", [0.1, 0.12, 0.15, 0.2, 0.3, 0.6])
def test_no_leg_crosses_a_thin_wall(radius: float) -> None:
    crossings, legs = count_crossings(range(700, 706), radius, 60)
    assert legs > 300
    assert crossings == 0


def test_crossings_are_seen() -> None:
    from benchmarks.thin_walls import crosses

    a, b = np.array([0.0, 0.0]), np.array([1.0, 0.0])
    p, q = np.array([[0.5, -1.0], [1.5, -1.0]]), np.array([[0.5, 1.0], [1.5, 1.0]])
    assert crosses(p, q, a, b).tolist() == [True, False]
