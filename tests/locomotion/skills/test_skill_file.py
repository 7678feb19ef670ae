"""Between the heights that a skill was learned at, against equation 7 solved as it is written."""

import numpy as np
import pytest

from locomotion.skills.skill_file import smoothest


def as_written(heights, values, height):
    """Weights of the distances to the heights and of a linear term, which the weights do not make up for."""
    k = len(heights)
    ones = np.stack([np.ones(k), heights], axis=1)
    system = np.block([[np.abs(heights[:, None] - heights), ones], [ones.T, np.zeros((2, 2))]])
    weights = np.linalg.solve(system, np.concatenate([values, np.zeros((2, values.shape[1]))]))
    return np.concatenate([np.abs(height - heights), [1.0, height]]) @ weights


@pytest.mark.parametrize("seed", range(8))
def test_the_spline_is_that_of_equation_7(seed):
    rng = np.random.default_rng(seed)
    heights = np.cumsum(rng.uniform(0.05, 0.4, rng.integers(2, 9)))
    values = rng.normal(size=(len(heights), 5))
    for height in rng.uniform(heights[0], heights[-1], 10):
        found = smoothest(heights, values, height)
        np.testing.assert_allclose(found, as_written(heights, values, height), atol=1e-12)
        np.testing.assert_allclose(found, [np.interp(height, heights, c) for c in values.T], atol=1e-12)


def test_one_height_serves_alone():
    values = np.arange(6.0).reshape(1, 2, 3)
    assert (smoothest(np.array([0.5]), values, 0.51) == values[0]).all()
