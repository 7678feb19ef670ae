"""Folders for results."""

import os
from collections.abc import Sequence
from pathlib import Path

from surefoot.errors import SurefootError
from surefoot.files.inputs import refuse_input

__all__ = ["check_output_folder"]


def check_output_folder(path: str | os.PathLike[str], names: Sequence[str]) -> list[Path]:
    """Paths of the files ``names`` in ``path``, a folder that exists or can be made; creates nothing. Raises
    `SurefootError` if it cannot be made, or if a file is an input of this command."""
    folder = Path(path)
    ancestor = folder
    while not ancestor.exists() and ancestor != ancestor.parent:
        ancestor = ancestor.parent
    if not ancestor.is_dir():
        raise SurefootError(f"{folder}: {str(ancestor)!r} is not a folder; give one for the results")
    if not os.access(ancestor, os.W_OK):
        raise SurefootError(f"{folder}: {str(ancestor)!r} is not writable")
    files = [folder / name for name in names]
    for file in files:
        refuse_input(file)
    return files
