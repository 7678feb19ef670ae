"""Where the bodies of a crowd are, and of others that it hears of."""

import numpy as np

from locomotion.crowd import Crowd
from locomotion.crowd import layout as at
from tests.locomotion.crowd.levels import hall

_SPOTS = ((2.0, 3.0, 0.0), (6.0, 4.5, 0.0), (9.0, 2.0, 0.0))


def test_discs_are_where_the_bodies_are():
    crowd = Crowd(hall())
    for spot, radius in zip(_SPOTS, (0.3, 0.25, 0.4), strict=True):
        crowd.add(spot, radius)
    crowd.walkers[0].go_to([(9.0, 3.0, 0.0)], 1.4)
    for _ in range(50):
        crowd.tick()
    assert np.hypot(*crowd.velocities[0]) > 0.5
    assert np.array_equal(crowd.discs(), np.column_stack([crowd.positions, crowd.velocities, crowd.radii]))
    assert Crowd(hall()).discs().shape == (0, 6)


def test_a_crowd_hears_of_the_discs_of_others():
    crowd = Crowd(hall())
    crowd.add(_SPOTS[0])
    others = np.array([[*spot, 0.1 * k, -0.2 * k, 0.3] for k, spot in enumerate(_SPOTS[1:], 1)])
    crowd.lead(others)
    assert np.allclose(crowd.places_of_all[1:], others[:, :3], rtol=0.0, atol=1e-12)
    rows = crowd._table[1:3]
    assert np.array_equal(rows[:, [at.VX, at.VY]], others[:, 3:5])
    assert np.array_equal(rows[:, [at.GO_X, at.GO_Y]], others[:, 3:5])
    assert (rows[:, at.MODE] == at.LED).all() and (rows[:, at.WEIGHT] == at.UNMOVED).all()
    assert len(crowd.discs()) == 1  # its own
    crowd.lead(np.empty((0, 6)))
    assert len(crowd.places_of_all) == 1
