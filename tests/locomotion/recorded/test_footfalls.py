"""Footfalls of gaits."""

import numpy as np

from locomotion.recorded.footfalls import AHEAD, BEARS, LEFT, footing_at, straight_footfalls
from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.sampling import stride_of

MOTIONS = load_motions()


def test_the_feet_of_a_gait_are_mirror_images():
    for gait in ("walk", "run"):
        right, left = np.moveaxis(footing_at(MOTIONS, MOTIONS.gait(gait), np.linspace(0.5, 4.0, 20)), 1, 0)
        assert np.abs(right[:, AHEAD] - left[:, AHEAD]).max() < 0.01
        assert np.abs(right[:, LEFT] + left[:, LEFT]).max() < 0.01
        assert (right[:, BEARS] > 0.2).all()


def test_who_goes_straight_puts_a_foot_down_once_a_stride():
    walk, place = MOTIONS.gait("walk"), [1.0, 2.0, 0.5, 0.7]
    right, left = straight_footfalls(MOTIONS, walk, 1.2, 0.2, place)
    stride = stride_of(MOTIONS, [walk], [1.2])[0]
    for foot in (right, left):
        assert np.isclose(np.linalg.norm(foot[1, :2] - foot[0, :2]), stride)
        assert np.allclose(foot[:, 2], 0.5)
