"""The reference motion of a run: feet that stay where they bear, and a body that flies in between."""

import numpy as np
import pytest

from locomotion.gaits.policy.layout import JOINTS
from locomotion.training.policies.figure import Figure
from locomotion.training.policies.reference import SAMPLES, SPEEDS
from locomotion.training.policies.running_reference import SPEEDS as RUNS
from locomotion.training.policies.running_reference import contact_time, run_cadence

GRAVITY = 9.81


def test_the_walk_is_as_it_was(both, reference):
    for name, values in vars(reference).items():
        np.testing.assert_array_equal(getattr(both, name)[: len(values)], values)
    assert tuple(both.speeds) == (*SPEEDS, *RUNS)


@pytest.mark.parametrize("k", range(len(RUNS)))
def test_feet_neither_slip_nor_sink_nor_scuff(both, k):
    row, speed, period = len(SPEEDS) + 1 + k, RUNS[k], both.periods[len(SPEEDS) + k]
    assert period == pytest.approx(2.0 / run_cadence(speed))
    soles, step, bears = both.soles[row].copy(), period / SAMPLES, contact_time(speed) / period
    soles[:, :, 0] += ((np.cumsum(both.root[row, :, 5]) - both.root[row, :, 5]) * step)[:, None]
    soles[:, :, 1:] += both.root[row, :, None, :2]
    moved = np.gradient(soles[:, :3, 0], axis=0) / step
    for point, (begin, end) in {0: (0.1, 0.3), 1: (0.1, 0.6), 2: (0.25, 0.85)}.items():
        during = slice(int(begin * bears * SAMPLES) + 1, int(end * bears * SAMPLES))
        assert np.abs(moved[during, point]).max() < 0.08 * speed
        assert np.abs(soles[during, point, 2]).max() < 0.006
    assert soles[:, :3, 2].min() > -0.006
    swings = slice(round((bears + 0.1) * SAMPLES), round(0.9 * SAMPLES))
    assert soles[swings, :3, 2].min() > 0.025
    np.testing.assert_allclose(both.root[row, :, 5].mean(), speed, atol=1e-9)


@pytest.mark.parametrize("k", range(len(RUNS)))
def test_between_the_steps_the_body_flies(both, k):
    row, period = len(SPEEDS) + 1 + k, both.periods[len(SPEEDS) + k]
    loads = both.loads[row]
    assert loads.sum(axis=1).mean() == pytest.approx(1.0)
    flies = loads.sum(axis=1) == 0.0
    assert flies.mean() == pytest.approx(1.0 - 2.0 * contact_time(RUNS[k]) / period, abs=3.0 / SAMPLES)
    falls = np.gradient(np.gradient(both.root[row, :, 1])) / (period / SAMPLES) ** 2
    inside = flies & np.roll(flies, 2) & np.roll(flies, -2)
    assert falls[inside].mean() == pytest.approx(-GRAVITY, rel=0.15)
    assert np.abs(both.root[row, :, 7].mean()) < 1e-9


def test_left_is_right_half_a_cycle_later_and_arms_swing_against_legs(both):
    runs = both.joints[len(SPEEDS) + 1 :]
    for joint in ("hip_flexion", "knee_flexion", "ankle_flexion", "hip_abduction", "elbow_flexion"):
        right, left = (runs[:, :, JOINTS.index(f"{side}_{joint}")] for side in ("right", "left"))
        np.testing.assert_allclose(left, np.roll(right, SAMPLES // 2, axis=1), atol=1e-9)
    arms = [runs[:, :, JOINTS.index(f"{side}_shoulder_flexion")] for side in ("right", "left")]
    assert (arms[0][:, 0] < arms[1][:, 0] - 0.5).all(), "the right foot strikes, the right arm is behind"


def test_it_keeps_within_the_joints_but_for_ankles_that_are_bent_most(both):
    limits = Figure(whole=False, timestep=0.005).limits
    over = np.radians([7.0 if joint.endswith("ankle_flexion") else 0.0 for joint in JOINTS])
    assert (both.joints >= limits[:, 0]).all()
    assert (both.joints <= limits[:, 1] + over).all()
