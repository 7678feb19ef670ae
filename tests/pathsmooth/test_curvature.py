"""Curvature of polylines, and how much of it a speed allows."""

import numpy as np
import pytest

from pathsmooth.curvature import curvature, curvature_bound
from pathsmooth.errors import PathSmoothError


def test_curvature_of_a_circle():
    angle = np.linspace(0, 3, 40)
    circle = 4.0 * np.column_stack([np.cos(angle), np.sin(angle), angle])
    assert np.allclose(curvature(circle)[1:-1], 0.25, rtol=1e-3)
    assert np.allclose(curvature([[0, 0], [1, 0], [1, 1]]), [0, np.pi / 2, 0])
    with pytest.raises(PathSmoothError, match="points has shape"):
        curvature([1.0, 2.0])


def test_bound_by_speed():
    assert curvature_bound(4.0, 8.0) == pytest.approx(0.5)
    with pytest.raises(PathSmoothError, match="speed must be a positive number"):
        curvature_bound(0.0)
