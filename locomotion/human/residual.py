"""The residual policy of a person: a network that corrects a planned gait while it is needed.

What it decides is added to the targets of the gait, as in T. Silver et al., "Residual policy learning", 2018.
"""

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.gaits.policy.layout import TICKS_PER_DECISION
from locomotion.gaits.residual.kernel import add_to, decide, observe
from locomotion.gaits.residual.layout import DECIDED, INPUTS, MEMORY_SIZE, SINCE
from locomotion.gaits.residual.skill import ResidualSkill

__all__ = ["Residual"]

_FADES, _GONE = 0.9, 1e-3  # share that is left a tick after it is no longer needed; below this: nothing


class Residual:
    """``skill``: what decides; None: nothing does, or, in training, who writes into ``memory``. ``memory``:
    (MEMORY_SIZE,), all that has to be saved."""

    def __init__(self, skill: ResidualSkill | None) -> None:
        self.skill = skill
        self.memory = np.zeros(MEMORY_SIZE)
        self.observed = np.zeros(INPUTS)

    @property
    def acts(self) -> bool:
        """Whether it moves the targets, if only while it fades."""
        return bool(self.memory[SINCE] > 0.0)

    def forget(self) -> None:
        """Something else moves the person now."""
        self.memory[:] = 0.0

    def observe(self, state: NDArray, walk: NDArray, data: mujoco.MjData) -> bool:
        """Read `observed`; gives whether it is the mirror image."""
        return observe(self.memory, state, walk, data.qpos, data.qvel, self.observed)

    def tick(self, needed: bool, state: NDArray, walk: NDArray, data: mujoco.MjData) -> None:
        """After the gait's tick: move its targets ``data.ctrl``."""
        memory = self.memory
        if needed:
            if self.skill is not None and memory[SINCE] % TICKS_PER_DECISION == 0.0:
                left = self.observe(state, walk, data)
                decide(self.skill.network, self.observed, left, memory)
            memory[SINCE] += 1.0
        elif self.acts:
            decided = memory[DECIDED]
            decided *= _FADES
            if np.abs(decided).max() < _GONE:
                self.forget()
        if self.acts:
            add_to(memory, data.ctrl)
