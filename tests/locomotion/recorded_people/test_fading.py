"""Going over from one motion to another: no jump of pose or rate, and nothing is left in the end."""

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from locomotion.recorded_people.fading import difference, fade_from, faded, rates


def pose(rng, spread):
    out = np.concatenate([rng.normal(0, 0.05, 3), [1.0, 0, 0, 0], rng.normal(0, spread, 39)])
    out[3:7] = Rotation.from_rotvec(rng.normal(0, spread, 3)).as_quat(scalar_first=True)
    return out


@pytest.mark.parametrize("seed", range(20))
def test_it_begins_as_the_old_motion_was_and_ends_as_the_new_one_is(seed):
    rng = np.random.default_rng(seed)
    old, new = pose(rng, 0.3), pose(rng, 0.3)
    old_rates, new_rates = rng.normal(0, 1.0, 45), np.zeros(45)
    offsets, offset_rates, seconds = fade_from(old, old_rates, new, new_rates)
    at = [faded(new, offsets, offset_rates, seconds, elapsed) for elapsed in (0.0, 1e-6, seconds)]
    np.testing.assert_allclose(difference(at[0], old), 0.0, atol=1e-9)
    np.testing.assert_allclose(rates(at[0], at[1], 1e-6)[6:], old_rates[6:], atol=1e-3)
    np.testing.assert_array_equal(at[2], new)
    almost = faded(new, offsets, offset_rates, seconds, seconds - 1e-4)
    assert np.abs(rates(almost, new, 1e-4)).max() < 1e-3


@pytest.mark.parametrize("seed", range(20))
def test_the_greater_the_difference_the_longer_it_takes(seed):
    rng = np.random.default_rng(seed)
    old, new = pose(rng, 0.6), pose(rng, 0.6)
    offsets, offset_rates, seconds = fade_from(old, np.zeros(45), new, np.zeros(45))
    frames = [faded(new, offsets, offset_rates, seconds, t) for t in np.arange(0.0, seconds + 0.02, 1 / 60)]
    steps = np.array([difference(b, a) for a, b in itertools.pairwise(frames)])
    assert np.degrees(np.abs(steps[:, 6:]).max()) < 5.0
    assert np.linalg.norm(steps[:, :3], axis=1).max() <= 0.0201


def test_a_difference_is_what_turns_one_pose_into_the_other():
    rng = np.random.default_rng(1)
    one, other = pose(rng, 1.0), pose(rng, 1.0)
    apart = difference(one, other)
    turned = Rotation.from_rotvec(apart[3:6]) * Rotation.from_quat(other[3:7], scalar_first=True)
    assert (turned.inv() * Rotation.from_quat(one[3:7], scalar_first=True)).magnitude() < 1e-9
    np.testing.assert_allclose(other[7:] + apart[6:], one[7:])
