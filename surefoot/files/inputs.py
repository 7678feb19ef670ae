"""What a command reads is never what it writes: its inputs are noted, and writing over one is refused.

Inert in a program that uses the library, which may well save what it has loaded.
"""

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from surefoot.errors import SurefootError

__all__ = ["keep_inputs", "note_input", "refuse_input"]

_kept: dict[tuple[int, int], Path] | None = None
"""The inputs so far, by device and inode: a link or another spelling is the same file."""


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
    """Note that ``path`` is read. A path that names no file is none, for whoever reads it to say so."""
    if _kept is None or not os.path.isfile(path):
        return
    status = os.stat(path)
    _kept.setdefault((status.st_dev, status.st_ino), Path(path))


def refuse_input(path: str | os.PathLike[str]) -> None:
    """Raises `SurefootError` if writing to ``path`` would replace an input."""
    if not _kept or not os.path.exists(path):
        return
    status = os.stat(path)
    found = _kept.get((status.st_dev, status.st_ino))
    if found is not None:
        same = "" if os.fspath(found) == os.fspath(path) else f"the same file as {found}, "
        raise SurefootError(f"{path}: is {same}an input of this command; name another file to write to")
