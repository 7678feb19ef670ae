"""Learned jumps on disk and in memory, and the jump as a skill that the body can use."""

import hashlib
import math
import os
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion import controller, jump
from locomotion.clip import Clip, load_clip
from locomotion.errors import LocomotionError
from locomotion.jump import jump_tick, start_jump
from locomotion.learned_skill import LawTables, LearnedSkill
from locomotion.person import person_digest
from locomotion.route_smoothing import ObstacleAhead
from locomotion.skill import RunSkill
from locomotion.skill_family import smoothest
from locomotion.skill_file import read_skill
from navmesh.archive import write_archive

__all__ = [
    "JUMP_CLIP", "JUMP_SKILL", "Jump", "JumpSkill", "clip_less_run", "jump_clip",
    "load_jump_skill", "run_digest", "tables_of",
]  # fmt: skip

JUMP_CLIP = Path(__file__).parent / "clips" / "jump.yaml"
JUMP_SKILL = Path(__file__).parent / "skills" / "jump.npz"
_KIND, _VERSION = "jump skill", 1
_TIMING = controller.parameter_slices()["timing"].start
_MARK = jump.parameter_slices()["marks"].start


@lru_cache(maxsize=1)
def jump_clip() -> Clip:
    """The reference clip that comes with the package."""
    return load_clip(JUMP_CLIP)


@lru_cache(maxsize=4)
def clip_less_run(run: Clip, clip: Clip) -> tuple[np.ndarray, np.ndarray]:
    """A skill's clip less the run's over one cycle, (65, 39) [rad], and its rate per cycle."""
    shares = np.linspace(0.0, 1.0, 65)
    pose = clip.sample(shares) - run.sample(shares)
    rates = clip.rates(shares) * clip.duration - run.rates(shares) * run.duration
    return np.ascontiguousarray(pose), np.ascontiguousarray(rates)


