"""Strides made up of known curves, as recordings that do not end where they began."""

import numpy as np
import pytest

from benchmarks.captured import captured_strides, fitted, humanoid3d
from benchmarks.shared_data import why_absent

PERIOD = 70.0


def side(name: str, at: np.ndarray) -> np.ndarray:
    first, second = {"thigh": (20.0, 3.0), "knee": (30.0, 20.0), "elbow": (8.0, 0.0)}[name]
    return 10.0 + first * np.cos(2.0 * np.pi * at) + second * np.sin(4.0 * np.pi * at)


@pytest.mark.parametrize("frames", [66, 71])
def test_a_stride_that_lacks_its_end_is_completed_from_the_other_side(frames):
    at = np.arange(frames) / PERIOD
    values = {
        name: np.stack([side(name, at), side(name, at + 0.5)], 1) for name in ("thigh", "knee", "elbow")
    }
    curves, period = fitted(values)
    assert period == pytest.approx(PERIOD, rel=0.01)
    for name, curve in curves.items():
        assert curve == pytest.approx(side(name, np.arange(100) / 100), abs=1.5)


def test_the_figure_of_humanoid3d_stands_on_our_axes():
    frames = np.zeros((2, 44))
    frames[:, 0], frames[:, 2], frames[:, 3] = 1.0 / 30.0, 0.9, 0.2
    frames[:, [4, 8, 12, 16, 21, 25, 30, 35, 39]] = 1.0  # no turns
    frames[:, 29] = 0.5 * np.pi  # the right elbow is bent
    capture = humanoid3d(frames)
    assert capture.rate == pytest.approx(30.0)
    places = dict(zip(capture.joints, capture.places()[0], strict=True))
    assert places["pelvis"] == pytest.approx([0.0, -0.2, 0.9])
    assert places["right_thigh"][1] < places["left_thigh"][1]
    assert places["right_foot"][2] == pytest.approx(0.9 - 0.421546 - 0.40987)
    forearm = places["right_hand"] - places["right_forearm"]
    assert forearm == pytest.approx([0.258947, 0.0, 0.0]), "it points ahead"


def test_captured_people_swing_their_arms_against_their_legs():
    strides = captured_strides("walk") + captured_strides("run")
    if not strides:
        pytest.skip(why_absent())
    for stride in strides:
        assert 0.9 < stride.speed < 5.6
        assert np.corrcoef(stride.curves["thigh"], stride.curves["shoulder"])[0, 1] < -0.5
