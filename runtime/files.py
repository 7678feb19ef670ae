"""Files that appear whole or not at all."""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from runtime.errors import RuntimeInputError

__all__ = ["check_output_folder", "whole_file"]


@contextmanager
def whole_file(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A file beside ``path`` to write to: takes its place when the block ends well, vanishes otherwise."""
    target = Path(path)
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=".", suffix=target.suffix)
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        umask = os.umask(0)
        os.umask(umask)
        temporary.chmod(0o666 & ~umask)
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


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
