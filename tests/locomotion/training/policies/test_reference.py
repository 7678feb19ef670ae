"""The reference motion: feet that stay where they stand, clear the ground and keep within the joints."""

import numpy as np
import pytest

from locomotion.gaits.policy.layout import JOINTS
from locomotion.training.policies.figure import Figure
from locomotion.training.policies.normal_gait import cadence, curve
from locomotion.training.policies.reference import SAMPLES, SPEEDS, make_reference, stance


def soles_at(reference, k):
    """(n, 6, 3) in the world, over a cycle at speed ``k``."""
    soles, root = reference.soles[1 + k].copy(), reference.root[1 + k]
    step = reference.periods[k] / SAMPLES
    soles[:, :, 0] += ((np.cumsum(root[:, 5]) - root[:, 5]) * step)[:, None]
    soles[:, :, 1:] += root[:, None, :2]
    return soles


@pytest.mark.parametrize("k", range(1, len(SPEEDS)))
def test_feet_neither_slip_nor_sink_nor_scuff(reference, k):
    soles, speed, step = soles_at(reference, k), SPEEDS[k], reference.periods[k] / SAMPLES
    moved = np.gradient(soles[:, :3, :2], axis=0) / step
    bears = {0: (0.04, 0.3), 1: (0.16, 0.46), 2: (0.2, stance(speed) - 0.08)}  # heel, ball, tip
    for point, (begin, end) in bears.items():
        during = slice(round(begin * SAMPLES), round(end * SAMPLES))
        assert np.abs(moved[during, point]).mean(axis=0).max() < 0.05 + 0.01 * speed
        assert np.abs(soles[during, point, 2]).max() < 0.004
    assert soles[:, :, 2].min() > -0.003
    swings = slice(round((stance(speed) + 0.08) * SAMPLES), round(0.9 * SAMPLES))
    assert soles[swings, :3, 2].min() > 0.008


def test_it_keeps_its_speed_and_pace(reference):
    np.testing.assert_allclose(reference.root[1:, :, 5].mean(axis=1), SPEEDS, atol=1e-9)
    np.testing.assert_allclose(2.0 / reference.periods[1:], [cadence(v) for v in SPEEDS[1:]])
    unevenness = np.abs(reference.root[2:, :, 5] / np.array(SPEEDS)[1:, None] - 1.0).max(axis=1)
    assert unevenness[: SPEEDS.index(1.6)].max() < 0.06
    assert unevenness.max() < 0.15


def test_left_is_right_half_a_cycle_later(reference):
    for joint in ("hip_flexion", "knee_flexion", "ankle_flexion", "hip_abduction", "shoulder_flexion"):
        right, left = (reference.joints[:, :, JOINTS.index(f"{side}_{joint}")] for side in ("right", "left"))
        np.testing.assert_allclose(left, np.roll(right, SAMPLES // 2, axis=1), atol=1e-12)


def test_it_keeps_within_the_joints(reference):
    limits = Figure(whole=False, timestep=0.005).limits
    assert (reference.joints >= limits[:, 0]).all()
    assert (reference.joints <= limits[:, 1]).all()


def test_at_the_usual_speed_it_is_close_to_what_was_measured(reference):
    k = SPEEDS.index(1.25)
    for joint, most in (("hip_flexion", 6.0), ("knee_flexion", 4.0), ("ankle_flexion", 6.0)):
        off = reference.joints[1 + k, :, JOINTS.index(f"right_{joint}")] - curve(joint, SAMPLES)
        assert np.degrees(np.sqrt(np.mean(off**2))) < most


def test_arms_swing_against_the_legs(reference):
    k = SPEEDS.index(1.25)
    hip, shoulder = (
        reference.joints[1 + k, :, JOINTS.index(f"right_{j}")] for j in ("hip_flexion", "shoulder_flexion")
    )
    assert np.corrcoef(hip, shoulder)[0, 1] < -0.8


def test_in_place_the_feet_go_straight_up_and_down(reference):
    soles = soles_at(reference, 0)
    assert np.ptp(soles[:, :, :2], axis=0).max() < 0.02
    swings = slice(round(0.77 * SAMPLES), round(0.88 * SAMPLES))
    assert soles[swings, :3, 2].min() > 0.015
    assert np.abs(soles[: round(0.6 * SAMPLES), :3, 2]).max() < 0.006


def test_in_place_the_weight_is_over_the_foot_that_bears(reference):
    sway = reference.root[1, :, 0]
    assert sway[round(0.8 * SAMPLES)] > 0.01, "to the left while the right foot is lifted"
    np.testing.assert_allclose(sway, -np.roll(sway, SAMPLES // 2), atol=1e-9)


def test_it_is_made_alike_each_time(reference):
    again = make_reference()
    assert all(np.array_equal(getattr(again, name), value) for name, value in vars(reference).items())


def test_feet_bear_all_of_the_weight_in_turn(reference):
    np.testing.assert_allclose(reference.loads.sum(axis=2).mean(axis=1), 1.0, atol=1e-9)
    np.testing.assert_array_equal(reference.loads[0], 0.5)
    for k, speed in enumerate(SPEEDS[1:], start=2):
        right, left = reference.loads[k].T
        np.testing.assert_allclose(left, np.roll(right, SAMPLES // 2), atol=1e-9)
        both = ((right > 0.0) & (left > 0.0)).mean()
        assert both == pytest.approx(2.0 * stance(speed) - 1.0, abs=2.5 / SAMPLES)
        assert right.max() < 1.8


@pytest.mark.parametrize("k", [SPEEDS.index(v) for v in (0.9, 1.25, 1.6, 2.0)])
def test_heels_come_down_softly_and_the_body_rises_as_peoples(reference, k):
    height, step = soles_at(reference, k)[:, 0, 2], reference.periods[k] / SAMPLES
    falls = np.gradient(height)[round(0.93 * SAMPLES) :] / step
    assert falls.min() > -0.8
    assert np.ptp(reference.root[1 + k, :, 1]) < 0.065
