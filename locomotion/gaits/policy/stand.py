"""The stand of the reference motion, in which the policy begins."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import JOINT_NAMES
from locomotion.gaits.policy.kernel import Parts, feel
from locomotion.gaits.policy.layout import (
    HEAD_BEND,
    JOINTS,
    LEANING,
    SOLES,
    SPREAD,
    SPREADING,
    STYLE,
    TRUNK_LEAN,
)
from locomotion.gaits.policy.motion import Motion

__all__ = ["stand_still"]

_LEAN = 0.035  # [rad] of the pelvis in the reference's stand
_ABOVE = 0.001  # [m] of the soles over the ground
_COLUMNS = np.array([7 + JOINT_NAMES.index(name) for name in JOINTS])
_SPREADS, _LEANS, _BENDS = _COLUMNS[SPREADING], _COLUMNS[LEANING], 7 + JOINT_NAMES.index("neck_pitch")
_USUAL = np.zeros(STYLE.stop - STYLE.start)


def stand_still(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    parts: Parts,
    motion: Motion,
    position: NDArray[np.float64],
    yaw: float,
    felt: NDArray[np.float64],
    style: NDArray[np.float64] = _USUAL,
) -> None:
    """Let a person stand still on the level ground point ``position`` (3,) [m], facing ``yaw`` [rad], in its
    ``style`` (5,), as of `locomotion.gaits.policy.style.style_of`; fills ``felt`` (FELT_SIZE,)."""
    mujoco.mj_resetData(model, data)
    half = 0.5 * yaw
    data.qpos[:2] = position[:2] - motion.stance[0] * np.array([math.cos(yaw), math.sin(yaw)])
    turned = np.array([math.cos(half), 0.0, 0.0, math.sin(half)])
    leans = np.array([math.cos(0.5 * _LEAN), 0.0, math.sin(0.5 * _LEAN), 0.0])
    mujoco.mju_mulQuat(data.qpos[3:7], turned, leans)
    data.qpos[_COLUMNS] = motion.stand
    data.qpos[_SPREADS] += style[SPREAD - STYLE.start]
    data.qpos[_LEANS] += style[TRUNK_LEAN - STYLE.start]
    data.qpos[_BENDS] = style[HEAD_BEND - STYLE.start]
    mujoco.mj_forward(model, data)
    feel(parts, data, felt)
    data.qpos[2] += position[2] + _ABOVE - felt[SOLES].reshape(6, 3)[:, 2].min()
    mujoco.mj_forward(model, data)
    feel(parts, data, felt)
