"""The jump's law in plain NumPy: slow, obvious, what the tests compare the kernel with."""

import numpy as np

from locomotion.gaits.run import controller
from locomotion.skills.jump import kernel as jump
from locomotion.skills.kernel_reference import clip_offset, placed_actions
from locomotion.skills.learned_skill import LawTables

__all__ = ["wanted_offset"]


def wanted_offset(tables: LawTables, memory: np.ndarray, state: np.ndarray) -> tuple[np.ndarray, float]:
    """Offset (39,) [rad] of the PD targets before the filter, and the pace beta, in the present tick.

    ``memory`` holds the errors and the sensors (``jump.SENSED``) as the kernel has measured them.
    """
    p = {name: tables.parameters[part] for name, part in jump.parameter_slices().items()}
    knots, timing, difference, rate, reference, _, _ = tables.rest
    step = int(state[controller.STEPS] - memory[jump.FIRST_STEP])
    left, phase = state[controller.STANCE] > 0, state[controller.PHASE]
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

    result = placed_actions(bool(left), sagittal, lateral)
    if step in (1, 2):
        pace = beta / np.interp(state[controller.SPEED], knots, timing)
        result += p["alpha"][step - 1] * clip_offset(difference, rate, step, phase, pace, bool(left))
    return result, beta
