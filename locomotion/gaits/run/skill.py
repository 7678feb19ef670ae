"""Learned running on disk and in memory, and the poses from which it starts."""

import os
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Annotated, Any, Self

import mujoco
import numpy as np
from annotated_types import Ge, Gt, Le
from pydantic import model_validator

from locomotion.body.learned_file import RELEARN, SkillHeader, learned_numbers, read_skill, speeds
from locomotion.body.person import JOINT_NAMES, STANDING_HEIGHT, PersonIndex, person_digest
from locomotion.clips.clip import Clip, load_clip
from locomotion.data import CLIPS, SKILLS
from locomotion.gaits.run import controller
from surefoot.files.archive import write_archive
from surefoot.files.schema import Schema

__all__ = [
    "RUN_CLIP",
    "RUN_SKILL",
    "RunSkill",
    "load_run_skill",
    "reset_running",
    "run_clip",
    "run_on",
]

RUN_CLIP = CLIPS / "run.yaml"
RUN_SKILL = SKILLS / "run.npz"
_SAMPLES = 64


@lru_cache(maxsize=4)
def _clip_tables(clip: Clip) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Samples of a cycle (n, 39), their rates per cycle (n, 39) and the mean (39,) of a clip."""
    shares = np.arange(_SAMPLES) / _SAMPLES
    reference = clip.sample(shares)
    return reference, clip.rates(shares) * clip.duration, reference.mean(axis=0)


@lru_cache(maxsize=4)
def run_clip() -> Clip:
    """The reference clip that comes with the package."""
    return load_clip(RUN_CLIP)


@dataclass(frozen=True, eq=False)
class RunSkill:
    """A family of running controllers over speed.

    Attributes:
        knots: (k,) float64, increasing speeds [m/s] at which parameters were learned.
        table: (k, p) float64, their parameters in the order of `controller.PARAMETERS`.
        state_reference: (b, 12) float64, reference sensors over a step (vx relative to the speed, dx per
        speed).
        speeds: lowest and highest speed [m/s] that may be asked for.
        max_lateral: highest lateral acceleration [m/s^2]; the reference heading turns at up to max_lateral
        / speed.
        step_length: (a, b) of step length = a * speed + b [m], fitted to this skill.
        clip: the reference motion.
        meta: what made it.
    """

    knots: np.ndarray
    table: np.ndarray
    state_reference: np.ndarray
    speeds: tuple[float, float]
    max_lateral: float
    step_length: tuple[float, float]
    clip: Clip
    meta: dict[str, Any] = field(default_factory=dict)
    tables: tuple[np.ndarray, ...] = field(init=False)
    """The first arguments of `controller.run_tick`."""

    def __post_init__(self) -> None:
        limits = np.array([*self.speeds, self.max_lateral])
        tables = (self.knots, self.table, *_clip_tables(self.clip), self.state_reference, limits)
        object.__setattr__(self, "tables", tuple(np.ascontiguousarray(t, dtype=np.float64) for t in tables))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the skill for the present person; the file appears whole or not at all."""
        header = {
            "person": person_digest(),
            "max_lateral": self.max_lateral,
            "speeds": list(self.speeds),
            "step_length": list(self.step_length),
            "meta": self.meta,
        }
        arrays = {"knots": self.knots, "table": self.table, "state_reference": self.state_reference}
        write_archive(path, RUN_FILE.kind, RUN_FILE.version, header, arrays)


class _RunHeader(SkillHeader):
    max_lateral: Annotated[float, Gt(0.0), Le(100.0)]
    speeds: tuple[Annotated[float, Ge(0.0)], Annotated[float, Le(20.0)]]
    step_length: tuple[float, float]

    @model_validator(mode="after")
    def _has_speeds(self) -> Self:
        if self.speeds[0] >= self.speeds[1]:
            raise ValueError("the lowest speed must be below the highest")
        return self


