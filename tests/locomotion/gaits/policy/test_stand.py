"""The stand in which the policy begins."""

import mujoco
import numpy as np
import pytest

from locomotion.body.models import person_on
from locomotion.gaits.policy import layout as at
from locomotion.gaits.policy.kernel import Parts
from locomotion.gaits.policy.skill import load_policy
from locomotion.gaits.policy.stand import stand_still


@pytest.mark.parametrize("yaw", [0.0, 2.4, -3.0])
def test_its_feet_are_around_the_place_and_face_where_it_is_told(yaw):
    model, index = person_on(None)
    data, felt = mujoco.MjData(model), np.zeros(at.FELT_SIZE)
    place = np.array([3.0, -2.0, 0.5])
    stand_still(model, data, Parts(index, model), load_policy().motion, place, yaw, felt)
    soles = felt[at.SOLES].reshape(2, 3, 3)
    assert soles[:, :, 2].min() == pytest.approx(0.501)
    feet = soles[:, :2, :2].mean(axis=1)
    np.testing.assert_allclose(feet.mean(axis=0), place[:2], atol=0.02)
    ahead = soles[:, 1, :2] - soles[:, 0, :2]
    off = np.angle(np.exp(1j * (np.arctan2(ahead[:, 1], ahead[:, 0]) - yaw)))
    assert np.abs(off).max() < 0.15
    right_to_left = feet[1] - feet[0]
    assert right_to_left @ [-np.sin(yaw), np.cos(yaw)] > 0.08
