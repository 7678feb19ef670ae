"""The learned correction of braking on disk."""

import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from locomotion.body.learned_file import RELEARN, SkillHeader, read_skill
from locomotion.body.person import person_digest
from locomotion.data import SKILLS
from locomotion.gaits.policy.layout import JOINTS
from locomotion.gaits.policy.network_file import Network, network_arrays, network_schema, read_network
from locomotion.gaits.residual.layout import ACTIONS, INPUTS
from surefoot.files.archive import write_archive
from surefoot.files.schema import Schema

__all__ = ["BRAKE_RESIDUAL", "RESIDUAL_FILE", "ResidualSkill", "load_brake_residual"]

BRAKE_RESIDUAL = SKILLS / "brake_residual.npz"


@dataclass(frozen=True)
class ResidualSkill:
    """What corrects a planned gait.

    Attributes:
      network: it decides from `locomotion.gaits.residual.layout.INPUTS` numbers.
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
        write_archive(
            path, RESIDUAL_FILE.kind, RESIDUAL_FILE.version, header, network_arrays("residual", self.network)
        )


class _Header(SkillHeader):
    joints: tuple[str, ...]
    corrects: dict[str, str]


def _check(header: _Header, arrays: dict[str, np.ndarray]) -> str | None:
    return None if header.joints == JOINTS else f"moves other joints than the {len(JOINTS)} of this release"


RESIDUAL_FILE = Schema(
    "residual policy", 2, _Header, network_schema("residual", INPUTS, ACTIONS), remedy=RELEARN, check=_check
)


def load_brake_residual(path: str | os.PathLike[str] = BRAKE_RESIDUAL) -> ResidualSkill:
    """Read what corrects braking; `LocomotionError` if it is missing, cut off, of another version or another
    person."""
    header, arrays = read_skill(path, RESIDUAL_FILE)
    return ResidualSkill(read_network("residual", arrays), header.corrects, header.meta)
