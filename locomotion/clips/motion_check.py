"""Find what a body cannot do in a motion: joints beyond their range, limbs in the ground, floating."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.models import figure
from locomotion.body.person import JOINT_NAMES
from locomotion.clips.motion import Motion, lowest_points

__all__ = ["Fault", "check_motion"]

_SPARE = np.radians(1.0)  # by which a joint may exceed its range
_SINKS, _OFF = 0.03, 0.03  # [m] below the ground; height above it from which the figure counts as off it
_FALLS = 4.0  # [m/s^2] allowed difference from free fall while off the ground
_SHORTEST = 0.05  # [s]
_SMOOTH = 0.06  # [s] over which the acceleration is taken


@dataclass(frozen=True)
class Fault:
    """A stretch of a motion.

    Attributes:
        kind: "joint" (beyond its range), "sinks" (below the ground) or "floats" (off the ground and not
            falling freely). joint: its name, or "".
        begin, end: [s]. worst: [deg] beyond the range, or [m] below or above the ground.
    """

    kind: str
    joint: str
    begin: float
    end: float
    worst: float

    def __str__(self) -> str:
        when = f"from {self.begin:.2f} to {self.end:.2f} s"
        if self.kind == "joint":
            return f"{self.joint} is up to {self.worst:.0f} deg beyond its range {when}"
        return f"the figure {self.kind} by up to {100.0 * self.worst:.0f} cm {when}"


def check_motion(motion: Motion) -> list[Fault]:
    """Every `Fault` of a motion, by kind and time. Floating is not checked if the root was put on the
    ground."""
    model = figure()
    low, high = model.jnt_range[1:].T
    angles = motion.qpos[:, 7:]
    excess = np.maximum(np.maximum(low - angles, angles - high), 0.0)
    faults = []
    for j, name in enumerate(JOINT_NAMES):
        faults += _stretches("joint", name, excess[:, j] > _SPARE, np.degrees(excess[:, j]), motion.rate)
    if motion.grounded:
        return faults
    lowest = lowest_points(motion.qpos)
    faults += _stretches("sinks", "", lowest < -_SINKS, -lowest, motion.rate)
    held = np.abs(_fall(motion) + 9.81) > _FALLS
    return faults + _stretches("floats", "", (lowest > _OFF) & held, lowest, motion.rate)


def _stretches(
    kind: str, joint: str, wrong: NDArray[np.bool_], amount: NDArray[np.float64], rate: float
) -> list[Fault]:
    ends = np.flatnonzero(np.diff(wrong.astype(np.int8), prepend=0, append=0)).reshape(-1, 2)
    return [
        Fault(kind, joint, float(a / rate), float((b - 1) / rate), float(amount[a:b].max()))
        for a, b in ends
        if (b - a) / rate >= _SHORTEST or len(wrong) == 1
    ]


def _fall(motion: Motion) -> NDArray[np.float64]:
    """Vertical acceleration of the centre of mass, (n,) [m/s^2]: second differences over `_SMOOTH`."""
    model = figure()
    data = mujoco.MjData(model)
    heights = np.empty(len(motion.qpos))
    for i, frame in enumerate(motion.qpos):
        data.qpos[:] = frame
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        heights[i] = data.subtree_com[1, 2]
    reach = max(round(_SMOOTH * motion.rate), 1)
    at = np.clip(np.arange(len(heights)), reach, max(len(heights) - 1 - reach, reach))
    if len(heights) <= 2 * reach:
        return np.zeros(len(heights))
    return (heights[at - reach] - 2.0 * heights[at] + heights[at + reach]) / (reach / motion.rate) ** 2
