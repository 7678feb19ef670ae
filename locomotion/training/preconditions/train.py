"""Learning the package's preconditions: sampling each skill, and fitting what came of it."""

from __future__ import annotations

from pathlib import Path

from locomotion.preconditions.changes import BRAKE, CHANGES, END_RUN, SLOW_DOWN, WALK_TO_RUN
from locomotion.preconditions.precondition import Precondition, precondition_file
from locomotion.skills.registry import skill_kinds
from locomotion.training.preconditions.fitting import fit_precondition
from locomotion.training.preconditions.outcomes import sample
from surefoot.progress import Progress
from surefoot.workers.pool import Place

__all__ = ["STARTS", "sampled_skills", "train_preconditions"]

STARTS = 2000
"""Starts of each skill that the package's preconditions are learned from."""
_OF_CHANGES = {WALK_TO_RUN: 0.4, SLOW_DOWN: 0.3, BRAKE: 0.2, END_RUN: 0.2}  # shares of these


def sampled_skills() -> tuple[str, ...]:
    """The skills and changes that have preconditions, as they are called."""
    return (*(kind.skill for kind in skill_kinds() if kind.train is not None), *CHANGES)


def train_preconditions(
    kept: Path, seed: int, count: int = STARTS, place: Place = 1, out: Path | None = None
) -> list[Precondition]:
    """Sample each skill from ``count`` starts, and each change from a share of that, into the folder
    ``kept``, where an interrupted call goes on, and write what is fitted to ``out``, by default the package's
    own folder. The same seed and count give the same files."""
    kept.mkdir(exist_ok=True)
    learned = []
    for skill in sampled_skills():
        starts = max(round(_OF_CHANGES.get(skill, 1.0) * count), 1)
        outcomes = sample(skill, starts, seed, kept / f"{skill}.npz", place, Progress())
        learned.append(fit_precondition(outcomes))
    for each in learned:
        file = precondition_file(each.skill)
        each.save(file if out is None else out / file.name)
    return learned
