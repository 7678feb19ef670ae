"""Keep a command from overwriting its inputs: they are noted, and writing to one is refused.

Has no effect in programs that use the library, which may well save what they have loaded.
"""

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from surefoot.errors import SurefootError

__all__ = ["keep_inputs", "note_input", "refuse_input"]

_kept: dict[tuple[int, int], Path] | None = None
"""Inputs so far by device and inode, so that links and other spellings count as the same file."""


@contextmanager
def keep_inputs(paths: Iterable[str | os.PathLike[str]] = ()) -> Iterator[None]:
    """Within this block, ``paths`` and the files given to `note_input` cannot be written to."""
    global _kept
    before, _kept = _kept, {}
    for path in paths:
        note_input(path)
    try:
        yield
    finally:
        _kept = before


def note_input(path: str | os.PathLike[str]) -> None:
    """Note that ``path`` is read. A missing file is ignored here; its reader reports it."""
    if _kept is None or not os.path.isfile(path):
        return
    status = os.stat(path)
    _kept.setdefault((status.st_dev, status.st_ino), Path(path))


def refuse_input(path: str | os.PathLike[str]) -> None:
    """Raise `SurefootError` if writing to ``path`` would overwrite an input."""
    if not _kept or not os.path.exists(path):
        return
    status = os.stat(path)
    found = _kept.get((status.st_dev, status.st_ino))
    if found is not None:
        same = "" if os.fspath(found) == os.fspath(path) else f"the same file as {found}, "
        raise SurefootError(f"{path}: is {same}an input of this command; choose another output file")
