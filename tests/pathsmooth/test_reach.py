"""The search for a curve of bounded curvature, by headings and places."""

import numpy as np

from benchmarks.corridors import bounded_curve
from pathsmooth import reach


def test_search_never_misses_a_curve_that_exists():
    for seed in range(8):
        waypoints, centers, radii, start, end = bounded_curve(np.random.default_rng(seed), 0.5, 0.15, turns=3)
        first, last = (
            reach.End(place, np.arctan2(t[1], t[0]))
            for place, t in ((waypoints[0], start), (waypoints[-1], end))
        )
        for settings in ((0.5, 3, 0.06), (0.4, 4, 0.025)):
            code, positions, discs = reach.search(first, last, centers, radii, 0.5, reach.Fineness(*settings))
            assert code == reach.REACHED
            assert np.all(np.diff(discs) >= 0)
            assert len(positions) == len(discs)
