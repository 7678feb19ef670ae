"""Learned drop-rolls, and the drop-roll as a skill that the body can use."""

import os
from dataclasses import replace
from functools import lru_cache
from typing import Literal

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.clips.clip import Clip, load_clip
from locomotion.data import CLIPS, SKILLS
from locomotion.gaits.run import controller
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.saved_arrays import COUNT, FLAG, SIDE, Slots
from locomotion.skills.drop_roll import kernel as drop_roll
from locomotion.skills.drop_roll.kernel import drop_roll_tick, start_drop_roll
from locomotion.skills.drop_roll.slippery import SlipperyRoll
from locomotion.skills.kernel import MIRROR, MIRROR_SIGN
from locomotion.skills.learned_skill import LawTables, LearnedSkill
from locomotion.skills.skill_file import SkillFamily, load_family

__all__ = [
    "DROP_ROLL_CLIP",
    "DROP_ROLL_SKILL",
    "KIND",
    "DropRoll",
    "drop_roll_clip",
    "load_drop_roll_skill",
    "tables_of",
]  # fmt: skip

DROP_ROLL_CLIP = CLIPS / "drop_roll.yaml"
DROP_ROLL_SKILL = SKILLS / "drop_roll.npz"
KIND = "drop-roll skill"
_SAMPLES = 201
_MARK = drop_roll.parameter_slices()["mark"].start


@lru_cache(maxsize=1)
def drop_roll_clip() -> Clip:
    """The reference clip that comes with the package."""
    return load_clip(DROP_ROLL_CLIP)


@lru_cache(maxsize=1)
def _poses() -> NDArray[np.float64]:
    return np.ascontiguousarray(drop_roll_clip().sample(np.linspace(0.0, 1.0, _SAMPLES)))


def tables_of(parameters: NDArray[np.float64], reference: NDArray[np.float64]) -> LawTables:
    """Put the arguments of the kernels together."""
    rest = (_poses(), reference, MIRROR, MIRROR_SIGN)
    return LawTables(parameters, float(parameters[_MARK + 1]), float(parameters[_MARK]), rest)


def load_drop_roll_skill(path: str | os.PathLike[str] = DROP_ROLL_SKILL) -> SkillFamily:
    """Read a drop-roll skill; `LocomotionError` if it is missing, cut off, of another version or of another
    person."""
    width = sum(drop_roll.PARAMETERS.values())
    return load_family(path, KIND, width, (drop_roll.BINS, len(drop_roll.SENSORS)))


class DropRoll(LearnedSkill):
    """Rolling off drops as a `locomotion.skills.interface.ClearingSkill`."""

    affordance = "drop"
    ends: Literal["running", "walking"] = "walking"
    over_run = False
    slots = Slots(
        "the roll of a person",
        drop_roll.MEMORY_SIZE,
        [
            (drop_roll.ACTIVE, FLAG),
            (drop_roll.PHASE, (drop_roll.TAKE_OFF, drop_roll.RISE)),
            (drop_roll.SHARE, FLAG),
            (drop_roll.SIDE, SIDE),
            (drop_roll.PHASE_TICKS, COUNT),
            (drop_roll.ENDED, FLAG),
            (drop_roll.SLIPPERY, FLAG),
        ],
        whole=(drop_roll.ACTIVE, drop_roll.PHASE, drop_roll.ENDED),
    )

    def __init__(self, skill: SkillFamily, slippery: SlipperyRoll | None = None) -> None:
        """``skill``: the learned drop-rolls. ``slippery``: how they change on slippery ground; None: they
        do not."""
        super().__init__(skill, lambda height: tables_of(*skill.at(height)))
        self._slippery = slippery
        self._changed: dict[tuple[float, float], LawTables] = {}

    def _tables_on(self, height: float, share: float) -> LawTables:
        """`tables` with a ``share`` of the change on slippery ground."""
        usual = self.tables(height)
        if self._slippery is None or share == 0.0:
            return usual
        if (height, share) not in self._changed:
            parameters = self._slippery.parameters(usual.parameters, share)
            self._changed[height, share] = replace(usual, parameters=parameters)
        return self._changed[height, share]

    def start(self, obstacle: ObstacleAhead, state: NDArray[np.float64]) -> NDArray[np.float64]:
        """Begin at a stance switch, before that tick's `tick`; gives all that it remembers, (k,) float64. Who
        takes off with the left foot rolls over the right shoulder."""
        memory = np.zeros(drop_roll.MEMORY_SIZE)
        side = 1.0 if state[controller.STANCE] > 0 else -1.0
        x, y, z = (float(v) for v in obstacle.position)
        ahead_x, ahead_y = -float(obstacle.normal[0]), -float(obstacle.normal[1])
        start_drop_roll(memory, side, z - obstacle.height, x, y, ahead_x, ahead_y)
        if self._slippery is not None:
            memory[drop_roll.SLIPPERY] = self._slippery.share(obstacle.friction)
        return memory

    def tick(
        self,
        obstacle: ObstacleAhead,
        memory: NDArray[np.float64],
        state: NDArray[np.float64],
        data: mujoco.MjData,
    ) -> bool:
        """One control tick after `run_tick`'s and before the physics; True when the feet carry it again."""
        tables = self._tables_on(obstacle.height, float(memory[drop_roll.SLIPPERY]))
        drop_roll_tick(tables.parameters, *tables.rest, memory, state, data.qpos, data.qvel, data.ctrl)
        return bool(memory[drop_roll.ENDED] > 0.0)

    def fell(self, memory: NDArray[np.float64], state: NDArray[np.float64]) -> bool:
        """Whether the body has fallen: from the take-off until it is over it may lie on the ground."""
        rolls = memory[drop_roll.ACTIVE] > 0.0 and memory[drop_roll.PHASE] != drop_roll.TAKE_OFF
        return bool(state[controller.FALLEN] > 0.0 and not rolls)
