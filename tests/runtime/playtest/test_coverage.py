"""Coverage against the obvious count."""

import numpy as np
import pytest

from runtime.playtest.coverage import Coverage


def test_it_counts_as_a_look_at_every_patch_and_moment_does():
    rng = np.random.default_rng(3)
    patches = rng.uniform(0.0, 8.0, (20, 3)) * [1.0, 1.0, 0.0]
    times = np.sort(rng.uniform(0.0, 9.0, (3, 30)))
    tracks = [np.column_stack([each, rng.uniform(0.0, 8.0, (30, 3))]) for each in times]
    coverage = Coverage(patches)
    for track in [*tracks, np.empty((0, 4))]:
        coverage.add(track)
    first, visits = np.full(20, np.inf), np.zeros(20, dtype=int)
    for time, *at in np.vstack(tracks):
        away = np.linalg.norm(patches - at, axis=1)
        if away.min() <= 1.0:
            visits[away.argmin()] += 1
            first[away.argmin()] = min(first[away.argmin()], time)
    assert [n for *_, n in coverage.visits()] == visits.tolist() and 0 < visits.sum() < 90
    curve = coverage.curve(9.0)
    assert curve[0][0] == 0.0 and curve[-1][0] == 9.0
    for moment, share in curve:
        assert share == pytest.approx((first <= moment + 1e-9).mean(), abs=0.06)  # moments are rounded
    assert curve[-1][1] == np.isfinite(first).mean()
