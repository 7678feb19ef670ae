"""Cycles whose feet stand still: what the simulation's slide and sink is taken out of a cycle."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from locomotion.recorded.foot_planting import planted
from locomotion.recorded.footfalls import straight_footfalls
from locomotion.recorded.motion_set import LevelFrames, MotionSet
from locomotion.recorded.skeletons import FULL
from locomotion.recorded.takes.take import Take

__all__ = ["backwards", "cleaned"]

_MOST_TURNED = 0.12  # [rad] that a foot which stands is turned out
_QUICKER, _CALM = 1.15, 0.19  # times; [rad] in a frame that is never too quick
_SHARES = 11


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
        found.append(replace(take, qpos=_as_far_as_it_is_smooth(take.qpos, np.hstack([roots, channels]))))
    return found


def _as_far_as_it_is_smooth(before: NDArray[np.float64], after: NDArray[np.float64]) -> NDArray[np.float64]:
    """From the cycle ``before`` (n, 46) towards the one ``after``, as far as no joint turns more between two
    frames than `_QUICKER` times the most that one did before. In fast runs feet slide by so much that legs
    which follow feet at rest would snap straight and back."""
    most = _QUICKER * max(_quickest(before), _CALM)
    for share in np.linspace(1.0, 0.0, _SHARES):
        between = before + share * (after - before)
        between[:, 3:7] /= np.linalg.norm(between[:, 3:7], axis=1, keepdims=True)
        if _quickest(between) <= most:
            return between
    return before


def _quickest(cycle: NDArray[np.float64]) -> float:
    """[rad] that a joint turns at most between two frames of a ``cycle`` (n, 46)."""
    return float(np.abs(np.diff(cycle[:, 7:], axis=0, append=cycle[:1, 7:])).max())


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
