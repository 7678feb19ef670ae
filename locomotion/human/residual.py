"""The residual policies of a person: networks that correct a planned gait while that is needed.

What they decide is added to its targets, as in T. Silver et al., "Residual policy learning", 2018.
"""

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.gaits.policy.layout import TICKS_PER_DECISION
from locomotion.gaits.residual.kernel import add_to, decide, observe
from locomotion.gaits.residual.layout import DECIDED, INPUTS, MEMORY_SIZE, SINCE
from locomotion.gaits.residual.skill import ResidualSkill

__all__ = ["Correction", "Residual"]

_FADES, _GONE = 0.9, 1e-3  # share that is left a tick after it is no longer needed; below this: nothing


class Correction:
    """What moves the targets of a gait. ``skill``: what decides; None: nothing does, or, in training, who
    writes into ``memory``. ``memory``: (MEMORY_SIZE,), all that has to be saved. ``observed``: (inputs,),
    what the next decision is made from."""

    def __init__(self, skill: ResidualSkill | None, inputs: int) -> None:
        self.skill = skill
        self.memory = np.zeros(MEMORY_SIZE)
        self.observed = np.zeros(inputs)

    @property
    def acts(self) -> bool:
        """Whether it moves the targets, if only while it fades."""
        return self.memory.item(SINCE) > 0.0

    def forget(self) -> None:
        """Something else moves the person now."""
        self.memory[:] = 0.0

    def move(self, needed: bool, data: mujoco.MjData) -> None:
        """Move the targets ``data.ctrl`` as was decided last; fade if that is no longer ``needed``."""
        memory = self.memory
        if needed:
            memory[SINCE] += 1.0
        elif self.acts:
            decided = memory[DECIDED]
            decided *= _FADES
            if np.abs(decided).max() < _GONE:
                self.forget()
        if self.acts:
            add_to(memory, data.ctrl)


class Residual(Correction):
    """The one that corrects braking; its `SINCE` counts ticks since it began."""

    def __init__(self, skill: ResidualSkill | None) -> None:
        super().__init__(skill, INPUTS)

    def observe(self, state: NDArray, walk: NDArray, data: mujoco.MjData) -> bool:
        """Read `observed`; gives whether it is the mirror image."""
        return observe(self.memory, state, walk, data.qpos, data.qvel, self.observed)

    def tick(self, needed: bool, state: NDArray, walk: NDArray, data: mujoco.MjData) -> None:
        """After the gait's tick: move its targets ``data.ctrl``."""
        if needed and self.skill is not None and self.memory[SINCE] % TICKS_PER_DECISION == 0.0:
            left = self.observe(state, walk, data)
            decide(self.skill.network, self.observed, left, self.memory)
        self.move(needed, data)
