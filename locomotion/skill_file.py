"""Files of what the person has learned: archives that belong to one model of the person."""

import os
from typing import Any

import numpy as np

from locomotion.errors import LocomotionError
from locomotion.person import person_digest
from navmesh.files.archive import ArchiveError, read_archive

__all__ = ["read_skill"]


def read_skill(
    path: str | os.PathLike[str], kind: str, version: int
) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Header and arrays of a "run skill", "walk skill" or "jump skill"; `LocomotionError` if it is missing,
    cut off, of another kind or version, or of another person."""
    try:
        header, arrays = read_archive(path, kind, version)
    except ArchiveError as error:
        raise LocomotionError(str(error)) from error
    if header.get("person") != person_digest():
        raise LocomotionError(f"{path}: learned for another person's model; learn it anew (surefoot train)")
    return header, arrays
