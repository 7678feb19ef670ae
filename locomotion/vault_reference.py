"""The vault's law without its arm in plain NumPy: slow, obvious, what the tests compare the kernel with."""

import numpy as np

from locomotion import controller, vault
from locomotion.clearing_law import mirror
from locomotion.person import JOINT_NAMES
from locomotion.vault_skill import VaultTables

__all__ = ["wanted_offset"]


def wanted_offset(tables: VaultTables, memory: np.ndarray, state: np.ndarray) -> tuple[np.ndarray, float]:
    """Offset (39,) [rad] of the PD targets before the filter, and the pace beta, in the present tick.

    ``memory`` holds the phase, the errors and the sensors (``vault.SENSED``) as the kernel has measured them.
    """
    p = {name: tables.parameters[part] for name, part in vault.parameter_slices().items()}
    knots, timing, difference, rate, reference, _, _ = tables.rest
    step = int(state[controller.STEPS] - memory[vault.FIRST_STEP])
    left, phase = state[controller.STANCE] > 0, state[controller.PHASE]
    stance, swing = ("left", "right") if left else ("right", "left")
    errors = memory[[vault.ERROR_DISTANCE, vault.ERROR_SPEED]]

    def between(rows: np.ndarray) -> np.ndarray:
        places = np.linspace(0.0, 1.0, len(rows))
        return np.array([np.interp(phase, places, column) for column in rows.T])

    sagittal = between(p["a_hat"].reshape(vault.STEPS, vault.KNOTS, 6)[step])
    lateral = between(p["lateral"].reshape(vault.STEPS, 3, 6)[step])
    beta = p["beta"][step]
    if step < 3:
        gains = p["gains"].reshape(3, 2, 7)[step]
        sagittal += errors @ gains[:, :6]
        beta += errors @ gains[:, 6]
    m_sp = p["m_sp"].reshape(vault.PHASES, vault.RANK, vault.SENSORS)[int(memory[vault.PHASE])]
    latent = m_sp @ (memory[vault.SENSED] - between(reference[step]))
    feedback = p["m_ap"].reshape(9, vault.RANK) @ np.clip(latent, -1.0, 1.0)
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
        lead = 0.1 * 0.5 * beta / step_time if phase < 1.0 else 0.0
        share = 0.5 * (phase + step - 1)
        table, shares = difference + lead * rate, np.linspace(0, 1, len(difference))
        pose = np.array([np.interp(share, shares, column) for column in table.T])
        takes_off_left = left == (step == 1)
        result += p["alpha"][step - 1] * (mirror(pose) if takes_off_left else pose)
    return result, beta
