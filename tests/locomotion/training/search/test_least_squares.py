"""Least squares on trials: finds the parameters, bears trials that fail, resumes to the same result."""

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.training.progress import show
from locomotion.training.search.least_squares import Work, fit

WANTED = np.array([0.6, -0.4, 0.3, 0.0])


class Throws:
    """Outcomes that change with the parameters and, a little crookedly, with the trial; one trial in eight
    fails."""

    def trials(self, rng):
        return list(rng.normal(size=16))

    def residuals(self, candidate, trial):
        if trial > 1.2:
            return np.full(3, np.nan)
        off = candidate[:3] - WANTED[:3]
        return 3.0 * (off + 0.2 * np.sin(off[::-1]) + 0.3 * candidate[3] * trial)


def learned(path=None, rounds=4, seed=0, told=show):
    scale = np.array([0.5, 0.5, 0.5, 0.5])
    return fit(Throws(), np.array([0.0, 0.0, 0.0, 0.4]), scale, rounds, seed, Work(path, 1, told))


def test_it_finds_what_makes_every_trial_end_as_wanted():
    told = []
    x = learned(rounds=10, told=told.append)
    np.testing.assert_allclose(x, WANTED, atol=0.1)
    assert [p.generation for p in told] == list(range(1, 11))
    assert 0.5 < told[-1].survival < 1.0
    kept = fit(Throws(), np.zeros(4), np.array([0.5, 0.0, 0.5, 0.5]), 2, 0, Work(workers=1))
    assert kept[1] == 0.0 and kept[0] > 0.3


def test_a_run_that_was_stopped_goes_on_to_the_same_result(tmp_path):
    class Stop(Exception):
        pass

    def stop(progress):
        if progress.generation == 2:
            raise Stop

    with pytest.raises(Stop):
        learned(tmp_path / "search.npz", told=stop)
    told = []
    np.testing.assert_array_equal(learned(tmp_path / "search.npz", told=told.append), learned())
    assert [p.generation for p in told] == [3, 4]
    with pytest.raises(LocomotionError, match="another training or seed"):
        learned(tmp_path / "search.npz", seed=1)
