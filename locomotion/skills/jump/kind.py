"""The jump onto a platform, as all packages know it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from locomotion.gaits.run.skill import RunSkill
from locomotion.skills.jump.skill import JUMP_SKILL, Jump, load_jump_skill
from locomotion.skills.kind import SkillKind
from navmesh.obstacles.kinds import kind_of

if TYPE_CHECKING:
    from locomotion.training.training import Training

__all__ = ["JUMP"]


def _load(run: RunSkill) -> Jump | None:
    return Jump(load_jump_skill(), run) if JUMP_SKILL.exists() else None


def _train(training: Training, out: Path) -> None:
    from locomotion.training.skills.jump import train_jump

    train_jump(training, out)


JUMP = SkillKind(
    obstacle=kind_of("jump"),
    skill="jump",
    status="jumping",
    verb="jump",
    does="jumps onto {:.2f} m",
    colour="#d1495b",
    sizes=(0.1, 0.7),
    usual=0.4,
    load=_load,
    train=_train,
    may_touch=("foot", "toes"),
)
