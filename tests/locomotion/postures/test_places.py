"""Places on the ground: one after the other, back again, and the poses there."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from locomotion.postures.places import beyond, inverse, place_of, placed


@pytest.mark.parametrize("seed", range(10))
def test_a_move_and_its_inverse_lead_back(seed):
    rng = np.random.default_rng(seed)
    place, move = rng.uniform(-3, 3, (2, 3))
    np.testing.assert_allclose(beyond(beyond(place, move), inverse(move)), place, atol=1e-12)


@pytest.mark.parametrize("seed", range(10))
def test_a_pose_is_turned_and_moved_as_a_whole(seed):
    rng = np.random.default_rng(seed)
    pose, place = rng.uniform(-1, 1, 46), rng.uniform(-3, 3, 3)
    pose[3:7] /= np.linalg.norm(pose[3:7])
    turn = Rotation.from_euler("z", place[2])
    moved = placed(pose, place)
    np.testing.assert_allclose(moved[:3], turn.apply(pose[:3]) + np.array([*place[:2], 0.0]), atol=1e-12)
    wanted = turn * Rotation.from_quat(pose[3:7], scalar_first=True)
    assert (Rotation.from_quat(moved[3:7], scalar_first=True).inv() * wanted).magnitude() < 1e-9
    np.testing.assert_array_equal(moved[7:], pose[7:])


def test_the_place_of_an_upright_pose_is_where_it_was_put():
    pose = np.zeros(46)
    pose[3] = 1.0
    np.testing.assert_allclose(place_of(placed(pose, np.array([1.0, 2.0, -0.7]))), [1.0, 2.0, -0.7])
