"""Files that appear whole or not at all."""

import os
from pathlib import Path

from navmesh.files.whole_file import whole_file
from runtime.errors import RuntimeInputError

__all__ = ["check_output_folder", "whole_file"]


def check_output_folder(path: str | os.PathLike[str]) -> Path:
    """``path`` as a folder that exists or can be made; `RuntimeInputError` if not. Makes nothing."""
    folder = Path(path)
    ancestor = folder
    while not ancestor.exists() and ancestor != ancestor.parent:
        ancestor = ancestor.parent
    if not ancestor.is_dir():
        raise RuntimeInputError(f"{folder}: {str(ancestor)!r} is not a folder; results need one")
    if not os.access(ancestor, os.W_OK):
        raise RuntimeInputError(f"{folder}: {str(ancestor)!r} may not be written to")
    return folder
