"""Learned gains of walking on disk, and the stance from which a walk begins."""

import math
import os
from dataclasses import dataclass, field
from typing import Annotated, Any, Self

import mujoco
import numpy as np
from annotated_types import Gt, Le
from pydantic import model_validator

from locomotion.body import observed as seen
from locomotion.body.anatomy import ANKLE
from locomotion.body.learned_file import RELEARN, SkillHeader, read_skill
from locomotion.body.leg_kinematics import solve_leg
from locomotion.body.person import JOINT_NAMES, PersonIndex, person_digest
from locomotion.data import SKILLS
from locomotion.gaits.run import controller
from locomotion.gaits.walk.controller import observe_walk
from locomotion.gaits.walk.footholds import SOLE, bearing, foot_frame, ground_at, stand_on, within_ankle
from locomotion.gaits.walk.layout import (
    ATTITUDES,
    DOUBLE,
    FAST,
    GAINS,
    PHASE,
    STEEPNESS,
    WALK_SPEED,
    WALK_STANCE,
    WALK_STEPS,
    gain_limits,
    new_walk,
)
from surefoot.files.archive import write_archive
from surefoot.files.schema import Numbers, Schema

__all__ = [
    "RISING", "STEADYING_SPEED", "TABLES", "WALK_SKILL", "WalkSkill", "load_walk_skill", "plant",
    "rise_walking",
]  # fmt: skip

WALK_SKILL = SKILLS / "walk.npz"
TABLES = FAST + 1
"""Rows of gains, as named in `walk_layout`."""
RISING = 50
"""Ticks in which a body that begins to walk from a crouch comes up."""
STEADYING_SPEED = 1.0
"""[m/s] at which such a body makes its first steps, straight on."""
_PASSING = 0.1  # [s] after which such a body is over its feet
_STEADYING = 3  # steps of such a body that do not count yet
_WIDTH, _HIP_HEIGHT = 0.17, 0.83  # [m] of a stand: between the feet; of the hips above the lower sole
_LOWER = 0.15  # [m] that the hips are lower per unit of slope
_HIPS_BACK = 0.03  # [m] that the hips are behind the middle of where the feet bear
_PITCH, _ROLL = 0.15, 0.4  # slopes to which the feet of a stand turn, uphill and sideways
_HIPS = tuple(JOINT_NAMES.index(f"{side}_hip_flexion") for side in ("right", "left"))
_ARMS = (("shoulder_abduction", 0.12), ("elbow_flexion", 0.35))


