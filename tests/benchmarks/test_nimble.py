"""Ways whose speeds are known: 2 m/s^2 up to 4 m/s, then on, then 2 m/s^2 down."""

import math

import numpy as np
import pytest

from benchmarks.nimble import before_goal, speeds, to_speed
from locomotion.body.person import CONTROL_DT

GOAL = np.array([20.0, 5.0])


def way() -> np.ndarray:
    """From x = 0 to `GOAL`, 20 m: 2 s, 3 s and 2 s, and a while at rest."""
    time = np.arange(0.0, 8.0, CONTROL_DT)
    speed = np.clip(np.minimum(2.0 * time, 2.0 * (7.0 - time)), 0.0, 4.0)
    x = np.cumsum(speed) * CONTROL_DT
    return np.stack([x, np.full(len(x), 5.0)], axis=1)


def test_speeds_are_means_around_each_moment():
    found = speeds(way())
    assert found[100] == pytest.approx(2.0, abs=0.03)
    assert found[350] == pytest.approx(4.0, abs=0.01)


def test_time_and_way_to_a_speed():
    time, far = to_speed(way(), 4.0)
    assert time == pytest.approx(1.9, abs=0.06)
    assert far == pytest.approx(3.6, abs=0.25)
    assert to_speed(way(), 5.0) == (math.inf, math.inf)


def test_how_far_from_its_goal_somebody_last_ran():
    assert before_goal(way(), GOAL) == pytest.approx(2.2**2 / 4.0, abs=0.1)
    assert before_goal(way()[-30:], GOAL) == math.inf
