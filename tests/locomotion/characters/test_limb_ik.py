"""A limb of two links reaches its target, bends the right way, and finds what a search finds."""

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from locomotion.characters.limb_ik import reach


def solved(start, target, upper, lower, hinge, side=1.0):
    one, other = np.empty(4), np.empty(4)
    reach(start, target, upper, lower, hinge, side, one, other)
    turns = [Rotation.from_quat(q, scalar_first=True) for q in (one, other)]
    middle = start + turns[0].apply([0, 0, -upper])
    return middle, middle + turns[1].apply([0, 0, -lower]), turns


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_end_is_at_the_target_and_the_joint_bends_to_its_side(seed, side):
    rng = np.random.default_rng(seed)
    upper, lower = rng.uniform(0.1, 0.6, 2)
    start, way, hinge = rng.uniform(-1, 1, (3, 3))
    hinge /= np.linalg.norm(hinge)
    length = rng.uniform(abs(upper - lower) + 0.01, 0.98 * (upper + lower))
    target = start + length * way / np.linalg.norm(way)
    middle, end, turns = solved(start, target, upper, lower, hinge, side)
    np.testing.assert_allclose(end, target, atol=1e-9)
    np.testing.assert_allclose(turns[0].apply([0, 1, 0]), turns[1].apply([0, 1, 0]), atol=1e-9)
    ahead = np.cross(target - start, hinge)
    assert side * (middle - start) @ ahead >= 0.0


@pytest.mark.parametrize("seed", range(5))
def test_it_finds_what_a_search_finds(seed):
    """The middle joint by least squares: at the right distance from both ends, in the plane of the hinge."""
    rng = np.random.default_rng(seed)
    upper, lower = rng.uniform(0.2, 0.5, 2)
    start, target = np.zeros(3), np.array([0.1, 0.05, -0.85 * (upper + lower)])
    hinge = np.array([0.0, 1.0, 0.0])
    away = np.cross(target, hinge)

    def wrong(middle):
        normal = np.cross(away, target)
        return [np.linalg.norm(middle) - upper, np.linalg.norm(middle - target) - lower, middle @ normal]

    found = least_squares(wrong, 0.5 * target + 0.2 * away / np.linalg.norm(away), xtol=1e-14, ftol=1e-14)
    middle, _, _ = solved(start, target, upper, lower, hinge)
    np.testing.assert_allclose(middle, found.x, atol=1e-5)


def test_a_target_out_of_reach_is_approached_on_the_line_to_it():
    start, target = np.array([0.0, 0.0, 1.0]), np.array([0.0, 3.0, 1.0])
    _, end, _ = solved(start, target, 0.4, 0.4, np.array([1.0, 0.0, 0.0]))
    np.testing.assert_allclose(end, [0.0, 0.8, 1.0], atol=1e-6)
    _, end, _ = solved(start, start, 0.4, 0.3, np.array([1.0, 0.0, 0.0]))
    assert np.linalg.norm(end - start) == pytest.approx(0.1, abs=1e-3)


def test_a_hinge_along_the_limb_is_no_trouble():
    start, target = np.zeros(3), np.array([0.0, 0.0, -0.5])
    _, end, _ = solved(start, target, 0.4, 0.4, np.array([0.0, 0.0, 1.0]))
    np.testing.assert_allclose(end, target, atol=1e-9)


def test_it_stretches_smoothly():
    """From bent to out of reach no angle jumps, and near the end it is missed by little."""
    angles = []
    for length in np.linspace(0.7, 0.9, 201):
        middle, end, _ = solved(
            np.zeros(3), np.array([0.0, 0.0, -length]), 0.4, 0.4, np.array([0.0, 1.0, 0.0])
        )
        one, other = middle, end - middle
        angles.append(np.degrees(np.arccos(np.clip(one @ other / 0.16, -1.0, 1.0))))
        if length <= 0.993 * 0.8:
            assert np.linalg.norm(end - [0.0, 0.0, -length]) < 0.002 * 0.8
    assert (np.diff(angles) < 1e-3).all() and np.abs(np.diff(angles)).max() < 1.5
