"""A policy on the whole figure, on a plane, for trials and measures."""

from collections.abc import Callable

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.models import person_on
from locomotion.body.person import CONTROL_DT, STEPS_PER_TICK
from locomotion.body.traits import by_hand
from locomotion.gaits.policy.kernel import Parts, decide_tick, feel, new_memory
from locomotion.gaits.policy.layout import FELT_SIZE, STYLE, TICKS_PER_DECISION
from locomotion.gaits.policy.skill import PolicySkill
from locomotion.gaits.policy.stand import stand_still
from locomotion.gaits.policy.style import style_of

__all__ = ["PolicyTrial"]

_FALLEN = 0.6  # [m] height of the root
_PUSH_TIME = 0.1  # [s]


class PolicyTrial:
    """A person who stands at the origin, facing along x, and then does as asked.

    Attributes:
      model, data: MuJoCo's. memory, felt: as in `locomotion.gaits.policy.kernel`. asked: (2,) speed [m/s] and
      turn rate [rad/s]. ticks: done so far.
    """

    def __init__(self, skill: PolicySkill, traits: NDArray[np.float64] | None = None) -> None:
        """``traits``: of the person, a row of `locomotion.body.traits`; None: the usual ones."""
        self.skill = skill
        self.model, index = person_on(None)
        self.data, self.ticks = mujoco.MjData(self.model), 0
        self.parts = Parts(index, self.model)
        self.memory, self.felt, self.asked = new_memory(0.0), np.zeros(FELT_SIZE), np.zeros(2)
        self._waist = self.model.body("waist").id
        self._push_ends = 0
        style = style_of(by_hand() if traits is None else traits)
        self.memory[STYLE] = style
        stand_still(self.model, self.data, self.parts, skill.motion, np.zeros(3), 0.0, self.felt, style)

    @property
    def fallen(self) -> bool:
        """Whether the person lies."""
        return bool(self.data.qpos[2] < _FALLEN)

    def push(self, force: float, angle: float) -> None:
        """Push the waist with ``force`` [N] towards ``angle`` [rad] for 0.1 s, from the next tick on."""
        self.data.xfrc_applied[self._waist, :2] = force * np.cos(angle), force * np.sin(angle)
        self._push_ends = self.ticks + round(_PUSH_TIME / CONTROL_DT)

    def tick(self, on_step: Callable[[], None] | None = None) -> None:
        """One control tick; ``on_step`` is called after each physics step."""
        data = self.data
        if self.ticks == self._push_ends:
            data.xfrc_applied[self._waist] = 0.0
        if self.ticks % TICKS_PER_DECISION == 0:
            decide_tick(
                *self.skill.tables, self.memory, self.asked, self.felt, data.qpos, data.qvel, data.ctrl
            )
        if on_step is None:
            mujoco.mj_step(self.model, data, STEPS_PER_TICK)
        else:
            for _ in range(STEPS_PER_TICK):
                mujoco.mj_step(self.model, data)
                on_step()
        feel(self.parts, data, self.felt)
        self.ticks += 1

    def go(self, seconds: float, on_step: Callable[[], None] | None = None) -> bool:
        """Go on for so long; gives whether the person still stands."""
        for _ in range(round(seconds / CONTROL_DT)):
            self.tick(on_step)
            if self.fallen:
                return False
        return True

    def place(self) -> NDArray[np.float64]:
        """Where the root is over the ground, (2,) [m]."""
        return self.data.qpos[:2].copy()
