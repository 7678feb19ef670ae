"""Mixed play, for a moment."""

import numpy as np

from benchmarks.frames import measured, told
from benchmarks.giving_way import floor


def test_frames_and_orders_are_timed_against_bare_physics():
    counts = {"human": 1, "dog": 1, "walker": 2}
    times = measured(floor((0.0, 0.0, 20.0, 14.0)), counts, 1.4, 1.5, 5)
    assert 28 <= len(times.frames) <= 32  # after the first second, at 60 a second
    assert len(times.spent) == len(times.frames) and sum(times.spent) > times.bare > 0.0
    assert set(times.orders) <= set(counts)
    line = told("frames", [0.001, 0.001, 0.004])
    assert line.startswith("frames: mean 2.00, median 1.00") and "longest 4.0 x the median" in line
    assert told("nobody", []) == "nobody: none" and np.isfinite(times.bare)
