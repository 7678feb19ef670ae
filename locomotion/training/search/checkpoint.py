"""The checkpoint folder of a training: intermediate results, and the configuration that they belong to, which
is everything that decides the result apart from the code."""

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
"""File in the folder with the training's configuration."""


def claim(folder: Path, configuration: Mapping[str, Any]) -> None:
    """Claim ``folder`` for the training with a ``configuration``, which must be JSON values.

    Raises `LocomotionError` if it belongs to another configuration, or holds anything else.
    """
    if folder.exists() and not folder.is_dir():
        raise LocomotionError(f"{folder}: not a folder; checkpoints need one (--checkpoint)")
    file = folder / CONFIGURATION
    if not file.exists():
        # a dotted name is left over from a process killed while writing the file
        if folder.exists() and any(not each.name.startswith(".") for each in folder.iterdir()):
            raise LocomotionError(
                f"{folder}: holds files but no {CONFIGURATION}, so they are not a checkpoint; "
                "move them away, or use another folder (--checkpoint)"
            )
        folder.mkdir(parents=True, exist_ok=True)
        with whole_file(file) as temporary:
            temporary.write_text(json.dumps(configuration, indent=1) + "\n", encoding="utf-8")
        return
    otherwise = f"remove {folder} to start over, or use another folder (--checkpoint)"
    try:
        found = read_json(file, "training's configuration")
    except SurefootError as error:
        raise LocomotionError(f"{error}; {otherwise}") from None
    if not isinstance(found, dict):
        raise LocomotionError(f"{file}: not a training's configuration: not a mapping; {otherwise}")
    wanted = json.loads(json.dumps(configuration))
    different = [key for key in {**wanted, **found} if wanted.get(key) != found.get(key)]
    if different:
        raise LocomotionError(
            f"{folder}: belongs to another configuration, which differs in "
            f"{', '.join(different)} (see {file}); {otherwise}"
        )


def anew(path: str | os.PathLike[str]) -> str:
    """Advice for a user with an unusable file of intermediate results."""
    return f"remove {path} to train this part again"


def read_checkpoint(path: Path, schema: Schema[HeaderType]) -> tuple[HeaderType, dict[str, np.ndarray]]:
    """Header and arrays of a file of intermediate results; raises `LocomotionError` if it is damaged or of
    another version."""
    try:
        return read_archive(path, schema)
    except ArchiveError as error:
        raise LocomotionError(str(error)) from error
