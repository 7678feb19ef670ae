"""The leap across a gap, as all packages know it: a skill that is described by a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from locomotion.data import SKILLS
from locomotion.gaits.run.skill import RunSkill
from locomotion.skills.description import load_described
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.kind import SkillKind
from navmesh.obstacles.kinds import kind_of

if TYPE_CHECKING:
    from locomotion.training.training import Training

__all__ = ["LEAP", "LEAP_DESCRIPTION"]

LEAP_DESCRIPTION = SKILLS / "leap.yaml"


def _load(run: RunSkill) -> ClearingSkill | None:
    learned = LEAP_DESCRIPTION.with_suffix(".npz").exists()
    return load_described(LEAP_DESCRIPTION, run) if learned else None


def _train(training: Training, out: Path) -> None:
    from locomotion.training.skills.jump import train_described

    train_described(LEAP_DESCRIPTION, training, out)


LEAP = SkillKind(
    obstacle=kind_of("gap"),
    skill="leap",
    status="leaping",
    verb="leap",
    does="leaps over {:.2f} m",
    colour="#00798c",
    sizes=(0.4, 1.8),
    usual=1.2,
    load=_load,
    train=_train,
)
