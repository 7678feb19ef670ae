"""Slowing down from a run to a walk: the run's parameters at low speeds while it slows down, and how the walk
that catches it begins.

An ordinary run below 2.5 m/s crosses its legs: where a foot comes down, the centre of mass is outside of it,
and the walk would have to cross its legs, too. Hence slow running has parameters of its own here, that serve
only to slow down, and the runs of the skills above that stay as they are.
"""

import math
import os
from dataclasses import dataclass, field
from typing import Any, Self

import mujoco
import numpy as np
from pydantic import model_validator

from locomotion.body.learned_file import RELEARN, SkillHeader, learned_numbers, read_skill, speeds
from locomotion.body.person import PersonIndex, person_digest
from locomotion.data import SKILLS
from locomotion.gaits.run import controller
from locomotion.gaits.run.skill import RunSkill
from locomotion.gaits.walk.controller import observe_walk
from locomotion.gaits.walk.layout import CAUGHT, GAINS, LEVEL, WALK_SPEED, WALK_STANCE, gain_limits, new_walk
from locomotion.gaits.walk.skill import WalkSkill
from locomotion.gaits.walk.steps import begin_swing
from surefoot.files.archive import write_archive
from surefoot.files.schema import Array, Schema, Size

__all__ = [
    "SLOWING",
    "SLOW_DOWN_SKILL",
    "ChangesHeader",
    "SlowDownSkill",
    "can_walk_on",
    "changes",
    "load_slow_down_skill",
    "slowed_tables",
    "touchdown",
    "walk_on",
]  # fmt: skip

SLOW_DOWN_SKILL = SKILLS / "slow_down.npz"
SLOWING = 1.0
"""[m/s^2] by which the run's reference speed is lowered."""
_STEP_TIMES = (0.22, 0.5)  # [s] shortest and longest step of a slow run
_CATCHABLE, _WITHIN_REACH = 1.9, 0.45
# [m/s] at a touchdown below which a running person can walk on; [m] that its capture point is ahead of the
# foot at most, for it to do so when it is faster
_OMEGA = 3.3  # [1/s] of the capture point
_FIRST_STEPS = 4  # of the walk in which its gains become those of a walk on level ground


@dataclass(frozen=True, eq=False)
class SlowDownSkill:
    """How a running person comes to walk.

    Attributes:
        knots: (k,) float64, increasing speeds [m/s]; at the last and above it runs as always.
        change: (k, p) float64, what is added there to the parameters of the run
            (`run_layout.PARAMETERS`); zeros in the last row.
        gains: (len(GAINS),) float64, added to the walk's gains for level ground in its first step.
        meta: what made it.
    """

    knots: np.ndarray
    change: np.ndarray
    gains: np.ndarray
    meta: dict[str, Any] = field(default_factory=dict)

    def run_tables(self, run: RunSkill) -> tuple[np.ndarray, ...]:
        """The first arguments of `controller.run_tick` while slowing down from ``run``."""
        return slowed_tables(run, self.knots, self.change, self.knots[0])

    def walk_tables(self, walk: WalkSkill) -> tuple[np.ndarray, ...]:
        """``walk.tables`` for each of the first steps out of a run."""
        low, high = gain_limits()
        first = np.clip(walk.tables[LEVEL] + self.gains, low, high)
        result = []
        for step in range(_FIRST_STEPS):
            tables = walk.tables.copy()
            tables[LEVEL] += (1.0 - step / _FIRST_STEPS) * (first - tables[LEVEL])
            result.append(tables)
        return tuple(result)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the skill for the present person; the file appears whole or not at all."""
        header = {"person": person_digest(), "gains": list(GAINS), "meta": self.meta}
        arrays = {"knots": self.knots, "change": self.change, "gains": self.gains}
        write_archive(path, SLOW_DOWN_FILE.kind, SLOW_DOWN_FILE.version, header, arrays)


def slowed_tables(
    run: RunSkill, knots: np.ndarray, change: np.ndarray, slowest: float
) -> tuple[np.ndarray, ...]:
    """The first arguments of `controller.run_tick` for ``run`` with other parameters up to the last of
    ``knots`` (k,) [m/s]: ``change`` (k, p) is added to them; its reference speed is ``slowest`` at least."""
    above = run.knots > knots[-1]
    all_knots = np.concatenate([knots, run.knots[above]])
    table = np.stack([np.interp(all_knots, run.knots, column) for column in run.table.T], axis=1)
    table[: len(knots)] += change
    timing = controller.parameter_slices()["timing"].start
    table[:, timing] = np.clip(table[:, timing], *_STEP_TIMES)
    limits = np.array([slowest, run.speeds[1], run.max_lateral])
    return (all_knots, np.ascontiguousarray(table), *run.tables[2:-1], limits)


class ChangesHeader(SkillHeader):
    """Header of a skill that changes the run, and the walk after it."""

    gains: tuple[str, ...]

    @model_validator(mode="after")
    def _names_the_gains(self) -> Self:
        if self.gains != tuple(GAINS):
            raise ValueError(f"must name the {len(GAINS)} gains of this release")
        return self


def changes(*gains: Size) -> dict[str, Array]:
    """Arrays of such a skill; ``gains``: the shape of the walk's."""
    width = sum(controller.PARAMETERS.values())
    return {
        "knots": speeds("speeds"),
        "change": learned_numbers("speeds", width),
        "gains": learned_numbers(*gains),
    }


