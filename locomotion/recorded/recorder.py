"""Make a set of recorded motions from takes of the full figure (``surefoot record``)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.postures.posture_graph import PostureGraph
from locomotion.recorded.motion_set import LevelFrames, MotionSet
from locomotion.recorded.skeletons import LEVELS, Skeleton, skeleton
from locomotion.recorded.slaving import slaved
from locomotion.recorded.takes.arcs import posture_takes
from locomotion.recorded.takes.cleaning import backwards, cleaned
from locomotion.recorded.takes.crawl import crawl_cycles
from locomotion.recorded.takes.cycles import run_cycles, walk_cycles
from locomotion.recorded.takes.skills import falls_and_rises, obstacle_takes
from locomotion.recorded.takes.take import Take, Told, spread
from locomotion.recorded.takes.turns import turn_cycles
from surefoot.progress import Progress

__all__ = ["Recorded", "motion_set_of", "record_person"]

_BACKWARDS = 1.55
"""[m/s] of the quickest walk that is played backwards, too."""


@dataclass(frozen=True)
class Recorded:
    """A set, and where the landmarks of its lower figures miss those of the full one, in words."""

    motions: MotionSet
    warnings: tuple[str, ...]


def record_person(graph: PostureGraph, origin: str, progress: Progress) -> Recorded:
    """The postures of ``graph``, which come from ``origin``, and what the person does in the simulation."""
    takes = posture_takes(graph, origin)
    for label, record in (("walking", walk_cycles), ("running", run_cycles)):
        with progress.stage(label) as stage:
            cycles = cleaned(record(stage.update))
        takes += cycles
        if label == "walking":
            takes += [backwards(take, "walk backwards") for take in cycles if take.clip.speed <= _BACKWARDS]
            takes += turn_cycles(cycles[0])
    if "prone" in graph.postures:
        takes += crawl_cycles(graph.poses[graph.postures.index("prone")])
    for label, record in (("obstacles", obstacle_takes), ("getting up", falls_and_rises)):
        with progress.stage(label) as stage:
            takes += record(stage.update)
    with progress.stage("mapping to lower levels") as stage:
        return motion_set_of(takes, stage.update)


def _untold(share: float, what: str) -> None:
    pass


def motion_set_of(takes: Sequence[Take], told: Told = _untold) -> Recorded:
    """The set of ``takes``, mapped to all levels."""
    levels, warnings = [], []
    for number, name in enumerate(LEVELS):
        figure, parts = skeleton(name), []
        for k, take in enumerate(takes):
            told((number + k / len(takes)) / len(LEVELS), f"{take.clip.name}, {name}")
            qpos, stance = _at_rate(take, figure)
            found = slaved(qpos, figure, take.held, take.clip.name, figure.rate, take.clip.kind == "cycle")
            warnings += found.warnings
            parts.append((found.channels, qpos[:, :7], stance))
        count = np.array([len(part[0]) for part in parts], np.int64)
        channels, roots, stance = (np.concatenate(each) for each in zip(*parts, strict=True))
        levels.append(LevelFrames(np.cumsum(count) - count, count, channels, roots, stance))
    return Recorded(MotionSet(tuple(take.clip for take in takes), tuple(levels)), tuple(warnings))


def _at_rate(take: Take, figure: Skeleton) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Frames (n, 46) and stance (n, 2) of a take at the rate of a level."""
    if len(take.qpos) == 1:
        return take.qpos, take.stance
    cyclic = take.clip.kind == "cycle"
    count = max(round(take.clip.seconds * figure.rate), 8 if cyclic else 1)
    shares = np.arange(count) / count if cyclic else np.linspace(0.0, 1.0, count + 1)
    nearest = np.round(shares * (len(take.qpos) - (not cyclic))).astype(int) % len(take.qpos)
    return spread(take.qpos, shares, cyclic), take.stance[nearest]
