"""The torques of a swinging leg against MuJoCo's inverse dynamics of the whole person."""

import mujoco
import numpy as np

from locomotion.body.leg_dynamics import swing_torques
from locomotion.body.person import JOINT_NAMES, build_person

HIP, KNEE = (JOINT_NAMES.index(f"left_{name}_flexion") for name in ("hip", "knee"))


def test_swinging_a_leg_takes_what_inverse_dynamics_says():
    model = build_person()
    data = mujoco.MjData(model)
    rng = np.random.default_rng(0)
    for _ in range(50):
        mujoco.mj_resetData(model, data)
        data.qpos[2] = 3.0  # in the air
        pitch = rng.uniform(-0.3, 0.3)
        data.qpos[3:7] = np.cos(pitch / 2), 0.0, np.sin(pitch / 2), 0.0
        hip, knee = rng.uniform(-0.4, 1.0), rng.uniform(0.0, 1.4)
        data.qpos[7 + HIP], data.qpos[7 + KNEE] = hip, knee
        data.qvel[6 + HIP], data.qvel[6 + KNEE] = rates = rng.uniform(-5.0, 5.0, 2)
        data.qacc[6 + HIP], data.qacc[6 + KNEE] = changes = rng.uniform(-80.0, 80.0, 2)
        mujoco.mj_inverse(model, data)
        about_hip, about_knee = swing_torques(
            hip - pitch,
            hip - pitch - knee,
            rates[0],
            rates[0] - rates[1],
            changes[0],
            changes[0] - changes[1],
        )
        # flexion moves the thigh forward and the shank back; MuJoCo's joints have an inertia of their own
        own = model.dof_armature[[6 + HIP, 6 + KNEE]] * changes
        assert abs(data.qfrc_inverse[6 + HIP] - own[0] - about_hip) < 1e-9 * (1.0 + abs(about_hip))
        assert abs(data.qfrc_inverse[6 + KNEE] - own[1] + about_knee) < 1e-9 * (1.0 + abs(about_knee))
