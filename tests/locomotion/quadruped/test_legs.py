"""Angles of a leg against the chain of its three bones."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from locomotion.quadruped.legs import solve_leg

UPPER, LOWER, FOOT, LEAN = 0.2, 0.21, 0.12, 0.15


def chain(angles, lengths=(UPPER, LOWER, FOOT)):
    """Ends of the bones (3, 2): x forwards, z up."""
    steps = [(length * math.sin(a), -length * math.cos(a)) for a, length in zip(angles, lengths, strict=True)]
    return np.cumsum(steps, axis=0)


@settings(deadline=None)
@given(st.floats(0.3, 0.48), st.floats(-0.7, 0.7), st.sampled_from([-1.0, 1.0]), st.floats(0.0, 0.8))
def test_the_toe_is_where_it_is_to_be(far, angle, side, curl):
    x, z = far * math.sin(angle), -far * math.cos(angle)
    joints = chain(solve_leg(x, z, UPPER, LOWER, FOOT, LEAN, curl, side))
    assert joints[2] == pytest.approx([x, z], abs=1e-9)
    # the joint between the long bones points forwards, or backwards
    (kx, kz), (ax, az) = joints[0], joints[1]
    assert side * (kx * az - kz * ax) <= 1e-9


def test_a_foot_bone_leans_backwards_and_a_swinging_paw_is_curled():
    z = -0.42
    still, swung = (solve_leg(0.0, z, UPPER, LOWER, FOOT, LEAN, curl, -1.0) for curl in (0.0, 0.6))
    assert still[2] == pytest.approx(LEAN, abs=0.06)
    assert swung[2] < still[2] - 0.2
    assert chain(swung)[2] == pytest.approx([0.0, z], abs=1e-9)


def test_out_of_reach_the_leg_is_stretched_towards_the_place():
    x, z = 0.3, -0.7
    joints = chain(solve_leg(x, z, UPPER, LOWER, FOOT, LEAN, 0.0, 1.0))
    assert np.linalg.norm(joints[2]) > 0.97 * (UPPER + LOWER) + 0.95 * FOOT
    assert joints[2] @ [x, z] / np.linalg.norm(joints[2]) / math.hypot(x, z) > 0.99


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_no_angle_jumps_from_folded_to_as_far_as_it_reaches(side):
    angles = np.array(
        [solve_leg(0.05, -far, UPPER, LOWER, FOOT, LEAN, 0.4, side) for far in np.arange(0.1, 0.51, 0.001)]
    )
    assert np.abs(np.diff(angles, axis=0)).max() < 0.015
