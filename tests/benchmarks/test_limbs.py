"""Limbs that are put into each other by a known depth."""

import math

import mujoco
import numpy as np
import pytest

from benchmarks.limbs import Limbs
from locomotion.body.anatomy import SHANK, THIGH
from locomotion.body.models import figure
from locomotion.body.person import JOINT_NAMES


@pytest.fixture
def data():
    return mujoco.MjData(figure())


def pose(data: mujoco.MjData, **degrees: float) -> None:
    for name, angle in degrees.items():
        data.qpos[7 + JOINT_NAMES.index(name)] = np.radians(angle)
    mujoco.mj_kinematics(figure(), data)


def test_none_are_in_each_other_at_rest(data):
    limbs = Limbs(figure())
    pose(data)
    limbs.note(data)
    assert limbs.deepest() == {}


def closed(apart: float) -> dict[str, float]:
    """Legs that come together until the lower ends of the shanks' capsules are so far ``apart`` [m]."""
    low = THIGH + SHANK - 0.03  # [m] below the hips, which are 0.17 m apart
    angle = -math.degrees(math.asin((0.085 - 0.5 * apart) / low))
    return {"right_hip_abduction": angle, "left_hip_abduction": angle}


def test_shanks_are_in_each_other_by_their_thickness_less_what_is_between(data):
    limbs = Limbs(figure())
    pose(data, **closed(0.05))
    limbs.note(data)
    assert limbs.deepest()["right shank in left shank"] == pytest.approx(2 * 0.042 - 0.05, abs=1e-4)


def test_the_deepest_pose_is_remembered(data):
    limbs, depths = Limbs(figure()), []
    for apart in (0.06, 0.03, 0.06):
        pose(data, **closed(apart))
        limbs.note(data)
        depths.append(limbs.deepest()["right shank in left shank"])
    assert 0.0 < depths[0] < depths[1] == depths[2]


def test_what_overlaps_at_rest_counts_only_where_it_is_deeper(data):
    limbs = Limbs(figure())
    pose(data, right_shoulder_abduction=-5.0)
    limbs.note(data)
    found = limbs.deepest()
    assert 0.0 < found["chest in right upper arm"] < 0.02
    assert "chest in left upper arm" not in found
