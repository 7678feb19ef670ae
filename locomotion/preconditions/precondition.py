"""Learned preconditions on disk and in memory, and what they are asked."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from locomotion.body.learned_file import SkillHeader, learned_numbers, read_skill
from locomotion.body.person import person_digest
from locomotion.data import PRECONDITIONS
from locomotion.errors import LocomotionError
from locomotion.preconditions.changes import CHANGE_FEATURES, CHANGES
from locomotion.preconditions.features import BEFORE, FEATURES
from locomotion.preconditions.svm import Machine, odds_into
from locomotion.skills.interface import covers
from locomotion.skills.library import package_skill, skill_digest
from locomotion.skills.registry import skill_kinds
from surefoot.files.archive import write_archive
from surefoot.files.schema import Indices, Numbers, Schema

__all__ = [
    "PRECONDITION_FILE", "Precondition", "features_of", "load_precondition", "load_preconditions",
    "outdated_preconditions", "precondition_file", "skill_and_run",
]  # fmt: skip

_SMALLEST = 1e-9


@dataclass(frozen=True)
class Precondition:
    """The odds that a skill holds.

    Attributes:
        skill: which, as missions call it, or one of `changes.CHANGES`. heights: least and greatest size [m]
            that it has learned; 0 of a change.
        run_up: asked at each step of a run-up, of `features.FEATURES`, or before a change, of
            `changes.CHANGE_FEATURES`. before: asked before a run-up, of `features.BEFORE`; None of a change.
        digest: of the skill and the run that it was learned on.
        meta: what made it.
    """

    skill: str
    heights: tuple[float, float]
    run_up: Machine
    before: Machine | None
    digest: str
    meta: dict[str, Any] = field(default_factory=dict)

    def covers(self, size: float) -> bool:
        """Whether an obstacle of this ``size`` [m] is one that it has learned; what was sampled beyond only
        says how odds fall towards the ends of that range."""
        return covers(self.heights, size)

    def odds_before(self, features: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k,) odds, 0 to 1, before the run-up to obstacles described by ``features`` (k, 4), see
        `features.before_run_up`."""
        assert self.before is not None
        return self._ask(self.before, features)

    def odds(self, features: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k,) odds, 0 to 1, at moments of a run-up, or before a change, described by ``features`` (k, n)."""
        return self._ask(self.run_up, features)

    @staticmethod
    def _ask(machine: Machine, features: NDArray[np.float64]) -> NDArray[np.float64]:
        out = np.empty(len(features))
        odds_into(*machine, features, out)
        return out

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write it for the present person; the file appears whole or not at all."""
        arrays = {
            f"{name}_{part}": array
            for name, machine in (("run_up", self.run_up), ("before", self.before))
            if machine is not None
            for part, array in machine._asdict().items()
        }
        header = {
            "person": person_digest(), "skill": self.skill, "heights": list(self.heights),
            "digest": self.digest, "before": self.before is not None, "meta": self.meta,
            "features": list(features_of(self.skill)),
        }  # fmt: skip
        write_archive(path, PRECONDITION_FILE.kind, PRECONDITION_FILE.version, header, arrays)


class _PreconditionHeader(SkillHeader):
    skill: str
    heights: tuple[float, float]
    digest: str
    before: bool
    features: tuple[str, ...]


def _machine(name: str, features: tuple[str, ...]) -> dict[str, Any]:
    wide, many = f"{name} features", f"{name} centres"
    return {
        f"{name}_columns": Indices(wide, into=len(features)),
        f"{name}_low": learned_numbers(wide),
        f"{name}_high": learned_numbers(wide),
        f"{name}_mean": learned_numbers(wide),
        f"{name}_scale": Numbers(wide, low=_SMALLEST, high=1e6),
        f"{name}_centres": learned_numbers(wide, many),
        f"{name}_weights": learned_numbers(many),
        f"{name}_numbers": learned_numbers(4),
    }


def _arrays(header: _PreconditionHeader) -> dict[str, Any]:
    before = _machine("before", BEFORE) if header.before else {}
    return _machine("run_up", features_of(header.skill)) | before


def _check(header: _PreconditionHeader, arrays: dict[str, NDArray[Any]]) -> str | None:
    return (
        None
        if header.features == features_of(header.skill)
        else "was learned of other features than this release's"
    )


PRECONDITION_FILE = Schema(
    kind="precondition",
    version=1,
    header=_PreconditionHeader,
    arrays=_arrays,
    remedy="learn it anew (surefoot train preconditions)",
    check=_check,
)


def features_of(skill: str) -> tuple[str, ...]:
    """What the odds of a ``skill`` or a change are asked of."""
    return CHANGE_FEATURES if skill in CHANGES else FEATURES


def skill_and_run(skill: str) -> str:
    """Hex digest of one of the package's skills, or of what a change is made of, and of the run under it, as
    their files are now."""
    return f"{skill_digest(CHANGES.get(skill, skill))}{skill_digest('run')}"


def precondition_file(skill: str) -> Path:
    """File of the package's precondition of a ``skill``."""
    return PRECONDITIONS / f"{skill.replace('-', '_')}.npz"


def load_precondition(path: str | os.PathLike[str]) -> Precondition:
    """Read a precondition; `LocomotionError` if it is missing, damaged, of another version or person, or if
    the skill has been learned anew since."""
    header, arrays = read_skill(path, PRECONDITION_FILE)
    if header.digest != skill_and_run(header.skill):
        raise LocomotionError(
            f"{path}: the {header.skill} or the run under it has changed since; {PRECONDITION_FILE.remedy}"
        )
    run_up, before = (
        Machine(*(arrays[f"{name}_{part}"] for part in Machine._fields)) if asked else None
        for name, asked in (("run_up", True), ("before", header.before))
    )
    assert run_up is not None
    return Precondition(header.skill, header.heights, run_up, before, header.digest, header.meta)


def outdated_preconditions() -> list[str]:
    """Skills of the package whose precondition belongs to another skill, or another run under it, than
    theirs are now."""
    outdated = []
    for skill in (*(kind.skill for kind in skill_kinds()), *CHANGES):
        file, made_of = precondition_file(skill), package_skill(CHANGES.get(skill, skill))
        if file.exists() and made_of.exists() and package_skill("run").exists():
            if read_skill(file, PRECONDITION_FILE)[0].digest != skill_and_run(skill):
                outdated.append(skill)
    return outdated


@lru_cache(maxsize=1)
def load_preconditions() -> Mapping[str, Precondition]:
    """The package's preconditions by affordance, of those skills that have one, and of all `CHANGES`. Read
    once; raises `LocomotionError` as `load_precondition` does."""
    files = {kind.affordance: precondition_file(kind.skill) for kind in skill_kinds()}
    known = {asked: load_precondition(file) for asked, file in files.items() if file.exists()}
    return known | {name: load_precondition(precondition_file(name)) for name in CHANGES}
