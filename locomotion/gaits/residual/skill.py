"""The learned corrections of braking and of landing on disk."""

import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from locomotion.body.learned_file import RELEARN, SkillHeader, read_skill
from locomotion.body.person import person_digest
from locomotion.data import SKILLS
from locomotion.gaits.policy.layout import JOINTS
from locomotion.gaits.policy.network_file import Network, network_arrays, network_schema, read_network
from locomotion.gaits.residual.layout import ACTIONS, INPUTS, LANDING_INPUTS
from surefoot.files.archive import write_archive
from surefoot.files.schema import Schema

__all__ = [
    "BRAKE_RESIDUAL", "LANDING_RESIDUAL", "ResidualSkill", "load_brake_residual", "load_landing_residual",
]  # fmt: skip

BRAKE_RESIDUAL, LANDING_RESIDUAL = SKILLS / "brake_residual.npz", SKILLS / "landing_residual.npz"
_KIND, _VERSION = "residual policy", 2


@dataclass(frozen=True)
class ResidualSkill:
    """What corrects a planned motion.

    Attributes:
      network: it decides from ``INPUTS`` (braking) or ``LANDING_INPUTS`` numbers of
        `locomotion.gaits.residual.layout`.
      corrects: digests of the skills that it was learned on, by name (`locomotion.skills.library`).
      meta: what made it.
    """

    network: Network
    corrects: dict[str, str] = field(default_factory=dict)
    meta: dict[str, Any] = field(default_factory=dict)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the skill for the present person; the file appears whole or not at all."""
        header = {"person": person_digest(), "joints": list(JOINTS)}
        header |= {"corrects": self.corrects, "meta": self.meta}
        write_archive(path, _KIND, _VERSION, header, network_arrays("residual", self.network))


class _Header(SkillHeader):
    joints: tuple[str, ...]
    corrects: dict[str, str]


def _check(header: _Header, arrays: dict[str, np.ndarray]) -> str | None:
    return None if header.joints == JOINTS else f"moves other joints than the {len(JOINTS)} of this release"


def load_brake_residual(path: str | os.PathLike[str] = BRAKE_RESIDUAL) -> ResidualSkill:
    """Read what corrects braking; `LocomotionError` if it is missing, cut off, of another version or another
    person."""
    return _read(path, INPUTS)


def load_landing_residual(path: str | os.PathLike[str] = LANDING_RESIDUAL) -> ResidualSkill:
    """Read what corrects landings; errors as of `load_brake_residual`."""
    return _read(path, LANDING_INPUTS)


def _read(path: str | os.PathLike[str], inputs: int) -> ResidualSkill:
    arrays = network_schema("residual", inputs, ACTIONS)
    header, arrays = read_skill(path, Schema(_KIND, _VERSION, _Header, arrays, remedy=RELEARN, check=_check))
    return ResidualSkill(read_network("residual", arrays), header.corrects, header.meta)
