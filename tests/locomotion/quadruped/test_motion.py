"""How fast an animal goes, and how it stops."""

import numpy as np
import pytest

from locomotion.quadruped import layout as at
from locomotion.quadruped import load_body, stopping_distance
from tests.locomotion.quadruped.bends import follow


def test_a_stop_takes_the_distance_that_was_foretold():
    body = load_body("dog")
    for speed in (0.8, 2.0, 4.0):
        herd, index, _ = follow(body, speed, np.array([[-19.0, 0, 0], [19.0, 0, 0]]))
        for _ in range(300):
            herd.tick()
        begun, pace = herd.root(index)[0], herd.state[index, at.SPEED]
        assert pace == pytest.approx(speed, abs=0.1)
        herd.stop(index)
        for _ in range(500):
            herd.tick()
        assert herd.resting(index)
        assert herd.root(index)[0] - begun == pytest.approx(stopping_distance(body, pace), abs=1e-3)
    distances = [stopping_distance(body, speed) for speed in np.linspace(0.0, 5.0, 20)]
    assert np.all(np.diff(distances) > 0.0)