RUN_FILE = Schema(
    kind="run skill",
    version=1,
    header=_RunHeader,
    arrays={
        "knots": speeds("speeds"),
        "table": learned_numbers("speeds", sum(controller.PARAMETERS.values())),
        "state_reference": learned_numbers(9, len(controller.SENSORS)),
    },
    remedy=RELEARN,
)


def load_run_skill(path: str | os.PathLike[str] = RUN_SKILL) -> RunSkill:
    """Read a run skill; `LocomotionError` if it is missing, cut off, of another version or of another
    person."""
    header, arrays = read_skill(path, RUN_FILE)
    return RunSkill(
        **arrays, speeds=header.speeds, max_lateral=header.max_lateral, step_length=header.step_length,
        clip=run_clip(), meta=header.meta,
    )  # fmt: skip


def _place(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    index: PersonIndex,
    pose: np.ndarray,
    position: np.ndarray,
    yaw: float,
    pitch: float,
) -> None:
    """Put the person with joint angles ``pose`` on the ground point ``position``: its lowest foot touches
    it."""
    data.qpos[:3] = [position[0], position[1], position[2] + STANDING_HEIGHT]
    half_yaw, half_pitch = 0.5 * yaw, 0.5 * pitch
    cy, sy, cp, sp = np.cos(half_yaw), np.sin(half_yaw), np.cos(half_pitch), np.sin(half_pitch)
    data.qpos[3:7] = [cy * cp, -sy * sp, cy * sp, sy * cp]
    data.qpos[7 : 7 + len(JOINT_NAMES)] = pose
    data.qvel[:] = 0.0
    mujoco.mj_kinematics(model, data)
    lowest = np.inf
    for geom in np.flatnonzero(index.geom_side):
        if model.geom_conaffinity[geom]:
            axis = data.geom_xmat[geom].reshape(3, 3)[:, 2]
            reach = abs(axis[2]) * model.geom_size[geom, 1] + model.geom_size[geom, 0]
            lowest = min(lowest, data.geom_xpos[geom, 2] - reach)
    data.qpos[2] += position[2] - lowest


def reset_running(
    skill: RunSkill,
    model: mujoco.MjModel,
    data: mujoco.MjData,
    index: PersonIndex,
    state: np.ndarray,
    position: np.ndarray,
    yaw: float,
    speed: float,
) -> None:
    """Put the person on the ground point ``position`` (3,), running at ``speed`` [m/s]; fills ``state``."""
    mujoco.mj_resetData(model, data)
    pose, rates = skill.tables[2][0], skill.tables[3][0] / skill.clip.duration
    _place(model, data, index, pose, position, yaw, skill.clip.root_pitch)
    data.qvel[:3] = [speed * np.cos(yaw), speed * np.sin(yaw), -0.4]
    data.qvel[6 : 6 + len(JOINT_NAMES)] = rates
    state[:] = controller.new_state()
    state[controller.HEADING], state[controller.SPEED] = yaw, speed
    mujoco.mj_forward(model, data)
    controller.observe(index, model, data, state, fresh=True)
    state[controller.PLANTED] = state[controller.FEET]
    state[controller.COM_AT_SWITCH] = state[controller.COM]
    state[controller.COM_VELOCITY] = data.qvel[:3]


def run_on(
    state: np.ndarray, targets: np.ndarray, stance: float, heading: float, speed: float, phase: float = 0.1
) -> None:
    """Let the running controller take over a body that walks at ``speed`` [m/s] and has just put its foot of
    side ``stance`` down; ``state`` holds what was observed, ``targets`` (39,) [rad] are
    those of the last tick."""
    seen = state[controller.OBSERVED].copy()
    state[:] = controller.new_state()
    state[controller.OBSERVED], state[controller.LAST_TARGET] = seen, targets
    state[controller.STANCE], state[controller.HEADING] = stance, heading
    state[controller.SPEED], state[controller.PHASE] = speed, phase
    state[controller.PLANTED] = state[controller.FEET]
    state[controller.COM_AT_SWITCH] = state[controller.COM]
