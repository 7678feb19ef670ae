"""Corridors of discs at random."""

import numpy as np

from benchmarks.corridors import disc_chain


def corridor(seed, discs=None, radius=(0.15, 2.0)):
    rng = np.random.default_rng(seed)
    return disc_chain(rng, int(rng.integers(1, 18)) if discs is None else discs, radius)


def ends(waypoints):
    return waypoints[1] - waypoints[0], waypoints[-1] - waypoints[-2]
