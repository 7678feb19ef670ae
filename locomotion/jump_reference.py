"""The jump's law in plain NumPy: slow, obvious, what the tests compare the kernel with."""

import numpy as np

from locomotion import controller, jump
from locomotion.jump_skill import JumpTables
from locomotion.person import JOINT_NAMES

__all__ = ["wanted_offset"]


def wanted_offset(tables: JumpTables, memory: np.ndarray, state: np.ndarray) -> tuple[np.ndarray, float]:
    """Offset (39,) [rad] of the PD targets before the filter, and the pace beta, in the present tick.

    ``memory`` holds the errors and the sensors (``jump.SENSED``) as the kernel has measured them.
    """
    p = {name: tables.parameters[part] for name, part in jump.parameter_slices().items()}
    knots, timing, difference, rate, reference, _, _ = tables.rest
    step = int(state[controller.STEPS] - memory[jump.FIRST_STEP])
    left, phase = state[controller.STANCE] > 0, state[controller.PHASE]
    stance, swing = ("left", "right") if left else ("right", "left")
    errors = memory[[jump.ERROR_DISTANCE, jump.ERROR_SPEED]]

    a_hat = p["a_hat"].reshape(jump.STEPS, -1, 6)[step]
    sagittal = np.array([np.interp(phase, np.linspace(0, 1, len(a_hat)), column) for column in a_hat.T])
    lateral = p["lateral"].reshape(jump.STEPS, 6)[step].copy()
    beta = p["beta"][step]
    if step < 3:
        gains = p["gains"].reshape(3, 2, 7)[step]
        sagittal += errors @ gains[:, :6]
        beta += errors @ gains[:, 6]
    bins = np.linspace(0, 1, jump.BINS)
    expected = np.array([np.interp(phase, bins, column) for column in reference[step].T])
    latent = p["m_sp"].reshape(jump.RANK, jump.SENSORS) @ (memory[jump.SENSED] - expected)
    feedback = p["m_ap"].reshape(9, jump.RANK) @ np.clip(latent, -1.0, 1.0)
    sagittal[[0, 2, 5]] += feedback[[0, 3, 6]]
    lateral += feedback[[1, 2, 4, 5, 7, 8]]
    beta = float(np.clip(beta, 0.3, 2.0))

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
    result = np.array([offset[name] for name in JOINT_NAMES])
    if step in (1, 2):
        step_time = np.interp(state[controller.SPEED], knots, timing)
        share = 0.5 * (phase + step - 1)
        shares = np.linspace(0, 1, len(difference))
        lead = 0.1 * 0.5 * beta / step_time if phase < 1.0 else 0.0
        table = difference + lead * rate
        pose = np.array([np.interp(share, shares, column) for column in table.T])
        takes_off_left = left == (step == 1)
        result += p["alpha"][step - 1] * (jump.mirror(pose) if takes_off_left else pose)
    return result, beta
