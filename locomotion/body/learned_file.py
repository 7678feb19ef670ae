"""Files of what the person has learned: archives that belong to one model of the person."""

import os
from typing import Any, TypeVar

import numpy as np
from pydantic import Field

from locomotion.body.person import person_digest
from locomotion.errors import LocomotionError
from surefoot.files.archive import ArchiveError, read_archive
from surefoot.files.schema import Header, Numbers, Rising, Schema, Size
from surefoot.pausing import pause

__all__ = ["RELEARN", "SkillHeader", "learned_numbers", "read_skill", "speeds"]

RELEARN = "learn it anew (surefoot train)"
_GREATEST = 1e6  # of a learned number


class SkillHeader(Header):
    """``person``: digest of the model of the person that learned it. ``meta``: what made it."""

    person: str
    meta: dict[str, Any] = Field(default_factory=dict)


HeaderType = TypeVar("HeaderType", bound=SkillHeader)


def learned_numbers(*shape: Size) -> Numbers:
    """Learned numbers, in an archive."""
    return Numbers(*shape, low=-_GREATEST, high=_GREATEST)


def speeds(size: Size, least: int = 2) -> Rising:
    """At which something was learned [m/s], in an archive; ``least``: how many there are at least."""
    return Rising(size, least, low=0.0, high=20.0)


def read_skill(
    path: str | os.PathLike[str], schema: Schema[HeaderType]
) -> tuple[HeaderType, dict[str, np.ndarray]]:
    """Header and arrays of what was learned; `LocomotionError` if it is missing, cut off, of another kind or
    version, of another person, or not as the ``schema`` says."""
    pause()
    try:
        header, arrays = read_archive(path, schema)
    except ArchiveError as error:
        raise LocomotionError(str(error)) from error
    if header.person != person_digest():
        raise LocomotionError(f"{path}: learned for another person's model; learn it anew (surefoot train)")
    return header, arrays
