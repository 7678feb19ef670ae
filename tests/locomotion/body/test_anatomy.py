"""The measures of the person fit together, and the model is built from them."""

import mujoco
import numpy as np
import pytest

from locomotion.body.anatomy import (
    ANKLE,
    FOREARM,
    MASS,
    SHANK,
    SIDE_JOINTS,
    SIDE_SEGMENTS,
    STANDING_HEIGHT,
    THIGH,
    TRUNK_JOINTS,
    TRUNK_SEGMENTS,
    UPPER_ARM,
)
from locomotion.body.person import build_person


def test_segments_weigh_as_much_as_the_body():
    """The table of de Leva, with the trunk's and the shoulders' shares split among more parts."""
    trunk, side = (
        sum(each.mass for each in segments.values()) for segments in (TRUNK_SEGMENTS, SIDE_SEGMENTS)
    )
    assert trunk + 2.0 * side == pytest.approx(1.0, abs=1e-3)
    arm = sum(SIDE_SEGMENTS[part].mass for part in ("upper_arm", "forearm", "hand"))
    leg = sum(SIDE_SEGMENTS[part].mass for part in ("thigh", "shank", "foot", "toes"))
    assert arm == pytest.approx(0.0494, abs=1e-4) and leg == pytest.approx(0.1986, abs=1e-4)


def test_a_straight_leg_is_as_long_as_the_hip_is_high():
    assert THIGH + SHANK + ANKLE == pytest.approx(STANDING_HEIGHT, abs=1e-9)


def test_every_joint_can_rest_at_zero():
    """A clip leaves out the joints that stay there."""
    for joints in (*TRUNK_JOINTS.values(), *SIDE_JOINTS.values()):
        for joint in joints:
            assert joint.low <= 0.0 <= joint.high and joint.low < joint.high, joint.name
            assert np.linalg.norm(joint.axis) == 1.0 and np.count_nonzero(joint.axis) == 1, joint.name


def test_the_model_has_these_lengths_masses_and_torques():
    model = build_person()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)

    def apart(one, other):
        return np.linalg.norm(data.body(one).xpos - data.body(other).xpos)

    for side in ("right", "left"):
        assert apart(f"{side}_thigh", f"{side}_shank") == pytest.approx(THIGH)
        assert apart(f"{side}_shank", f"{side}_foot") == pytest.approx(SHANK)
        assert apart(f"{side}_upper_arm", f"{side}_forearm") == pytest.approx(UPPER_ARM)
        assert apart(f"{side}_forearm", f"{side}_hand") == pytest.approx(FOREARM)
        for name, segment in SIDE_SEGMENTS.items():
            assert model.body(f"{side}_{name}").mass == pytest.approx(MASS * segment.mass)
        for joint in (each for joints in SIDE_JOINTS.values() for each in joints):
            name = f"{side}_{joint.name}"
            assert np.rad2deg(model.joint(name).range) == pytest.approx([joint.low, joint.high])
            assert model.actuator(name).forcerange == pytest.approx([-joint.torque, joint.torque])
