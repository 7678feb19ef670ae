"""Learned jumps on disk and in memory, and the jump as a skill that the body can use."""

import hashlib
import os
from functools import lru_cache
from typing import Literal

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.clips.clip import Clip, load_clip
from locomotion.data import CLIPS, SKILLS
from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import RunSkill
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.saved_arrays import COUNT, FLAG, Slots
from locomotion.skills.jump import kernel as jump
from locomotion.skills.jump.kernel import jump_tick, start_jump
from locomotion.skills.kernel import FIRST_STEP, LAST_STEP
from locomotion.skills.learned_skill import LawTables, LearnedSkill, tables_over_run
from locomotion.skills.skill_file import SkillFamily, load_family

__all__ = [
    "JUMP_CLIP", "JUMP_SKILL", "KIND", "Jump", "jump_clip", "load_jump_skill", "run_digest", "tables_of",
]  # fmt: skip

JUMP_CLIP = CLIPS / "jump.yaml"
JUMP_SKILL = SKILLS / "jump.npz"
KIND = "jump skill"
_SPEEDS = (2.5, 4.0)
"""Of run-ups [m/s]."""


@lru_cache(maxsize=1)
def jump_clip() -> Clip:
    """The reference clip that comes with the package."""
    return load_clip(JUMP_CLIP)


def tables_of(
    parameters: NDArray[np.float64], reference: NDArray[np.float64], run: RunSkill, clip: Clip | None = None
) -> LawTables:
    """Put the arguments of the kernels together; ``reference`` (4, 6, 15): expected sensors; ``clip``: None
    is the package's jump."""
    return tables_over_run(parameters, jump.parameter_slices(), reference, clip or jump_clip(), run)


def load_jump_skill(path: str | os.PathLike[str] = JUMP_SKILL, kind: str = KIND) -> SkillFamily:
    """Read learned jumps; `LocomotionError` if the file is missing, cut off, of another version, of another
    person or of another ``kind``."""
    width = sum(jump.PARAMETERS.values())
    return load_family(path, kind, width, (jump.STEPS * jump.BINS, jump.SENSORS))


def run_digest(run: RunSkill) -> str:
    """Hex digest of the running skill that a jump is learned on, as far as it runs straight on level
    ground at `_SPEEDS`."""
    hasher = hashlib.sha256()
    knots, parameters, *rest, _ = run.tables
    used = (knots >= _SPEEDS[0]) & (knots <= _SPEEDS[1])
    part = controller.parameter_slices()
    straight = parameters[used, : part["bend"].start]
    for name in (
        "turn", "climb", "descend", "climb_legs", "descend_legs", "climb_timing", "descend_timing",
    ):  # fmt: skip
        straight[:, part[name]] = 0.0
    for table in (knots[used], straight, *rest):
        # what rounding leaves differs among processors: no digits, and no signs of zeros, that it decides
        hasher.update((np.round(table, 6) + 0.0).tobytes())
    return hasher.hexdigest()[:16]


class Jump(LearnedSkill):
    """A jump as a `locomotion.skills.interface.ClearingSkill`, on top of a given run."""

    ends: Literal["running", "walking"] = "running"
    slots = Slots(
        "the jump of a person",
        jump.MEMORY_SIZE,
        [(jump.ACTIVE, FLAG), (FIRST_STEP, COUNT), (LAST_STEP, COUNT)],
        whole=(jump.ACTIVE, FIRST_STEP, LAST_STEP),
    )

    def __init__(
        self, skill: SkillFamily, run: RunSkill, affordance: str = "jump", clip: Clip | None = None
    ) -> None:
        """``skill``: the learned jumps; ``run``: the run under them; ``affordance``: what they clear;
        ``clip``: what they play, None for the package's jump onto a stair."""

        def law(size: float) -> LawTables:
            parameters, reference = skill.at(size)
            return tables_of(parameters, reference.reshape(jump.STEPS, jump.BINS, jump.SENSORS), run, clip)

        super().__init__(skill, law)
        self.affordance = affordance

    def start(self, obstacle: ObstacleAhead, state: NDArray[np.float64]) -> NDArray[np.float64]:
        """Begin a jump at a stance switch, before that tick's `tick`; gives all that it remembers, (k,)
        float64."""
        tables = self.tables(obstacle.size)
        memory = np.zeros(jump.MEMORY_SIZE)
        x, y = float(obstacle.position[0]), float(obstacle.position[1])
        ahead_x, ahead_y = -float(obstacle.normal[0]), -float(obstacle.normal[1])
        start_jump(tables.parameters, memory, state, x, y, ahead_x, ahead_y)
        return memory

    def tick(
        self,
        obstacle: ObstacleAhead,
        memory: NDArray[np.float64],
        state: NDArray[np.float64],
        data: mujoco.MjData,
    ) -> bool:
        """One control tick after `run_tick`'s and before the physics; True when the jump is over."""
        tables = self.tables(obstacle.size)
        jump_tick(tables.parameters, *tables.rest, memory, state, data.ctrl)
        return bool(memory[jump.ACTIVE] == 0.0)

    def fell(self, memory: NDArray[np.float64], state: NDArray[np.float64]) -> bool:
        """Whether the body has fallen: it jumps upright."""
        return bool(state[controller.FALLEN] > 0.0)
