"""Where all bones are; joints move without jumps."""

import math

import numpy as np
import pytest

from locomotion import Ground
from locomotion.quadruped import load_body
from locomotion.quadruped.motion import DT
from tests.locomotion.quadruped.bends import follow
from tests.locomotion.quadruped.scenes import animal_on, floor, quads, run, stairs


@pytest.mark.parametrize(
    ("ground", "begin", "end"),
    [
        (stairs(), (0.0, 0.0, 0.0), (6.0, 0.0, 0.9)),
        (stairs(), (6.0, 0.0, 0.9), (0.0, 0.0, 0.0)),
        (Ground.from_arrays(*quads(floor(slope=0.5))), (0.0, 0.0, 0.0), (6.0, 0.0, 3.0)),
        (Ground.from_arrays(*quads(floor(slope=0.5))), (6.0, 0.0, 3.0), (0.0, 0.0, 0.0)),
    ],
    ids=["upstairs", "downstairs", "uphill", "downhill"],
)
def test_joints_do_not_jump(ground, begin, end):
    yaw = math.atan2(0.0, end[0] - begin[0])
    animal = animal_on(ground, None, begin, yaw, np.array([begin, end]))
    joints = []
    animal.go_to(end, 2.0)
    run(animal, each=lambda: joints.append(animal.herd.joints[animal.index].copy()))
    assert animal.status == "arrived"
    speeds = np.diff(np.unwrap(joints, axis=0), axis=0) / DT
    assert np.abs(np.diff(speeds, axis=0)).max() < 25.0


def test_joint_speeds_do_not_jump():
    herd, index, _ = follow(load_body("dog"), 1.2)
    joints = []
    while not herd.resting(index):
        herd.tick()
        joints.append(herd.joints[index].copy())
    speeds = np.diff(np.unwrap(joints, axis=0), axis=0) / DT
    assert np.abs(np.diff(speeds, axis=0)).max() < 15.0  # rad/s between ticks, of swings at up to 25 rad/s
