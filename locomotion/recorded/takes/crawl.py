"""Crawling, authored by keys: an arm reaches out and the leg of the other side is drawn up, in turns."""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from locomotion.body.person import JOINT_NAMES
from locomotion.clips.motion import lowest_points
from locomotion.recorded.motion_set import Clip
from locomotion.recorded.takes.take import RATE, Take, mirrored

__all__ = ["CRAWLS", "crawl_cycles"]

CRAWLS = (0.25, 0.5)
"""[m/s]"""
_STRIDE = 0.5  # [m] in a cycle
_KEYS = (0.0, 0.25, 0.5, 0.75)
"""Shares of a cycle: the left arm is ahead, is half drawn back, is back, and reaches out."""
_MOVES = {
    "left_shoulder_flexion": (35.0, 10.0, -15.0, 5.0),
    "left_shoulder_abduction": (5.0, 12.0, 15.0, 30.0),
    "left_elbow_flexion": (-45.0, -10.0, 10.0, 5.0),
    "left_hip_flexion": (5.0, 25.0, 45.0, 22.0),
    "left_hip_abduction": (4.0, 17.0, 32.0, 16.0),
    "left_hip_rotation": (0.0, -15.0, -30.0, -15.0),
    "left_knee_flexion": (10.0, 45.0, 85.0, 40.0),
    "waist_yaw": (-6.0, 0.0, 6.0, 0.0),
    "waist_roll": (4.0, 0.0, -4.0, 0.0),
}
"""Angles [deg] at the keys that are added to those of the posture; the right side does the same half a cycle
later."""


def crawl_cycles(prone: NDArray[np.float64]) -> list[Take]:
    """Crawls at `CRAWLS`, from the posture ``prone`` (46,)."""
    takes = []
    for speed in CRAWLS:
        count = 2 * round(0.5 * _STRIDE / speed * RATE)
        shares = np.arange(count) / count
        qpos = np.tile(prone, (count, 1))
        for name, angles in _MOVES.items():
            moved = CubicSpline([*_KEYS, 1.0], np.radians([*angles, angles[0]]), bc_type="periodic")(shares)
            qpos[:, 7 + JOINT_NAMES.index(name)] += moved if name.startswith("left") else 0.5 * moved
            if name.startswith("left"):
                other = 7 + JOINT_NAMES.index("right" + name.removeprefix("left"))
                qpos[:, other] += np.roll(moved, count // 2)
        qpos = 0.5 * (qpos + np.roll(mirrored(qpos), count // 2, axis=0))
        qpos[:, 3:7] /= np.linalg.norm(qpos[:, 3:7], axis=1, keepdims=True)
        qpos[:, :2] = 0.0
        qpos[:, 2] -= lowest_points(qpos)
        seconds = count / RATE
        clip = Clip(
            name=f"crawl {speed:g}", kind="cycle", gait="crawl",
            origin="keys (locomotion.recorded.takes.crawl)", seconds=seconds, speed=speed,
            travel=(speed * seconds, 0.0, 0.0), rest="prone",
        )  # fmt: skip
        takes.append(Take(clip, qpos, np.zeros((count, 2), np.bool_)))
    return takes
