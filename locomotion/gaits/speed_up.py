"""Speeding up from a walk to a run in a few steps: the run's parameters while it does.

The run itself gains some 0.3 m/s a step, which is 8 m from a stand to 3.1 m/s: more than there is between
many obstacles. While it speeds up it has parameters of its own here, so that the run, and the skills on top
of it, stay as they are.
"""

import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from locomotion.body.learned_file import RELEARN, SkillHeader, learned_numbers, read_skill, speeds
from locomotion.body.person import person_digest
from locomotion.data import SKILLS
from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import RunSkill
from surefoot.files.archive import write_archive
from surefoot.files.schema import Schema

__all__ = ["HASTE", "SPEED_UP_SKILL", "SpeedUpSkill", "is_fast_enough", "load_speed_up_skill"]

SPEED_UP_SKILL = SKILLS / "speed_up.npz"
HASTE = 2.0
"""[m/s] by which the speed asked for may exceed the last step's while it speeds up."""
_SHORT = 0.25  # [m/s] below the speed asked for at which it goes over to the run
_STEP_TIMES = (0.22, 0.5)  # [s] shortest and longest step


@dataclass(frozen=True, eq=False)
class SpeedUpSkill:
    """How a person that has begun to run comes to its speed.

    Attributes:
        knots: (k,) float64, increasing speeds [m/s].
        change: (k, p) float64, what is added there to the parameters of the run
            (`run_layout.PARAMETERS`).
        meta: what made it.
    """

    knots: np.ndarray
    change: np.ndarray
    meta: dict[str, Any] = field(default_factory=dict)

    def run_tables(self, run: RunSkill) -> tuple[np.ndarray, ...]:
        """The first arguments of `controller.run_tick` while speeding up to ``run``."""
        knots = np.union1d(self.knots, run.knots)
        table = np.stack(
            [
                np.interp(knots, run.knots, its) + np.interp(knots, self.knots, change)
                for its, change in zip(run.table.T, self.change.T, strict=True)
            ],
            axis=1,
        )
        timing = controller.parameter_slices()["timing"].start
        table[:, timing] = np.clip(table[:, timing], *_STEP_TIMES)
        return (knots, np.ascontiguousarray(table), *run.tables[2:])

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the skill for the present person; the file appears whole or not at all."""
        header = {"person": person_digest(), "meta": self.meta}
        arrays = {"knots": self.knots, "change": self.change}
        write_archive(path, SPEED_UP_FILE.kind, SPEED_UP_FILE.version, header, arrays)


SPEED_UP_FILE = Schema(
    kind="speed-up skill",
    version=1,
    header=SkillHeader,
    arrays={
        "knots": speeds("speeds"),
        "change": learned_numbers("speeds", sum(controller.PARAMETERS.values())),
    },
    remedy=RELEARN,
)


def load_speed_up_skill(path: str | os.PathLike[str] = SPEED_UP_SKILL) -> SpeedUpSkill:
    """Read a speed-up skill; `LocomotionError` if it is missing, cut off, of another version or another
    person."""
    header, arrays = read_skill(path, SPEED_UP_FILE)
    return SpeedUpSkill(**arrays, meta=header.meta)


def is_fast_enough(state: np.ndarray, wanted: float) -> bool:
    """Whether a person that speeds up to ``wanted`` [m/s] can go over to its run: at a stance switch, when
    its last step was fast enough."""
    return state[controller.STEP_TIME] == 0.0 and bool(state[controller.STEP_SPEED] > wanted - _SHORT)
