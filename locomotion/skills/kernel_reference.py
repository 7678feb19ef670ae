"""`locomotion.skills.kernel` in plain NumPy: slow, obvious, what the tests compare the kernels with."""

import numpy as np

from locomotion.body.person import JOINT_NAMES
from locomotion.skills.kernel import mirror

__all__ = ["clip_offset", "placed_actions"]


def placed_actions(left: bool, sagittal: np.ndarray, lateral: np.ndarray) -> np.ndarray:
    """Sagittal and lateral actions (6,) on their joints, (39,); ``left``: on the left foot."""
    stance, swing = ("left", "right") if left else ("right", "left")
    offset = dict.fromkeys(JOINT_NAMES, 0.0)
    offset[f"{swing}_hip_flexion"] += sagittal[0]
    offset[f"{swing}_knee_flexion"] += sagittal[1]
    offset[f"{stance}_hip_flexion"] += sagittal[2]
    offset[f"{stance}_knee_flexion"] += sagittal[3]
    offset[f"{stance}_ankle_flexion"] += sagittal[4]
    offset[f"{swing}_hip_abduction"] += lateral[0]
    offset[f"{swing}_hip_rotation"] += lateral[1]
    offset[f"{stance}_hip_abduction"] += lateral[2]
    offset[f"{stance}_hip_rotation"] += lateral[3]
    for part in ("waist", "chest"):
        offset[f"{part}_pitch"] += sagittal[5]
        offset[f"{part}_roll"] += lateral[4] * (-1.0 if left else 1.0)
        offset[f"{part}_yaw"] += lateral[5] * (-1.0 if left else 1.0)
    return np.array([offset[name] for name in JOINT_NAMES])


def clip_offset(
    difference: np.ndarray, rate: np.ndarray, step: int, phase: float, pace: float, left: bool
) -> np.ndarray:
    """The clip less the run's (n, 39) in ``step`` 1 or 2 after the take-off, (39,); ``pace``: steps per
    second."""
    lead = 0.1 * 0.5 * pace if phase < 1.0 else 0.0
    table, shares = difference + lead * rate, np.linspace(0, 1, len(difference))
    pose = np.array([np.interp(0.5 * (phase + step - 1), shares, column) for column in table.T])
    takes_off_left = left == (step == 1)
    return mirror(pose) if takes_off_left else pose
