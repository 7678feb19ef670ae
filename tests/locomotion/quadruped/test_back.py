"""The flexed back: its bones share the flexion, and shoulders and hips come nearer."""

import math

import numpy as np
import pytest

from locomotion.quadruped import layout as at
from locomotion.quadruped import load_body
from locomotion.quadruped.back import bend_back, bone_drop, girdles

DOG = load_body("dog")


def state(flexion: float) -> np.ndarray:
    st = np.zeros(at.STATE)
    st[at.BACK], st[at.FRONT_X] = flexion, DOG.spine.length
    bend_back(st, DOG.params())
    return st


@pytest.mark.parametrize("bones", [2, 4, 16])
def test_the_bones_share_what_the_sacrum_leaves(bones):
    drops = [bone_drop(k, bones, 0.25) for k in range(1, bones + 1)]
    assert drops[0] == 0.0 and drops[-1] == pytest.approx(0.75)
    joints = np.diff(drops)
    assert (joints > 0.0).all() and (np.diff(joints) < 0.0).all()  # less from the loin to the withers


@pytest.mark.parametrize("flexion", [-0.5, 0.0, 0.3, 1.0])
def test_chord_and_tilt_are_those_of_bones_laid_end_to_end(flexion):
    st = state(flexion)
    drops = flexion * np.array([bone_drop(k, DOG.spine.bones, DOG.spine.sacral) for k in range(1, 5)])
    end = DOG.spine.bone_length * np.array([np.cos(drops).sum(), -np.sin(drops).sum()])
    assert st[at.CHORD] * DOG.spine.length == pytest.approx(np.linalg.norm(end))
    assert st[at.TILT] == pytest.approx(-math.atan2(end[1], end[0]))


def test_flexion_brings_hips_and_shoulders_together():
    straight, rounded = (girdles(state(flexion), DOG.params()) for flexion in (0.0, 0.8))
    assert straight[0] == 0.0 and straight[3] == pytest.approx(DOG.spine.length)
    assert rounded[0] > 0.0 and rounded[3] < DOG.spine.length
    assert rounded[0] == pytest.approx(DOG.spine.length - rounded[3])


def test_a_bend_to_the_side_turns_hips_and_shoulders_against_each_other():
    st = state(0.0)
    st[at.SIDE_BEND] = 0.1
    _, y, rear, _, other, front = girdles(st, DOG.params())
    assert front - rear == pytest.approx(0.1) and rear < 0.0 < front
    assert y == other == 0.0


def test_sway_moves_hips_to_the_left():
    st = state(0.0)
    st[at.SWAY_REAR] = 0.02
    x, y, *_ = girdles(st, DOG.params())
    assert (x, y) == pytest.approx((0.0, 0.02))
