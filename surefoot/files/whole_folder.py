"""Folders that appear whole or not at all."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from surefoot.errors import SurefootError
from surefoot.files.inputs import refuse_input
from surefoot.files.processes import has_ended

__all__ = ["check_folder_target", "whole_folder"]


def check_folder_target(path: str | os.PathLike[str], mark: str) -> None:
    """Check before long work that `whole_folder` can write to ``path``. Raises `SurefootError` if not."""
    target = Path(path)
    if not target.parent.is_dir():
        raise SurefootError(f"{target}: no folder {str(target.parent)!r} to write to")
    if not os.access(target.parent, os.W_OK):
        raise SurefootError(f"{target}: the folder {str(target.parent)!r} is not writable")
    if target.exists() and not target.is_dir():
        raise SurefootError(f"{target}: is a file; give a folder")
    if target.is_dir() and any(target.iterdir()) and not (target / mark).is_file():
        raise SurefootError(f"{target}: holds other files (and no {mark}); give an empty folder or a new one")
    refuse_input(target / mark)


@contextmanager
def whole_folder(path: str | os.PathLike[str], mark: str) -> Iterator[Path]:
    """A temporary folder beside ``path``: it takes the place of ``path`` if the block succeeds, and is
    removed otherwise. Only an empty folder, or one with a file ``mark``, is replaced.

    Its name begins with a dot and contains the process id. Folders left by killed processes are removed by
    the next one that writes to ``path``. Raises `SurefootError` if ``path`` cannot be written.
    """
    target = Path(path)
    check_folder_target(target, mark)
    own = f".{target.name}."
    for left in target.parent.iterdir():
        name = left.name
        if name.startswith(own) and name.endswith(".part") and has_ended(name[len(own) :].partition(".")[0]):
            shutil.rmtree(left, ignore_errors=True)
    temporary = Path(tempfile.mkdtemp(dir=target.parent, prefix=f"{own}{os.getpid()}.", suffix=".part"))
    try:
        yield temporary
        umask = os.umask(0)
        os.umask(umask)
        temporary.chmod(0o777 & ~umask)
        if target.exists():
            before = Path(tempfile.mkdtemp(dir=target.parent, prefix=f"{own}{os.getpid()}.", suffix=".part"))
            target.rename(before / "before")
            temporary.rename(target)
            shutil.rmtree(before, ignore_errors=True)
        else:
            temporary.rename(target)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
