"""Files of what a person has learned: archives tied to one model of the person."""

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
    """``person``: digest of the person's model at training. ``meta``: how it was made."""

    person: str
    meta: dict[str, Any] = Field(default_factory=dict)


HeaderType = TypeVar("HeaderType", bound=SkillHeader)


def learned_numbers(*shape: Size) -> Numbers:
    """Learned numbers in an archive."""
    return Numbers(*shape, low=-_GREATEST, high=_GREATEST)


def speeds(size: Size, least: int = 2) -> Rising:
    """Speeds at which something was learned [m/s], in an archive; at least ``least`` of them."""
    return Rising(size, least, low=0.0, high=20.0)


def read_skill(
    path: str | os.PathLike[str], schema: Schema[HeaderType]
) -> tuple[HeaderType, dict[str, np.ndarray]]:
    """Header and arrays of a learned file. Raises `LocomotionError` if it is missing, cut off, of another
    kind, version or person, or does not match the ``schema``."""
    pause()
    try:
        header, arrays = read_archive(path, schema)
    except ArchiveError as error:
        raise LocomotionError(str(error)) from error
    if header.person != person_digest():
        raise LocomotionError(f"{path}: learned for another person's model; learn it anew (surefoot train)")
    return header, arrays