@dataclass(frozen=True, eq=False)
class WalkSkill:
    """How the person walks.

    Attributes:
        tables: (5, len(GAINS)) float64, gains in the order of `walk_layout.GAINS`, for level ground, for
            steep ground, for coming to rest there, for stairs and for fast walks.
        speed: [m/s] at which it walks at most.
        meta: what made it.
    """

    tables: np.ndarray
    speed: float = 1.25
    meta: dict[str, Any] = field(default_factory=dict)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the skill for the present person; the file appears whole or not at all."""
        header = {"person": person_digest(), "gains": list(GAINS), "speed": self.speed, "meta": self.meta}
        write_archive(path, WALK_FILE.kind, WALK_FILE.version, header, {"tables": self.tables})


class _WalkHeader(SkillHeader):
    gains: tuple[str, ...]
    speed: Annotated[float, Gt(0.0), Le(10.0)] = 1.25

    @model_validator(mode="after")
    def _names_the_gains(self) -> Self:
        if self.gains != tuple(GAINS):
            raise ValueError(f"must name the {len(GAINS)} gains of this release")
        return self


def _check(header: _WalkHeader, arrays: dict[str, np.ndarray]) -> str | None:
    tables, (low, high) = arrays["tables"], gain_limits()
    outside = ~((tables >= low) & (tables <= high))
    if not outside.any():
        return None
    name = list(GAINS)[int(np.argwhere(outside)[0, 1])]
    return f"{name} is outside {GAINS[name][1]:g} to {GAINS[name][2]:g}"


WALK_FILE = Schema(
    kind="walk skill",
    version=3,
    header=_WalkHeader,
    arrays={"tables": Numbers(TABLES, len(GAINS))},
    remedy=RELEARN,
    check=_check,
)


def load_walk_skill(path: str | os.PathLike[str] = WALK_SKILL) -> WalkSkill:
    """Read a walk skill; `LocomotionError` if it is missing, cut off, of another version or another
    person."""
    header, arrays = read_skill(path, WALK_FILE)
    return WalkSkill(arrays["tables"], header.speed, header.meta)


def plant(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    index: PersonIndex,
    ground: tuple[np.ndarray, ...],
    state: np.ndarray,
    walk: np.ndarray,
    position: np.ndarray,
    yaw: float,
) -> None:
    """Stand the person still over the ground point ``position`` (3,), both feet on the ground as it is there;
    fills ``state`` and ``walk``."""
    mujoco.mj_resetData(model, data)
    ch, sh = math.cos(yaw), math.sin(yaw)
    spots, feet, attitudes = np.empty((2, 3)), np.empty((2, 3, 3)), np.empty((2, 3))
    steepness = 0.0
    for k, side in enumerate((-1.0, 1.0)):
        at = position[:2] + 0.5 * side * _WIDTH * np.array([-sh, ch])
        off = np.zeros(2)  # from the middle of the sole to where the foot bears
        for _ in range(2):
            steep = _put_foot(ground, [*(at - off), position[2]], yaw, spots[k], attitudes[k], feet[k])
            bears = np.empty(4)
            bearing(ground, spots[k], feet[k].ravel(), bears)
            off = feet[k, :2, :2] @ bears[:2]
        steepness += 0.5 * steep
    data.qpos[:2] = position[:2] - _HIPS_BACK * np.array([ch, sh])
    data.qpos[2] = spots[:, 2].min() + _HIP_HEIGHT - _LOWER * steepness
    data.qpos[3:7] = [math.cos(0.5 * yaw), 0.0, 0.0, math.sin(0.5 * yaw)]
    for name, angle in _ARMS:
        for side in ("right", "left"):
            data.qpos[7 + JOINT_NAMES.index(f"{side}_{name}")] = angle
    mujoco.mj_kinematics(model, data)
    pelvis = data.xmat[index.root].reshape(3, 3).copy()
    for spot, foot, hip, side in zip(spots, feet, _HIPS, (-1.0, 1.0), strict=True):
        at, ankle = data.xanchor[hip + 1].copy(), spot - SOLE * foot[:, 0] + ANKLE * foot[:, 2]
        angles = np.empty(6)
        solve_leg(pelvis, at, foot, ankle, side, angles)
        data.qpos[7 + hip : 13 + hip] = angles
    mujoco.mj_forward(model, data)
    state[:] = controller.new_state()
    state[controller.HEADING] = yaw
    state[controller.STANCE] = 1.0
    controller.observe(index, model, data, state, fresh=True)
    state[controller.PLANTED] = state[controller.FEET]
    walk[:] = new_walk(yaw)
    walk[STEEPNESS], walk[ATTITUDES] = steepness, attitudes.ravel()
    observe_walk(index, data, walk)


def _put_foot(
    ground: tuple[np.ndarray, ...],
    at: list[float],
    yaw: float,
    spot: np.ndarray,
    normal: np.ndarray,
    foot: np.ndarray,
) -> float:
    """Stand a foot on the ground near ``at`` (3,): middle of its sole ``spot`` (3,), its ``normal`` (3,) and
    rotation ``foot`` (3, 3); gives the ground's slope there."""
    ch, sh = math.cos(yaw), math.sin(yaw)
    z, *up = ground_at(ground, at[0], at[1], at[2] + 0.5)
    found = z == z and abs(z - at[2]) < 0.5
    spot[:], normal[:] = [at[0], at[1], z if found else at[2]], up if found else [0.0, 0.0, 1.0]
    steep = math.hypot(normal[0], normal[1]) / normal[2]
    hip = spot + np.array([0.0, 0.0, _HIP_HEIGHT - _LOWER * steep])
    pitch = within_ankle(spot, ch, sh, hip, 0.0)
    stand_on(ground, spot, normal, ch, sh, min(_PITCH, pitch), _ROLL)
    foot_frame(yaw, normal, foot)
    return steep


def rise_walking(walk: np.ndarray, observed: np.ndarray, heading: float) -> None:
    """Let the walking controller take over a body that crouches on both feet and moves towards ``heading``
    [rad], from the next tick on; ``observed``: as in
    `locomotion.body.observed`. The number of steps begins below 0: with
    the first ones it steadies itself."""
    walk[:] = new_walk(heading)
    walk[WALK_STEPS] = -_STEADYING
    ch, sh = math.cos(heading), math.sin(heading)
    # the foot that the body passes nearest to bears it first: it does not tip away over the outside
    left = np.array([-sh, ch])
    passing = left @ (observed[seen.COM] + _PASSING * observed[seen.COM_VELOCITY])[:2]
    aside = np.abs(observed[seen.FEET].reshape(2, 3)[:, :2] @ left - passing)
    walk[PHASE], walk[WALK_STANCE] = DOUBLE, -1.0 if aside[0] < aside[1] else 1.0
    vx, vy = observed[seen.VELOCITY_X : seen.VELOCITY_Z]
    walk[WALK_SPEED] = min(max(vx * ch + vy * sh, 0.0), 1.2)
