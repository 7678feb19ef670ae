"""What every animal does in each tick."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from locomotion.quadruped import layout as at
from locomotion.quadruped import load_body
from tests.locomotion.quadruped.bends import follow


@pytest.mark.parametrize("speed", [0.6, 1.2, 2.4])
def test_the_head_looks_a_time_ahead(speed):
    body = load_body("dog")
    herd, index, trail = follow(body, speed)
    fine = np.array([trail.point(arc) for arc in np.arange(0.0, trail.length + 2.0, 0.002)])
    tree = KDTree(fine)
    while not herd.state[index, at.STOPPING]:
        herd.tick()
        st = herd.state[index]
        here, seen = tree.query([herd.front(index), st[[at.LOOK_X, at.LOOK_Y]]])[1] * 0.002
        assert seen - here == pytest.approx(st[at.SPEED] * body.head.look_ahead, abs=0.006)
