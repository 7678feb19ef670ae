"""Make a set of recorded motions from takes of the full figure (``surefoot record``)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import JOINT_NAMES
from locomotion.postures.posture_graph import PostureGraph
from locomotion.recorded.motion_set import LevelFrames, MotionSet
from locomotion.recorded.skeletons import LEVELS, Skeleton, skeleton
from locomotion.recorded.takes.arcs import posture_takes
from locomotion.recorded.takes.cycles import run_cycles, walk_cycles
from locomotion.recorded.takes.take import Take, spread
from surefoot.progress import Progress

__all__ = ["motion_set_of", "record_person"]


def record_person(graph: PostureGraph, origin: str, progress: Progress) -> MotionSet:
    """The postures of ``graph``, which come from ``origin``, and what the person does in the simulation."""
    takes = posture_takes(graph, origin)
    for label, record in (("walking", walk_cycles), ("running", run_cycles)):
        with progress.stage(label) as stage:
            takes += record(stage.update)
    return motion_set_of(takes)


def motion_set_of(takes: Sequence[Take]) -> MotionSet:
    """The set of ``takes``, mapped to all levels."""
    levels = []
    for name in LEVELS:
        figure = skeleton(name)
        parts = [_at_rate(take, figure) for take in takes]
        count = np.array([len(qpos) for qpos, _ in parts], np.int64)
        qpos = np.concatenate([qpos for qpos, _ in parts])
        stance = np.concatenate([stance for _, stance in parts])
        levels.append(
            LevelFrames(np.cumsum(count) - count, count, guessed(qpos, figure), qpos[:, :7], stance)
        )
    return MotionSet(tuple(take.clip for take in takes), tuple(levels))


def _at_rate(take: Take, figure: Skeleton) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    if len(take.qpos) == 1:
        return take.qpos, take.stance
    cyclic = take.clip.kind == "cycle"
    count = max(round(take.clip.seconds * figure.rate), 8 if cyclic else 1)
    shares = np.arange(count) / count if cyclic else np.linspace(0.0, 1.0, count + 1)
    nearest = np.round(shares * (len(take.qpos) - (not cyclic))).astype(int) % len(take.qpos)
    return spread(take.qpos, shares, cyclic), take.stance[nearest]


def guessed(qpos: NDArray[np.float64], figure: Skeleton) -> NDArray[np.float64]:
    """Channels (n, c) of a lower level by the sum of what the full figure's joints ``qpos`` (n, 46) turn."""
    joints = qpos[:, 7:].copy()
    if "chest_pitch" not in figure.channels:
        for turn in ("pitch", "roll", "yaw"):
            joints[:, JOINT_NAMES.index(f"waist_{turn}")] += joints[:, JOINT_NAMES.index(f"chest_{turn}")]
    return joints[:, figure.joints]
