"""The skills that a body clears obstacles with: those that come with the package, and one's own."""

import hashlib
import os
from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from weakref import WeakSet

import numpy as np

from locomotion.data import CLIPS, PRECONDITIONS, SKILLS
from locomotion.gaits.run.skill import RunSkill, load_run_skill
from locomotion.skills.description import load_described, load_description
from locomotion.skills.interface import ClearingSkill, skill_ranges
from locomotion.skills.learned_skill import LearnedSkill
from locomotion.skills.registry import skill_kinds

__all__ = [
    "LEARNED", "comes_with_package", "described_ranges", "different", "learned_digest", "learned_skills",
    "package_skill", "skill_digest", "skills_digest",
]  # fmt: skip

LEARNED = ("skills of the package", "skills of their own", "preconditions")
"""What people can have learned in another way."""
_of_package: WeakSet[ClearingSkill] = WeakSet()
"""Those that `learned_skills` has loaded for the package's run."""


def package_skill(name: str) -> Path:
    """File of one of the package's skills, with dashes in its name as underscores."""
    return SKILLS / f"{name.replace('-', '_')}.npz"


def skill_digest(name: str) -> str:
    """Hex digest of one of the package's skills, with its clip, as their files are now."""
    learned = package_skill(name)
    clip = CLIPS / f"{learned.stem}.yaml"
    return _digest_now([learned, clip] if clip.exists() else [learned])


def skills_digest(own: tuple[Path, ...] = ()) -> str:
    """Hex digest of everything that the package has learned and of the skills described by ``own``, as their
    files are now: a person does the same only with the same."""
    return _digest_now([*_package_files(), *_own_files(own)])


def learned_digest(own: tuple[Path, ...] = ()) -> str:
    """Hex digests of all that `skills_digest` is of, and of the preconditions of the package's skills, one
    for each of `LEARNED`."""
    files = _package_files(), _own_files(own), sorted(PRECONDITIONS.glob("*.npz"))
    return " ".join(map(_digest_now, files))


def different(one: str, other: str) -> list[str]:
    """Those of `LEARNED` in which two `learned_digest` differ; all of them if one is no such digest."""
    some, others = one.split(" "), other.split(" ")
    if not len(some) == len(others) == len(LEARNED):
        return [*LEARNED]
    return [name for name, here, there in zip(LEARNED, some, others, strict=True) if here != there]


def _package_files() -> list[Path]:
    return sorted(SKILLS.glob("*.npz"))


def _own_files(own: tuple[Path, ...]) -> list[Path]:
    files: list[Path] = []
    for path in own:
        description = load_description(path)
        files += [path, description.clip, description.learned]
    return files


def _digest_now(files: Sequence[Path]) -> str:
    stats = [file.stat() for file in files]
    return _digest(tuple(files), tuple((stat.st_mtime_ns, stat.st_size) for stat in stats))


@lru_cache(maxsize=8)
def _digest(files: tuple[Path, ...], stamps: tuple[tuple[int, int], ...]) -> str:
    """``stamps``: when the files were changed and their sizes, so that what is kept belongs to them."""
    hasher = hashlib.sha256()
    for file in files:
        hasher.update(file.name.encode() + file.read_bytes())
    return hasher.hexdigest()[:16]


def described_ranges(run: RunSkill, own: Sequence[str | os.PathLike[str]]) -> dict[str, tuple[float, float]]:
    """Least and greatest size [m] that the skills described by the files ``own`` have learned, by
    affordance. `LocomotionError` for files with a mistake."""
    ranges: dict[str, tuple[float, float]] = {}
    for path in own:
        skill = load_described(path, run)
        low, high = ranges.get(skill.affordance, skill.heights)
        ranges[skill.affordance] = min(low, skill.heights[0]), max(high, skill.heights[1])
    return ranges


def learned_skills(run: RunSkill, own: Sequence[str | os.PathLike[str]] = ()) -> tuple[ClearingSkill, ...]:
    """What clears obstacles on top of a run: the skills described by the files ``own``
    (`locomotion.skills.description`), and then those of all kinds (`locomotion.skills.registry`) that have
    been learned. `LocomotionError` for files with a mistake, and where the skills for one kind of obstacle
    leave out sizes in between."""
    described = [load_described(path, run) for path in own]
    of_kinds = [skill for kind in skill_kinds() if (skill := kind.load(run)) is not None]
    skill_ranges([*described, *of_kinds])
    if _are_equal(run.tables, load_run_skill().tables):
        _of_package.update(skill for skill in of_kinds if isinstance(skill, LearnedSkill))
    return (*described, *of_kinds)


def comes_with_package(skill: ClearingSkill) -> bool:
    """Whether ``skill`` is one that `learned_skills` gave for a kind of obstacle, on top of the package's
    run: what is known of the package's skills holds of it. No copy is one, and none of one's own."""
    return isinstance(skill, LearnedSkill) and skill in _of_package


def _are_equal(some: Iterable[np.ndarray], others: Iterable[np.ndarray]) -> bool:
    return all(np.array_equal(one, other) for one, other in zip(some, others, strict=True))
