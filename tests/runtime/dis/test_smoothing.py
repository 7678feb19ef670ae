"""Corrections: no jump in place or velocity, and soon gone."""

import numpy as np
import pytest

from runtime.dis.smoothing import advanced, rate_for


def test_steps_of_any_length_lead_to_the_same():
    offset, speed, rate = np.array([[1.0, -2.0]]), np.array([[3.0, 0.5]]), np.array([2.0])
    many = offset, speed
    for _ in range(100):
        many = advanced(*many, rate, 0.01)
    once = advanced(offset, speed, rate, 1.0)
    assert np.allclose(many, once, atol=1e-12)


def test_it_is_a_critically_damped_spring():
    """Against small steps of x'' = -2 r x' - r² x."""
    x, v, rate, step = 1.0, -4.0, 3.0, 1e-5
    for _ in range(50_000):
        v += step * (-2.0 * rate * v - rate * rate * x)
        x += step * v
    found = advanced(np.array([[1.0]]), np.array([[-4.0]]), np.array([rate]), 0.5)
    assert found[0][0, 0] == pytest.approx(x, abs=1e-4) and found[1][0, 0] == pytest.approx(v, abs=1e-3)


@pytest.mark.parametrize("size", [1e-6, 0.3, 2.0, 9.0])
def test_a_correction_keeps_to_its_greatest_speed(size):
    offset, speed = np.array([[size, 0.0]]), np.zeros((1, 2))
    rate, fastest = rate_for(offset, 3.0), 0.0
    for _ in range(1200):
        offset, speed = advanced(offset, speed, rate, 0.01)
        fastest = max(fastest, float(np.linalg.norm(speed)))
    assert fastest <= 3.0 + 1e-6 and np.linalg.norm(offset) < 0.05 * size
