"""Learned gains of walking on disk, and the stance from which a walk begins."""

import math
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from locomotion import controller
from locomotion.anatomy import ANKLE
from locomotion.errors import LocomotionError
from locomotion.footholds import foot_frame, ground_at, stand_on
from locomotion.leg_kinematics import solve_leg
from locomotion.person import JOINT_NAMES, PersonIndex, person_digest
from locomotion.skill_file import read_skill
from locomotion.walk_layout import (
    DOUBLE,
    GAINS,
    PHASE,
    WALK_SPEED,
    WALK_STANCE,
    WALK_STEPS,
    gain_limits,
    new_walk,
)
from locomotion.walking import SOLE, observe_walk
from navmesh.archive import write_archive

__all__ = ["RISING", "STEADYING_SPEED", "WALK_SKILL", "WalkSkill", "load_walk_skill", "plant", "rise_walking"]

WALK_SKILL = Path(__file__).parent / "skills" / "walk.npz"
RISING = 50
"""Ticks in which a body that begins to walk from a crouch comes up."""
STEADYING_SPEED = 1.0
"""[m/s] at which such a body makes its first steps, straight on."""
_STEADYING = 3  # steps of such a body that do not count yet
_KIND, _VERSION = "walk skill", 1
_WIDTH, _HIP_HEIGHT = 0.17, 0.83  # [m] of a stand: between the feet; of the hips above the lower sole
_HIPS_BACK = 0.03  # [m] that the hips are behind the middle of the feet
_STEEPEST = 0.4  # slope [rise over run] to which the feet of a stand turn uphill
_HIPS = tuple(JOINT_NAMES.index(f"{side}_hip_flexion") for side in ("right", "left"))
_ARMS = (("shoulder_abduction", 0.12), ("elbow_flexion", 0.35))


@dataclass(frozen=True)
class WalkSkill:
    """How the person walks: ``gains`` (len(GAINS),) float64 by the order of `walk_layout.GAINS`; ``speed``
    [m/s] at which it walks at most; ``meta``: what made it."""

    gains: np.ndarray
    speed: float = 1.25
    meta: dict[str, Any] = field(default_factory=dict)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the skill for the present person; the file appears whole or not at all."""
        header = {"person": person_digest(), "gains": list(GAINS), "speed": self.speed, "meta": self.meta}
        write_archive(path, _KIND, _VERSION, header, {"gains": self.gains})


def load_walk_skill(path: str | os.PathLike[str] = WALK_SKILL) -> WalkSkill:
    """Read a walk skill; `LocomotionError` if it is missing, cut off, of another version or another
    person."""
    header, arrays = read_skill(path, _KIND, _VERSION)
    gains, low_high = arrays.get("gains"), gain_limits()
    if gains is None or header.get("gains") != list(GAINS) or gains.shape != (len(GAINS),):
        raise LocomotionError(f"{path}: not a whole walk skill: it must name and hold {len(GAINS)} gains")
    if not ((gains >= low_high[0]) & (gains <= low_high[1])).all():
        name = list(GAINS)[int(np.flatnonzero(~((gains >= low_high[0]) & (gains <= low_high[1])))[0])]
        raise LocomotionError(f"{path}: {name} is outside {GAINS[name][1]:g} to {GAINS[name][2]:g}")
    return WalkSkill(gains, float(header.get("speed", 1.25)), header.get("meta", {}))


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
    spots = []
    for side in (-1.0, 1.0):
        x, y = position[0] - 0.5 * side * _WIDTH * sh, position[1] + 0.5 * side * _WIDTH * ch
        z, *normal = ground_at(ground, x, y, position[2] + 0.5)
        found = z == z and abs(z - position[2]) < 0.5
        spots.append(
            (np.array([x, y, z if found else position[2]]), np.array(normal) if found else np.eye(3)[2])
        )
    low = min(spot[2] for spot, _ in spots)
    data.qpos[:3] = [position[0] - _HIPS_BACK * ch, position[1] - _HIPS_BACK * sh, low + _HIP_HEIGHT]
    data.qpos[3:7] = [math.cos(0.5 * yaw), 0.0, 0.0, math.sin(0.5 * yaw)]
    for name, angle in _ARMS:
        for side in ("right", "left"):
            data.qpos[7 + JOINT_NAMES.index(f"{side}_{name}")] = angle
    mujoco.mj_kinematics(model, data)
    pelvis = data.xmat[index.root].reshape(3, 3).copy()
    for (spot, normal), hip, side in zip(spots, _HIPS, (-1.0, 1.0), strict=True):
        stand_on(ground, spot, normal, ch, sh, _STEEPEST)
        foot, angles = np.empty((3, 3)), np.empty(6)
        foot_frame(yaw, normal, foot)
        solve_leg(
            pelvis,
            data.xanchor[hip + 1].copy(),
            foot,
            spot - SOLE * foot[:, 0] + ANKLE * foot[:, 2],
            side,
            angles,
        )
        data.qpos[7 + hip : 13 + hip] = angles
    mujoco.mj_forward(model, data)
    state[:] = controller.new_state()
    state[controller.HEADING] = yaw
    state[controller.STANCE] = 1.0
    controller.observe(index, model, data, state, fresh=True)
    state[controller.PLANTED] = state[controller.FEET]
    walk[:] = new_walk(yaw)
    observe_walk(index, data, walk)


def rise_walking(walk: np.ndarray, state: np.ndarray, heading: float) -> None:
    """Let the walking controller take over a body that crouches on both feet and moves towards ``heading``
    [rad], from the next tick on; ``state`` holds what was observed. The number of steps begins below 0: with
    the first ones it steadies itself."""
    walk[:] = new_walk(heading)
    walk[WALK_STEPS] = -_STEADYING
    ch, sh = math.cos(heading), math.sin(heading)
    ahead = (state[23] - state[20]) * ch + (state[24] - state[21]) * sh  # of the left foot
    walk[PHASE], walk[WALK_STANCE] = DOUBLE, 1.0 if ahead > 0.0 else -1.0
    vx, vy = state[controller.COM_VELOCITY][:2]
    walk[WALK_SPEED] = min(max(vx * ch + vy * sh, 0.0), 1.2)
