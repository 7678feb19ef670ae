"""The vault over a wall, as all packages know it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from locomotion.gaits.run.skill import RunSkill
from locomotion.skills.kind import SkillKind
from locomotion.skills.vault.skill import VAULT_SKILL, Vault, load_vault_skill
from navmesh.obstacles.kinds import kind_of

if TYPE_CHECKING:
    from locomotion.training.training import Training

__all__ = ["VAULT"]


def _load(run: RunSkill) -> Vault | None:
    return Vault(load_vault_skill(), run) if VAULT_SKILL.exists() else None


def _train(training: Training, out: Path) -> None:
    from locomotion.training.skills.vault import train_vault

    train_vault(training, out)


VAULT = SkillKind(
    obstacle=kind_of("vault"),
    skill="vault",
    status="vaulting",
    verb="vault",
    does="vaults over {:.2f} m",
    colour="#8e44ad",
    sizes=(0.6, 1.0),
    usual=0.7,
    load=_load,
    train=_train,
    may_touch=("hand", "forearm"),
    holds_on=True,
)
