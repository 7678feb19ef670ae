"""Turning on the spot: the steps of a slow walk, put down on a circle."""

import numpy as np

from locomotion.recorded.foot_planting import planted
from locomotion.recorded.footfalls import BEARS, LEFT, STRIKES, footing_at
from locomotion.recorded.motion_set import Clip, LevelFrames, MotionSet
from locomotion.recorded.sampling import sample_gait
from locomotion.recorded.skeletons import FULL
from locomotion.recorded.takes.take import RATE, Take, mirrored

__all__ = ["TURNS", "turn_cycles"]

TURNS = (0.5, 1.0, 1.8)
"""[rad/s]"""
_SECONDS = 1.1  # of a cycle of two steps
_HALF_WIDTH = 0.1  # [m] of a foot to the side
_OF_A_WALK = 0.25  # share of the walk's speed whose steps are taken


def turn_cycles(walk: Take) -> list[Take]:
    """Turns to the left and to the right with the steps of a slow ``walk``, a cycle."""
    count = round(_SECONDS * RATE)
    clip, frames = walk.clip.model_copy(update={"rest": ""}), len(walk.qpos)
    level = LevelFrames(np.array([0]), np.array([frames]), walk.qpos[:, 7:], walk.qpos[:, :7], walk.stance)
    motions, gait = MotionSet((clip,), (level,)), np.zeros(count, np.int64)
    phases, speeds = np.arange(count) / count, np.full(count, walk.clip.speed)
    table, takes = footing_at(motions, 0, [walk.clip.speed])[0], []
    channels, roots = sample_gait(motions, FULL, gait, speeds, phases)
    roots[:, :2] *= _OF_A_WALK
    stance = (phases[:, None] - table[:, STRIKES]) % 1.0 < table[:, BEARS]
    for rate in TURNS:
        turn = rate * _SECONDS
        footfalls = np.zeros((count, 2, 2, 6))
        for side in range(2):
            numbers = np.floor(phases - table[side, STRIKES])[:, None] + np.arange(2)
            heading = turn * (numbers + table[side, STRIKES] + 0.5 * table[side, BEARS])
            y = np.copysign(_HALF_WIDTH, table[side, LEFT])
            footfalls[:, side, :, 0], footfalls[:, side, :, 1] = -y * np.sin(heading), y * np.cos(heading)
            footfalls[:, side, :, 3] = heading
        places = np.zeros((count, 4))
        places[:, 3] = turn * phases
        moments = gait, speeds, phases
        done, world = planted(motions, FULL, moments, (channels, roots), places, footfalls)
        qpos = np.hstack([_unturned(world, places[:, 3]), done])
        for name, sign, rows, bears in (
            ("turn left", 1.0, qpos, stance),
            (
                "turn right",
                -1.0,
                np.roll(mirrored(qpos), count // 2, axis=0),
                np.roll(stance[:, ::-1], count // 2, 0),
            ),
        ):
            told = Clip(
                name=f"{name} {rate:g}", kind="cycle", gait=name, seconds=count / RATE, speed=rate,
                travel=(0.0, 0.0, sign * turn), rest="stand",
                origin=f"steps of {walk.clip.name} put down on a circle: {walk.clip.origin}",
            )  # fmt: skip
            takes.append(Take(told, rows, bears))
    return takes


def _unturned(roots: np.ndarray, headings: np.ndarray) -> np.ndarray:
    """Roots (n, 7) as seen from the origin, facing ``headings`` (n,)."""
    c, s = np.cos(headings), np.sin(headings)
    half_c, half_s = np.cos(0.5 * headings), -np.sin(0.5 * headings)
    x, y, z, w, i, j, k = roots.T
    return np.stack(
        [
            c * x + s * y, c * y - s * x, z,
            half_c * w - half_s * k, half_c * i - half_s * j, half_c * j + half_s * i, half_c * k + half_s *
        w, ],
        axis=1,
    )  # fmt: skip
