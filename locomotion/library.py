"""The skills that come with the package, for a body to clear obstacles with."""

import hashlib
from functools import lru_cache
from pathlib import Path

from locomotion.clearing import ClearingSkill
from locomotion.drop_roll_skill import DROP_ROLL_SKILL, DropRoll, load_drop_roll_skill
from locomotion.jump_skill import JUMP_SKILL, Jump, load_jump_skill
from locomotion.skill import RunSkill
from locomotion.vault_skill import VAULT_SKILL, Vault, load_vault_skill

__all__ = ["learned_skills", "skills_digest"]


@lru_cache(maxsize=1)
def skills_digest() -> str:
    """Hex digest of everything that the package has learned: a person does the same only with the same."""
    hasher = hashlib.sha256()
    for file in sorted((Path(__file__).parent / "skills").glob("*.npz")):
        hasher.update(file.name.encode() + file.read_bytes())
    return hasher.hexdigest()[:16]


def learned_skills(run: RunSkill) -> tuple[ClearingSkill, ...]:
    """What the package has learned to clear, on top of a run."""
    skills: list[ClearingSkill] = []
    if JUMP_SKILL.exists():
        skills.append(Jump(load_jump_skill(), run))
    if VAULT_SKILL.exists():
        skills.append(Vault(load_vault_skill(), run))
    if DROP_ROLL_SKILL.exists():
        skills.append(DropRoll(load_drop_roll_skill()))
    return tuple(skills)
