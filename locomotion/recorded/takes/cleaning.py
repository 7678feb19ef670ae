"""Cycles whose feet stand still: what the simulation's slide and sink is taken out of a cycle."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from locomotion.recorded.foot_planting import planted
from locomotion.recorded.footfalls import straight_footfalls
from locomotion.recorded.motion_set import LevelFrames, MotionSet
from locomotion.recorded.skeletons import FULL
from locomotion.recorded.takes.take import Take

__all__ = ["backwards", "cleaned"]

_MOST_TURNED = 0.12  # [rad] that a foot which stands is turned out


def cleaned(takes: Sequence[Take]) -> list[Take]:
    """``takes`` with the feet of all cycles planted on level ground, and turned out by 7 degrees at most."""
    found = []
    for take in takes:
        if take.clip.bears == 0.0:
            found.append(take)
            continue
        count = len(take.qpos)
        alone = take.clip.model_copy(update={"rest": ""})
        frames = LevelFrames(
            np.array([0]), np.array([count]), take.qpos[:, 7:], take.qpos[:, :7], take.stance
        )
        motions = MotionSet((alone,), (frames,))
        phases = np.arange(count) / count
        gaits, speeds = np.zeros(count, np.int64), np.full(count, take.clip.speed)
        places = np.zeros((count, 4))
        places[:, 0] = take.clip.travel[0] * phases
        footfalls = np.array(
            [
                straight_footfalls(motions, 0, take.clip.speed, phase, place)
                for phase, place in zip(phases, places, strict=True)
            ]
        )
        footfalls[..., 3] = footfalls[..., 3].clip(-_MOST_TURNED, _MOST_TURNED)
        sample = take.qpos[:, 7:], take.qpos[:, :7]
        channels, roots = planted(motions, FULL, (gaits, speeds, phases), sample, places, footfalls)
        roots[:, 0] -= places[:, 0]
        found.append(replace(take, qpos=np.hstack([roots, channels])))
    return found


def backwards(take: Take, gait: str) -> Take:
    """A cycle played backwards, as one of another ``gait``."""
    clip = take.clip
    x, y, turn = clip.travel
    turned = clip.model_copy(
        update={
            "name": clip.name.replace(clip.gait, gait), "gait": gait, "travel": (-x, -y, -turn),
            "origin": f"{clip.name} played backwards: {clip.origin}",
        }
    )  # fmt: skip
    order = (np.round(clip.bears * len(take.qpos)) - np.arange(len(take.qpos))).astype(int) % len(take.qpos)
    return Take(turned, take.qpos[order], take.stance[order])
