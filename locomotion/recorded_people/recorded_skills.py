"""The skills that there are recordings of, and what happens in each recording when."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from locomotion.recorded.footfalls import FEET
from locomotion.recorded.motion_set import MotionSet
from locomotion.recorded.posing import posed
from locomotion.recorded.skeletons import FULL, skeleton
from locomotion.recorded_people.clearing import RecordedSkill
from locomotion.recorded_people.hand_holds import holds_of
from locomotion.skills.registry import skill_kind, skill_kinds

__all__ = ["recorded_skills", "skill_ranges"]

_GAP = 4  # frames for which a foot that bears may lift off
_SETTLED = 0.35  # [s] after landing until which a skill is played that ends on the feet


def _skill_of(motions: MotionSet, clip: int, crossing: str, usual: float) -> RecordedSkill:
    about, frames, own = motions.clips[clip], motions.levels[FULL], skeleton("full")
    rows = slice(int(frames.first[clip]), int(frames.first[clip] + frames.count[clip]))
    times = np.linspace(0.0, about.seconds, int(frames.count[clip]))
    bodies = posed(own, frames.channels[rows], frames.roots[rows])
    feet = bodies[:, [own.bodies.index(name) for name in FEET], 0]
    root, stance = bodies[:, 0, 0], frames.stance[rows]
    edge, _, depth = about.obstacle
    over = int(np.argmax(root > edge))
    before = np.flatnonzero((stance & (feet < edge)).any(axis=1) & (np.arange(len(root)) < over))
    leaves = int(before[-1])
    foot = int(np.argmax(stance[leaves] & (feet[leaves] < edge)))
    begins = _begin_of_stance(stance[:, foot], leaves)
    # one step earlier, so that what is left of the gait before has faded when it leaves the ground
    foot = 1 - foot
    begins = _begin_of_stance(stance[:, foot], int(np.flatnonzero(stance[:begins, foot])[-1]))
    behind = edge + depth
    lands = int(np.argmax((stance & (feet > behind)).any(axis=1) & (np.arange(len(root)) > leaves)))
    crosses = int(np.argmax((feet > edge - 0.1).any(axis=1)))
    passed = int(np.argmax((feet > behind).all(axis=1)))
    rolls = crossing == "off"
    ends = about.seconds if rolls else min(times[lands] + _SETTLED, about.seconds)
    last = int(np.searchsorted(times, ends - 1e-9))
    return RecordedSkill(
        clip, crossing, float(times[begins]), float(times[leaves]), float(times[crosses]),
        float(times[min(passed, lands)]), float(times[lands]), float(ends), edge - float(root[begins]), edge,
        depth, usual, (float(bodies[begins, 0, 1]), float(bodies[last, 0, 1])),
        float((root[begins + 3] - root[begins]) / (times[begins + 3] - times[begins])), 0.5 * foot,
        holds_of(own.as_qpos(frames.channels[rows], frames.roots[rows]), times, about.obstacle),
    )  # fmt: skip


def _begin_of_stance(bears: NDArray[np.bool_], frame: int) -> int:
    """The first frame of the stance that a foot is in at a ``frame``."""
    while bears[max(frame - _GAP, 0) : frame].any():
        frame -= 1
    return frame


@lru_cache(maxsize=4)
def _skills_of(motions: MotionSet) -> dict[str, RecordedSkill]:
    found, names = {}, motions.names
    for kind in skill_kinds():
        about = motions.clips[names.index(kind.affordance)] if kind.affordance in names else None
        if about is not None and about.kind == "skill" and about.obstacle[0] > 0.0:
            size = kind.obstacle.size(about.obstacle[1], about.obstacle[2])
            found[kind.affordance] = _skill_of(
                motions, names.index(kind.affordance), kind.obstacle.crossing, size
            )
    return found


def recorded_skills(motions: MotionSet) -> dict[str, RecordedSkill]:
    """The skills that there are recordings of, by affordance."""
    return _skills_of(motions)


def skill_ranges(motions: MotionSet) -> dict[str, tuple[float, float]]:
    """Least and greatest size [m] of what recorded people clear, by affordance."""
    return {name: skill_kind(name).sizes for name in recorded_skills(motions)}