SLOW_DOWN_FILE = Schema("slow-down skill", 1, ChangesHeader, changes(len(GAINS)), RELEARN)


def load_slow_down_skill(path: str | os.PathLike[str] = SLOW_DOWN_SKILL) -> SlowDownSkill:
    """Read a slow-down skill; `LocomotionError` if it is missing, cut off, of another version or another
    person."""
    header, arrays = read_skill(path, SLOW_DOWN_FILE)
    return SlowDownSkill(**arrays, meta=header.meta)


def can_walk_on(state: np.ndarray) -> bool:
    """Whether a running person can go over to walking now: it has just put a foot down, and either it is slow
    or the foot is so far ahead that it will be. Another running step would brake too much then."""
    if state[controller.STEP_TIME] != 0.0:
        return False
    ahead, _, speed = touchdown(state)
    return speed < _CATCHABLE or ahead < _WITHIN_REACH


def touchdown(state: np.ndarray) -> tuple[float, float, float]:
    """Where the capture point of a running person is ahead and inside of the foot that has come down [m], and
    its speed [m/s]. ``state``: the running controller's."""
    heading, side = state[controller.HEADING], state[controller.STANCE]
    along = np.array([math.cos(heading), math.sin(heading)])
    inwards = side * np.array([math.sin(heading), -math.cos(heading)])
    foot = state[controller.FEET].reshape(2, 3)[1 if side > 0.0 else 0]
    velocity = state[controller.COM_VELOCITY][:2]
    capture = state[controller.COM][:2] + velocity / _OMEGA - foot[:2]
    return float(along @ capture), float(inwards @ capture), float(along @ velocity)


def walk_on(
    data: mujoco.MjData,
    index: PersonIndex,
    tables: np.ndarray,
    speed: float,
    state: np.ndarray,
    walk: np.ndarray,
) -> None:
    """Let the walking controller take over a running body that stands on one foot; ``state`` is the
    running controller's, ``walk`` is filled. tables (4, len(GAINS)): gains of its first step; speed: at
    which it walks at most [m/s]."""
    heading, (vx, vy) = float(state[controller.HEADING]), state[controller.COM_VELOCITY][:2]
    walk[:] = new_walk(heading)
    observe_walk(index, data, walk)
    walk[CAUGHT], walk[WALK_STANCE] = 1.0, state[controller.STANCE]
    walk[WALK_SPEED] = min(math.cos(heading) * vx + math.sin(heading) * vy, speed)
    begin_swing(tables[LEVEL], walk, data.qpos)
