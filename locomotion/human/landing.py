"""The residual policy behind an obstacle: a network that corrects the landing and the first steps of the
recovery, on top of the skill, the run and the walk.

It begins with the first contact after the flight, or where a roll ends, and fades after `LASTS`. It acts
behind the package's skills, which it was learned on.
"""

from collections.abc import Callable

import mujoco
from numpy.typing import NDArray

from locomotion.gaits.policy.layout import TICKS_PER_DECISION
from locomotion.gaits.residual.kernel import decide, observe
from locomotion.gaits.residual.layout import CLEARS, CROSSING, LANDED, LANDING_INPUTS, SINCE
from locomotion.gaits.residual.skill import ResidualSkill
from locomotion.gaits.run.layout import CONTACT
from locomotion.human.residual import Correction
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.library import comes_with_package
from locomotion.skills.run_up import RunUp
from locomotion.skills.run_up_layout import NEXT
from navmesh.obstacles.kinds import CROSSINGS, kind_of

__all__ = ["LASTS", "NEVER", "Landing"]

LASTS = 250
"""Ticks for which it acts."""
_FLIES = 12  # ticks without a contact that are a flight
NEVER = -1e6
"""`SINCE` while a skill is at work behind which it does not act."""


class Landing(Correction):
    """``behind``: tells behind which clearing skills it acts. Its `SINCE` counts ticks of a flight down from
    0, and ticks since the landing up from it, to ``LASTS + 1``."""

    def __init__(self, skill: ResidualSkill | None) -> None:
        super().__init__(skill, LANDING_INPUTS)
        self.behind: Callable[[ClearingSkill], bool] = comes_with_package

    @property
    def decides(self) -> bool:
        """Whether it is still to decide."""
        return bool(0.0 < self.memory[SINCE] <= LASTS)

    def takes_off(self, skill: ClearingSkill) -> None:
        """``skill`` has begun."""
        self.forget()
        if not self.behind(skill):
            self.memory[SINCE] = NEVER

    def cleared(self) -> None:
        """A skill has ended."""
        if not self.acts:
            self.memory[SINCE] = 0.0 if self.memory[SINCE] == NEVER else 1.0

    def observe(self, run_up: RunUp, state: NDArray, walk: NDArray, data: mujoco.MjData) -> bool:
        """Read `observed`; gives whether it is the mirror image."""
        out = self.observed
        left = observe(self.memory, state, walk, data.qpos, data.qvel, out)
        out[LANDED], out[CLEARS] = self.memory[SINCE] / LASTS, run_up.clearing
        out[CROSSING] = 0.0
        obstacle = _behind(run_up)
        if obstacle is not None:
            out[CROSSING.start + CROSSINGS.index(kind_of(obstacle.affordance).crossing)] = 1.0
        return left

    def tick(self, run_up: RunUp, needed: bool, state: NDArray, walk: NDArray, data: mujoco.MjData) -> None:
        """After the ticks of gait and skill: move their targets ``data.ctrl``. ``needed``: nothing else
        corrects them."""
        memory = self.memory
        if not self.acts:
            self._look_for_landing(run_up, state)
            if not self.acts:
                return
        needed = needed and self.decides
        if needed and self.skill is not None and (memory[SINCE] - 1.0) % TICKS_PER_DECISION == 0.0:
            left = self.observe(run_up, state, walk, data)
            decide(self.skill.network, self.observed, left, memory)
        self.move(needed, data)

    def _look_for_landing(self, run_up: RunUp, state: NDArray) -> None:
        memory = self.memory
        if not run_up.clearing:
            memory[SINCE] = 0.0  # nothing will be cleared if it was sent elsewhere in mid-air
        elif memory[SINCE] == NEVER:
            return
        elif state[CONTACT].sum() <= 0.0:
            memory[SINCE] -= 1.0
        else:
            flew = memory[SINCE] <= -_FLIES and run_up.skill.ends == "running"
            memory[SINCE] = 1.0 if flew else 0.0


def _behind(run_up: RunUp) -> ObstacleAhead | None:
    """The obstacle that is being cleared, or was cleared last."""
    if run_up.clearing:
        return run_up.ahead
    number = int(run_up.plan[NEXT]) - 1
    return run_up.obstacles[number] if 0 <= number < len(run_up.obstacles) else None
