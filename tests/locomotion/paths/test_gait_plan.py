"""Where a body runs and how fast, against the plain way to compute it."""

import numpy as np
import pytest

from locomotion.paths.gait_plan import _can_run
from locomotion.paths.tracking import _slow_down_in_time, _speed_up_in_time


@pytest.mark.parametrize("share", [0.0, 0.02, 0.3, 1.0])
def test_it_runs_where_nothing_hard_is_here_or_soon(share):
    rng = np.random.default_rng(3)
    for slowing in (0.0, 1.7, 40.0):
        at = np.linspace(0.0, 30.0, 301)
        hard = rng.random(301) < share
        plain = ~hard
        for each in at[hard]:
            plain[(at >= each - 1.0 - slowing) & (at <= each)] = False
        assert np.array_equal(_can_run(hard, at, slowing), plain)


def test_speeds_are_reached_and_left_in_time():
    rng = np.random.default_rng(4)
    squares, slower, faster = rng.uniform(0.1, 25.0, 60), rng.uniform(0.5, 3.0, 60), rng.uniform(0.5, 3.0, 60)
    slowed, plain = squares.copy(), squares.copy()
    _slow_down_in_time(slowed, slower, 0.1)
    for i in range(58, -1, -1):
        plain[i] = min(plain[i], plain[i + 1] + 2.0 * slower[i] * 0.1)
    assert np.array_equal(slowed, plain) and (slowed < squares).any()
    _speed_up_in_time(slowed, faster, 0.1)
    for i in range(1, 60):
        plain[i] = min(plain[i], plain[i - 1] + 2.0 * faster[i - 1] * 0.1)
    assert np.array_equal(slowed, plain)
