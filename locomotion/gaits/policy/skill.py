"""A learned policy on disk: its network and its reference motion."""

import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from locomotion.body.learned_file import RELEARN, SkillHeader, read_skill, speeds
from locomotion.body.person import person_digest
from locomotion.data import SKILLS
from locomotion.gaits.policy.layout import ACTIONS, INPUTS, JOINTS
from locomotion.gaits.policy.motion import Motion
from locomotion.gaits.policy.network_file import (
    Network,
    network_arrays,
    network_schema,
    read_network,
    weights,
)
from surefoot.files.archive import write_archive
from surefoot.files.schema import Numbers, Schema

__all__ = ["POLICY_FILE", "WALK_POLICY", "PolicySkill", "load_policy"]

WALK_POLICY = SKILLS / "walk_policy.npz"


@dataclass(frozen=True)
class PolicySkill:
    """How networks move the person.

    Attributes:
      motion: the reference motion.
      walk, stand, run: the networks for walking, for standing after that, and for running and slowing down
        from there.
      meta: what made it.
    """

    motion: Motion
    walk: Network
    stand: Network
    run: Network
    meta: dict[str, Any] = field(default_factory=dict)

    @property
    def tables(self) -> tuple[tuple[np.ndarray, ...], ...]:
        """The first arguments of `locomotion.gaits.policy.kernel.decide_tick`."""
        motion = self.motion
        tables = (
            motion.speeds, motion.periods, motion.joints, motion.rates, motion.stance, motion.means
        )  # fmt: skip
        return tables, self.walk, self.stand, self.run

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the policy for the present person; the file appears whole or not at all."""
        motion = self.motion
        arrays = {
            "speeds": motion.speeds, "periods": motion.periods, "stance": motion.stance,
            "joints": motion.joints.astype(np.float32), "rates": motion.rates.astype(np.float32),
            **network_arrays("walk", self.walk), **network_arrays("stand", self.stand),
            **network_arrays("run", self.run),
        }  # fmt: skip
        header = {"person": person_digest(), "joints": list(JOINTS), "meta": self.meta}
        write_archive(path, POLICY_FILE.kind, POLICY_FILE.version, header, arrays)


class _PolicyHeader(SkillHeader):
    joints: tuple[str, ...]


def _check(header: _PolicyHeader, arrays: dict[str, np.ndarray]) -> str | None:
    return None if header.joints == JOINTS else f"moves other joints than the {len(JOINTS)} of this release"


_N = len(JOINTS)
POLICY_FILE = Schema(
    kind="policy",
    version=4,
    header=_PolicyHeader,
    arrays={
        "speeds": speeds("speeds"),
        "periods": Numbers("speeds", low=0.01, high=100.0),
        "stance": Numbers(2, low=-1.0, high=1.0),
        "joints": weights("speeds+1", "samples", _N),
        "rates": weights("speeds+1", "samples", _N),
        **network_schema("walk", INPUTS, ACTIONS),
        **network_schema("stand", INPUTS, ACTIONS),
        **network_schema("run", INPUTS, ACTIONS),
    },
    remedy=RELEARN,
    check=_check,
)


def load_policy(path: str | os.PathLike[str] = WALK_POLICY) -> PolicySkill:
    """Read a policy; `LocomotionError` if it is missing, cut off, of another version or another person."""
    header, arrays = read_skill(path, POLICY_FILE)
    wide = {name: arrays[name].astype(np.float64) for name in ("joints", "rates")}
    motion = Motion(arrays["speeds"], arrays["periods"], wide["joints"], wide["rates"], arrays["stance"])
    walk, stand, run = (read_network(name, arrays) for name in ("walk", "stand", "run"))
    return PolicySkill(motion, walk, stand, run, header.meta)
