"""Postures by the names of joints."""

import math

import numpy as np

from locomotion.body.person import JOINT_NAMES
from locomotion.recovery.postures import mirrored, move, posture


def test_a_name_without_a_side_is_for_both():
    angles = posture(elbow_flexion=90, left_knee_flexion=30)
    named = {name: angle for name, angle in zip(JOINT_NAMES, angles, strict=True) if angle}
    assert named == {
        "right_elbow_flexion": math.pi / 2,
        "left_elbow_flexion": math.pi / 2,
        "left_knee_flexion": math.pi / 6,
    }


def test_the_mirror_of_the_mirror_is_the_posture():
    angles = np.random.default_rng(0).normal(size=39)
    assert np.array_equal(mirrored(mirrored(angles)), angles)


def test_the_mirror_swaps_sides_and_leans_the_other_way():
    there = posture(waist_roll=10, neck_yaw=20, neck_pitch=30, right_hip_flexion=40)
    assert np.allclose(
        mirrored(there), posture(waist_roll=-10, neck_yaw=-20, neck_pitch=30, left_hip_flexion=40)
    )


def test_moves_from_one_posture_to_another():
    begun, target, there = np.zeros(39), posture(elbow_flexion=90), np.empty(39)
    for share, done in ((-1.0, 0.0), (0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (2.0, 1.0)):
        move(begun, target, share, there)
        assert np.allclose(there, done * target)
