"""The roll off a drop, as all packages know it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from locomotion.gaits.run.skill import RunSkill
from locomotion.skills.drop_roll.skill import DROP_ROLL_SKILL, DropRoll, load_drop_roll_skill
from locomotion.skills.drop_roll.slippery import SLIPPERY_ROLL, load_slippery_roll
from locomotion.skills.kind import SkillKind
from navmesh.obstacles.kinds import kind_of

if TYPE_CHECKING:
    from locomotion.training.training import Training

__all__ = ["DROP_ROLL"]


def _load(run: RunSkill) -> DropRoll | None:
    if not DROP_ROLL_SKILL.exists():
        return None
    return DropRoll(load_drop_roll_skill(), load_slippery_roll() if SLIPPERY_ROLL.exists() else None)


def _train(training: Training, out: Path) -> None:
    from locomotion.training.skills.drop_roll import train_drop_roll

    train_drop_roll(training, out)


DROP_ROLL = SkillKind(
    obstacle=kind_of("drop"),
    skill="drop-roll",
    status="dropping",
    verb="drop",
    does="drops {:.2f} m and rolls",
    colour="#edae49",
    sizes=(0.9, 2.0),
    usual=1.5,
    load=_load,
    train=_train,
)
