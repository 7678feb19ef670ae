"""A learned policy on disk: its network and its reference motion."""

import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from locomotion.body.learned_file import RELEARN, SkillHeader, read_skill, speeds
from locomotion.body.person import person_digest
from locomotion.data import SKILLS
from locomotion.gaits.policy.layout import ACTIONS, INPUTS, JOINTS
from locomotion.gaits.policy.motion import Motion
from surefoot.files.archive import write_archive
from surefoot.files.schema import Numbers, Schema

__all__ = ["POLICY_FILE", "WALK_POLICY", "Network", "PolicySkill", "load_policy"]

WALK_POLICY = SKILLS / "walk_policy.npz"
_PARTS = ("mean", "deviation", "w0", "b0", "w1", "b1", "w2", "b2")

Network = tuple[NDArray[np.float32], ...]
"""Mean and deviation (82,) of the observations, then weights (inputs, outputs) and biases of three layers."""


@dataclass(frozen=True)
class PolicySkill:
    """How networks move the person.

    Attributes:
      motion: the reference motion.
      walk, stand: the networks for walking, and for standing after that.
      meta: what made it.
    """

    motion: Motion
    walk: Network
    stand: Network
    meta: dict[str, Any] = field(default_factory=dict)

    @property
    def tables(self) -> tuple[tuple[np.ndarray, ...], ...]:
        """The first arguments of `locomotion.gaits.policy.kernel.decide_tick`."""
        motion = self.motion
        tables = (motion.speeds, motion.periods, motion.joints, motion.rates, motion.stance)
        return tables, self.walk, self.stand

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the policy for the present person; the file appears whole or not at all."""
        motion = self.motion
        arrays = {
            "speeds": motion.speeds, "periods": motion.periods, "stance": motion.stance,
            "joints": motion.joints.astype(np.float32), "rates": motion.rates.astype(np.float32),
            **{f"walk_{name}": array for name, array in zip(_PARTS, self.walk, strict=True)},
            **{f"stand_{name}": array for name, array in zip(_PARTS, self.stand, strict=True)},
        }  # fmt: skip
        header = {"person": person_digest(), "joints": list(JOINTS), "meta": self.meta}
        write_archive(path, POLICY_FILE.kind, POLICY_FILE.version, header, arrays)


class _PolicyHeader(SkillHeader):
    joints: tuple[str, ...]


def _check(header: _PolicyHeader, arrays: dict[str, np.ndarray]) -> str | None:
    return None if header.joints == JOINTS else f"moves other joints than the {len(JOINTS)} of this release"


def _weights(*shape: int | str) -> Numbers:
    return Numbers(*shape, low=-1e6, high=1e6, dtype="float32")


def _network(name: str) -> dict[str, Numbers]:
    return {
        f"{name}_mean": _weights(INPUTS),
        f"{name}_deviation": Numbers(INPUTS, low=1e-6, high=1e6, dtype="float32"),
        f"{name}_w0": _weights(INPUTS, f"{name} first"),
        f"{name}_b0": _weights(f"{name} first"),
        f"{name}_w1": _weights(f"{name} first", f"{name} second"),
        f"{name}_b1": _weights(f"{name} second"),
        f"{name}_w2": _weights(f"{name} second", ACTIONS),
        f"{name}_b2": _weights(ACTIONS),
    }


_N = len(JOINTS)
POLICY_FILE = Schema(
    kind="policy",
    version=2,
    header=_PolicyHeader,
    arrays={
        "speeds": speeds("speeds"),
        "periods": Numbers("speeds", low=0.01, high=100.0),
        "stance": Numbers(2, low=-1.0, high=1.0),
        "joints": _weights("speeds+1", "samples", _N),
        "rates": _weights("speeds+1", "samples", _N),
        **_network("walk"),
        **_network("stand"),
    },
    remedy=RELEARN,
    check=_check,
)


def load_policy(path: str | os.PathLike[str] = WALK_POLICY) -> PolicySkill:
    """Read a policy; `LocomotionError` if it is missing, cut off, of another version or another person."""
    header, arrays = read_skill(path, POLICY_FILE)
    wide = {name: arrays[name].astype(np.float64) for name in ("joints", "rates")}
    motion = Motion(arrays["speeds"], arrays["periods"], wide["joints"], wide["rates"], arrays["stance"])
    walk, stand = (
        tuple(np.ascontiguousarray(arrays[f"{name}_{part}"]) for part in _PARTS) for name in ("walk", "stand")
    )
    return PolicySkill(motion, walk, stand, header.meta)
