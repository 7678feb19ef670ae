"""The vault's law without its arm in plain NumPy: slow, obvious, what the tests compare the kernel with."""

import numpy as np

from locomotion.gaits.run import controller
from locomotion.skills.kernel_reference import clip_offset, placed_actions
from locomotion.skills.learned_skill import LawTables
from locomotion.skills.vault import kernel as vault

__all__ = ["wanted_offset"]


def wanted_offset(tables: LawTables, memory: np.ndarray, state: np.ndarray) -> tuple[np.ndarray, float]:
    """Offset (39,) [rad] of the PD targets before the filter, and the pace beta, in the present tick.

    ``memory`` holds the phase, the errors and the sensors (``vault.SENSED``) as the kernel has measured them.
    """
    p = {name: tables.parameters[part] for name, part in vault.parameter_slices().items()}
    knots, timing, difference, rate, reference, _, _ = tables.rest
    step = int(state[controller.STEPS] - memory[vault.FIRST_STEP])
    left, phase = state[controller.STANCE] > 0, state[controller.PHASE]
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

    result = placed_actions(bool(left), sagittal, lateral)
    if step in (1, 2):
        pace = beta / np.interp(state[controller.SPEED], knots, timing)
        result += p["alpha"][step - 1] * clip_offset(difference, rate, step, phase, pace, bool(left))
    return result, beta