@dataclass(frozen=True)
class JumpSkill:
    """A family of jumps over the height of the stair.

    Attributes:
        heights: (k,) float64, increasing heights [m] at which parameters were learned.
        table: (k, 241) float64, their parameters in the order of `jump.PARAMETERS`.
        entries: (k,) float64, entry speeds v_in [m/s].
        references: (k, 4, 6, 15) float64, expected sensors over the steps.
        stride: (a, lag, b) of the steps of the run-up, see `locomotion.clearing.ClearingSkill.stride`.
        run: digest of the running skill that it was learned on.
        meta: what made it.
    """

    heights: np.ndarray
    table: np.ndarray
    entries: np.ndarray
    references: np.ndarray
    stride: tuple[float, float, float]
    run: str
    meta: dict[str, Any] = field(default_factory=dict)

    @property
    def range(self) -> tuple[float, float]:
        """Lowest and highest stair [m] that may be jumped."""
        return float(self.heights[0]), float(self.heights[-1])

    def at(self, height: float, run: RunSkill) -> LawTables:
        """The jump onto a stair of ``height`` [m]; `LocomotionError` outside of `range` (2 cm are let
        pass)."""
        low, high = self.range
        if not (math.isfinite(height) and low - 0.02 <= height <= high + 0.02):
            raise LocomotionError(
                f"a jump of {height} m was not learned; heights from {low:g} to {high:g} m are"
            )
        flat = np.concatenate(
            [self.table, self.entries[:, None], self.references.reshape(len(self.heights), -1)], 1
        )
        values = smoothest(self.heights, flat, min(max(height, low), high))
        width = self.table.shape[1]
        reference = np.ascontiguousarray(values[width + 1 :].reshape(jump.STEPS, jump.BINS, jump.SENSORS))
        parameters = np.ascontiguousarray(values[:width])
        return tables_of(parameters, float(values[width]), reference, run)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the skill for the present person; the file appears whole or not at all."""
        header = {"person": person_digest(), "run": self.run, "stride": list(self.stride), "meta": self.meta}
        arrays = {
            "heights": self.heights, "table": self.table, "entries": self.entries, "references":
            self.references,
        }  # fmt: skip
        write_archive(path, _KIND, _VERSION, header, arrays)


def tables_of(parameters: np.ndarray, entry: float, reference: np.ndarray, run: RunSkill) -> LawTables:
    """Put the arguments of the kernels together."""
    timing = np.ascontiguousarray(run.table[:, _TIMING])
    pose, rates = clip_less_run(run.clip, jump_clip())
    rest = (np.ascontiguousarray(run.knots), timing, pose, rates, reference, jump.MIRROR, jump.MIRROR_SIGN)
    return LawTables(parameters, entry, float(parameters[_MARK]), rest)


def load_jump_skill(path: str | os.PathLike[str] = JUMP_SKILL) -> JumpSkill:
    """Read a jump skill; `LocomotionError` if it is missing, cut off, of another version or of another
    person."""
    header, arrays = read_skill(path, _KIND, _VERSION)
    try:
        heights, table, entries = arrays["heights"], arrays["table"], arrays["entries"]
        references = arrays["references"]
        a, lag, b = (float(x) for x in header["stride"])
    except (KeyError, TypeError, ValueError) as error:
        raise LocomotionError(f"{path}: not a whole jump skill: {error}") from error
    k, width = len(heights), sum(jump.PARAMETERS.values())
    shapes = (table.shape, entries.shape, references.shape)
    if k == 0 or shapes != ((k, width), (k,), (k, jump.STEPS, jump.BINS, jump.SENSORS)):
        raise LocomotionError(
            f"{path}: arrays of shapes {shapes} do not fit {k} heights of {width} parameters"
        )
    finite = all(np.isfinite(a).all() for a in (heights, table, entries, references))
    if not finite or (np.diff(heights) <= 0).any():
        raise LocomotionError(f"{path}: holds numbers that are not finite or heights that do not grow")
    return JumpSkill(
        heights, table, entries, references, (a, lag, b), str(header.get("run", "")), header.get("meta", {})
    )


def run_digest(run: RunSkill) -> str:
    """Hex digest of the running skill that a jump is learned on, as far as it runs straight on level
    ground."""
    hasher = hashlib.sha256()
    knots, parameters, *rest, _ = run.tables
    part = controller.parameter_slices()
    straight = parameters[1:, : part["bend"].start].copy()  # the first row only serves setting off
    for name in (
        "turn", "climb", "descend", "start", "climb_legs", "descend_legs", "climb_timing", "descend_timing",
    ):  # fmt: skip
        straight[:, part[name]] = 0.0
    for table in (knots, straight, *rest):
        hasher.update(np.round(table, 9).tobytes())
    return hasher.hexdigest()[:16]


class Jump(LearnedSkill):
    """Jumping onto stairs as a `locomotion.clearing.ClearingSkill`, on top of a given run."""

    affordance = "jump"
    ends: Literal["running", "walking"] = "running"

    def __init__(self, skill: JumpSkill, run: RunSkill) -> None:
        """``skill``: the learned jumps; ``run``: the run under them."""
        super().__init__(skill, lambda height: skill.at(height, run))

    def start(self, obstacle: ObstacleAhead, state: NDArray[np.float64]) -> NDArray[np.float64]:
        """Begin a jump at a stance switch, before that tick's `tick`; gives all that it remembers, (k,)
        float64."""
        tables = self.tables(obstacle.height)
        memory = np.zeros(jump.MEMORY_SIZE)
        x, y = float(obstacle.position[0]), float(obstacle.position[1])
        ahead_x, ahead_y = -float(obstacle.normal[0]), -float(obstacle.normal[1])
        start_jump(tables.parameters, memory, state, tables.entry, x, y, ahead_x, ahead_y)
        return memory

    def tick(
        self,
        obstacle: ObstacleAhead,
        memory: NDArray[np.float64],
        state: NDArray[np.float64],
        data: mujoco.MjData,
    ) -> bool:
        """One control tick after `run_tick`'s and before the physics; True when the jump is over."""
        tables = self.tables(obstacle.height)
        jump_tick(tables.parameters, *tables.rest, memory, state, data.ctrl)
        return bool(memory[jump.ACTIVE] == 0.0)

    def fell(self, memory: NDArray[np.float64], state: NDArray[np.float64]) -> bool:
        """Whether the body has fallen: it jumps upright."""
        return bool(state[controller.FALLEN] > 0.0)
