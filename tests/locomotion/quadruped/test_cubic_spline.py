"""Splines of trails against those of SciPy."""

import numpy as np
from scipy.interpolate import CubicSpline

from locomotion.quadruped.cubic_spline import along_spline, length_along, natural_spline


def test_it_is_the_natural_spline_to_the_last_bit():
    """Of knots 0.1 mm to 0.1 m apart, of two knots, too."""
    random = np.random.default_rng(1)
    for count in (2, 3, 4, *random.integers(5, 200, 60).tolist()):
        at = np.concatenate([[0.0], np.cumsum(10.0 ** random.uniform(-4.0, -1.0, count - 1))])
        values = 0.05 * np.cumsum(random.normal(size=(count, 2)), axis=0)
        exact, pieces = CubicSpline(at, values, bc_type="natural"), natural_spline(at, values)
        assert np.array_equal(pieces, exact.c)
        where = np.sort(np.concatenate([at, random.uniform(0.0, at[-1], 300)]))
        place, first, second = np.empty((3, len(where), 2))
        along_spline(at, pieces, where, place, first, second)
        assert np.array_equal(place, exact(where))
        assert np.array_equal(first, exact(where, 1)) and np.array_equal(second, exact(where, 2))
        along = np.empty(len(where))
        length_along(at, pieces, where, along)
        steps = np.linalg.norm(np.diff(exact(where), axis=0), axis=1)
        assert np.array_equal(along, np.concatenate([[0.0], np.cumsum(steps)]))
