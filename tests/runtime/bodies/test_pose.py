"""Poses as a skeleton takes them: in the world, in the parents' frames, and between two moments."""

import numpy as np
import pytest

from runtime import World
from runtime.bodies.figure import rotate, turn
from runtime.bodies.pose import Pose, between


def test_pose_is_ready_for_a_skeleton(graph):
    world = World(graph)
    pose = world.spawn("human", (2.0, 3.0, 0.0), facing=1.0).pose
    n = len(pose.names)
    assert pose.transforms.shape == (n, 7) and pose.transforms.dtype == np.float64
    assert pose.names[0] == "pelvis" and pose.parents[0] == -1
    assert all(0 <= parent < child for child, parent in enumerate(pose.parents) if child > 0)
    assert np.linalg.norm(pose.transforms[:, 3:], axis=1) == pytest.approx(1.0)
    assert pose.local.shape == (n, 7) and pose.local[0] == pytest.approx(pose.transforms[0])
    for child in range(1, n):  # parents first: the chain of local transforms gives the ones in the world
        above, own = pose.transforms[pose.parents[child]], pose.local[child]
        assert above[:3] + rotate(above[3:], own[:3]) == pytest.approx(pose.transforms[child, :3])
        assert turn(above[3:], own[3:]) == pytest.approx(pose.transforms[child, 3:])
    assert pose.transforms[0, :2] == pytest.approx([2.0, 3.0], abs=0.2)


def test_in_the_frame_of_a_turned_parent():
    """The parent looks along y, its child 2 m further on: 2 m ahead of it."""
    left = np.array([np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])
    pose = Pose(("root", "hand"), np.array([-1, 0]), np.array([[1.0, 1, 0, *left], [1.0, 3, 0, *left]]))
    assert pose.local[0] == pytest.approx(pose.transforms[0])
    assert pose.local[1] == pytest.approx([2.0, 0, 0, 1, 0, 0, 0])
    assert repr(pose) == "<Pose of 2 bodies, root at [1.0, 1.0, 0.0]>"


def turned(x, degrees):
    half = np.radians(degrees) / 2.0
    return np.array([[x, 0.0, 0.0, np.cos(half), 0.0, 0.0, np.sin(half)]])


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_between_two_moments(sign):
    """Both signs of a quaternion are the same rotation: the shorter way is taken."""
    after = turned(2.0, 20.0)
    after[:, 3:] *= sign
    assert between(turned(0.0, 0.0), after, 0.5) == pytest.approx(turned(1.0, 10.0))
    for share, whole in ((0.0, turned(0.0, 0.0)), (1.0, turned(2.0, 20.0))):
        assert between(turned(0.0, 0.0), after, share) == pytest.approx(whole)
    assert np.linalg.norm(between(turned(0.0, 0.0), after, 0.3)[:, 3:]) == pytest.approx(1.0)
