"""The folder in which a training keeps what it has learned so far, and the configuration that it belongs to:
everything that decides what is learned, apart from the code."""

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from locomotion.errors import LocomotionError
from surefoot.errors import SurefootError
from surefoot.files.archive import ArchiveError, read_archive
from surefoot.files.atomic_write import whole_file
from surefoot.files.jsonfile import read_json
from surefoot.files.schema import HeaderType, Schema

__all__ = ["CONFIGURATION", "anew", "claim", "read_checkpoint"]

CONFIGURATION = "configuration.json"
"""File in the folder of a training that says what it belongs to."""


def claim(folder: Path, configuration: Mapping[str, Any]) -> None:
    """Make ``folder`` that of the training with a ``configuration``, which JSON can express, or see that it
    is.

    Raises `LocomotionError` if it belongs to another configuration, or holds anything else.
    """
    if folder.exists() and not folder.is_dir():
        raise LocomotionError(f"{folder}: is no folder; what is learned is kept in one (--checkpoint)")
    file = folder / CONFIGURATION
    if not file.exists():
        # a name with a dot is what a process left that was killed while it wrote the file
        if folder.exists() and any(not each.name.startswith(".") for each in folder.iterdir()):
            raise LocomotionError(
                f"{folder}: holds files but no {CONFIGURATION}, so they are no training that can go on; "
                "move them away, or keep this training elsewhere (--checkpoint)"
            )
        folder.mkdir(parents=True, exist_ok=True)
        with whole_file(file) as temporary:
            temporary.write_text(json.dumps(configuration, indent=1) + "\n", encoding="utf-8")
        return
    otherwise = f"remove {folder} to begin anew, or keep this training elsewhere (--checkpoint)"
    try:
        found = read_json(file, "training's configuration")
    except SurefootError as error:
        raise LocomotionError(f"{error}; {otherwise}") from None
    if not isinstance(found, dict):
        raise LocomotionError(f"{file}: not a training's configuration: it is no mapping; {otherwise}")
    wanted = json.loads(json.dumps(configuration))
    different = [key for key in {**wanted, **found} if wanted.get(key) != found.get(key)]
    if different:
        raise LocomotionError(
            f"{folder}: holds what was learned with another configuration, which differs in "
            f"{', '.join(different)} (see {file}); {otherwise}"
        )


def anew(path: str | os.PathLike[str]) -> str:
    """What a user does about a file of what was learned so far that is of no use."""
    return f"remove {path} to learn this part anew"


def read_checkpoint(path: Path, schema: Schema[HeaderType]) -> tuple[HeaderType, dict[str, np.ndarray]]:
    """Header and arrays of a file of what was learned so far; `LocomotionError` if it is damaged or of
    another version."""
    try:
        return read_archive(path, schema)
    except ArchiveError as error:
        raise LocomotionError(str(error)) from error
