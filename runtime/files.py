"""Files that appear whole or not at all."""

import os
from collections.abc import Sequence
from pathlib import Path

from navmesh.files.inputs import refuse_input
from navmesh.files.whole_file import whole_file
from runtime.errors import RuntimeInputError

__all__ = ["check_output_folder", "whole_file"]


def check_output_folder(path: str | os.PathLike[str], names: Sequence[str]) -> list[Path]:
    """The files ``names`` in ``path``, a folder that exists or can be made; makes nothing. Raises
    `RuntimeInputError` if it cannot, `navmesh.NavmeshError` if a file is an input of this command."""
    folder = Path(path)
    ancestor = folder
    while not ancestor.exists() and ancestor != ancestor.parent:
        ancestor = ancestor.parent
    if not ancestor.is_dir():
        raise RuntimeInputError(f"{folder}: {str(ancestor)!r} is not a folder; results need one")
    if not os.access(ancestor, os.W_OK):
        raise RuntimeInputError(f"{folder}: {str(ancestor)!r} may not be written to")
    files = [folder / name for name in names]
    for file in files:
        refuse_input(file)
    return files
