"""Quaternions of kernels against SciPy's rotations."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from locomotion.characters.quaternions import between, from_axes, multiply, rotate


@pytest.mark.parametrize("seed", range(30))
def test_as_scipy_has_them(seed):
    rng = np.random.default_rng(seed)
    one, other = Rotation.random(2, rng=rng)
    a, b = one.as_quat(scalar_first=True), other.as_quat(scalar_first=True)
    out, vector = np.empty(4), rng.uniform(-1, 1, 3)
    multiply(a, b, out)
    assert abs(out @ (one * other).as_quat(scalar_first=True)) == pytest.approx(1.0)
    multiply(a, b, a_copy := a.copy())
    np.testing.assert_array_equal(a_copy, out)
    turned = vector.copy()
    rotate(a, turned, turned)
    np.testing.assert_allclose(turned, one.apply(vector), atol=1e-12)
    from_axes(*np.ascontiguousarray(one.as_matrix().T), out)
    assert abs(out @ a) == pytest.approx(1.0)
    between(a, -b, 0.5, out)
    middle = one * Rotation.from_rotvec(0.5 * (one.inv() * other).as_rotvec())
    assert abs(out @ middle.as_quat(scalar_first=True)) == pytest.approx(1.0)


@pytest.mark.parametrize("axis", range(3))
def test_half_turns(axis):
    half = Rotation.from_rotvec(np.pi * np.eye(3)[axis])
    out = np.empty(4)
    from_axes(*np.ascontiguousarray(half.as_matrix().T), out)
    assert abs(out @ half.as_quat(scalar_first=True)) == pytest.approx(1.0)
