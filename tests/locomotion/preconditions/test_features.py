"""What odds depend on is the same for a body and its mirror image, and counts from the obstacle."""

import math

import numpy as np
import pytest

from locomotion.gaits.run import layout
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.preconditions.features import (
    BEFORE,
    FEATURES,
    SITE,
    before_run_up,
    describe_moment,
    site_of,
)
from locomotion.preconditions.moments import Moment


def wall(x=10.0, y=0.0, yaw=0.0, size=0.8, affordance="vault"):
    normal = -np.array([math.cos(yaw), math.sin(yaw), 0.0])
    return ObstacleAhead(10.0, affordance, size, np.array([x, y, size]), normal, 0.3)


def moment(rng, side=1.0, mirrored=False):
    """A body that moves along x; or its mirror image in y = 0."""
    state = layout.new_state()
    flip = -1.0 if mirrored else 1.0
    state[layout.STANCE], state[layout.HEADING] = side * flip, flip * rng.normal() * 0.1
    state[layout.STEPS], state[layout.STEP_SPEED], state[layout.TRIM] = 5.0, 3.1, 0.1
    state[[layout.COM_X, layout.COM_Z]] = 7.0, 1.0
    state[layout.VELOCITY_X], state[layout.VELOCITY_Y] = 3.0, flip * rng.normal()
    for foot in (layout.LEFT_PLANTED, layout.RIGHT_PLANTED):
        state[foot : foot + 3] = 7.2, 0.0, 0.05
    state[layout.SENSOR_VALUES] = rng.normal(size=12)  # these are of the stance side already
    return Moment(state, np.array([3.0, 0.02, 3.2, 3.3]), np.array([0.04, 0.1]), flip * rng.normal() * 0.1)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_mirror_image_has_the_same_features(side):
    site = site_of(wall(), 0.9)
    own = describe_moment(moment(np.random.default_rng(3), side), site)
    other = describe_moment(moment(np.random.default_rng(3), side, mirrored=True), site)
    np.testing.assert_allclose(own, other, atol=1e-12)


def test_they_count_from_the_obstacle():
    told = dict(
        zip(FEATURES, describe_moment(moment(np.random.default_rng(1)), site_of(wall(), 0.9)), strict=True)
    )
    assert told["foot distance"] == pytest.approx(2.8) and told["height over edge"] == pytest.approx(0.2)
    assert told["missing speed"] == pytest.approx(0.2) and told["planned change"] == pytest.approx(0.1)
    assert (told["size"], told["depth"], told["grip"]) == (0.8, 0.3, 0.9)


def test_thickness_counts_only_where_one_gets_over_it():
    onto, over = site_of(wall(affordance="jump"), 0.9), site_of(wall(), 0.9)
    assert onto[SITE.index("depth")] == 0.0 and over[SITE.index("depth")] == 0.3
    assert before_run_up(over, 50.0).tolist() == [0.8, 0.3, 0.9, 16.0] and len(BEFORE) == 4
