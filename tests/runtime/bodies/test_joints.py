"""The joints of a person turn its bodies as MuJoCo has them."""

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from locomotion.body.models import figure
from runtime.bodies.figure import Figure
from runtime.bodies.joints import person_joints


def test_a_pose_by_angles_is_the_pose_of_the_model():
    model, joints = figure(), person_joints()
    data, look, rng = mujoco.MjData(model), Figure.from_model(model), np.random.default_rng(4)
    angles = rng.uniform(-1.0, 1.0, len(joints.names))
    data.qpos[:7] = 1.0, 2.0, 3.0, *Rotation.random(random_state=5).as_quat(scalar_first=True)
    data.qpos[7 : 7 + len(angles)] = angles
    mujoco.mj_kinematics(model, data)
    place, turn = [data.qpos[:3].copy()], [Rotation.from_quat(data.qpos[3:7], scalar_first=True)]
    for body in range(1, len(look.bodies)):
        parent = look.parents[body]
        place.append(place[parent] + turn[parent].apply(joints.offsets[body]))
        turn.append(turn[parent])
        for k in np.flatnonzero(joints.body == body):
            turn[body] = turn[body] * Rotation.from_rotvec(angles[k] * joints.axes[k])
    count = len(look.bodies) + 1
    np.testing.assert_allclose(place, data.xpos[1:count], atol=1e-9)
    np.testing.assert_allclose(
        [each.as_matrix().ravel() for each in turn], data.xmat[1:count].reshape(-1, 9), atol=1e-9
    )
