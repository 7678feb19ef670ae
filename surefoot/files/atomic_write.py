"""Files that appear whole or not at all."""

import glob
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from surefoot.files.inputs import refuse_input
from surefoot.files.processes import has_ended

__all__ = ["whole_file"]


@contextmanager
def whole_file(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary file beside ``path``: it replaces ``path`` if the block succeeds, and is removed otherwise.

    Its name begins with a dot and contains the process id. Files left by killed processes are removed by the
    next one that writes to ``path``. Raises `SurefootError` if ``path`` is an input of this command.
    """
    target = Path(path)
    refuse_input(target)
    own = f".{target.name}."
    for left in target.parent.glob(f"{glob.escape(own)}*.part{glob.escape(target.suffix)}"):
        if has_ended(left.name.removeprefix(own).partition(".")[0]):
            left.unlink(missing_ok=True)
    handle, name = tempfile.mkstemp(
        dir=target.parent, prefix=f"{own}{os.getpid()}.", suffix=f".part{target.suffix}"
    )
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        umask = os.umask(0)
        os.umask(umask)
        temporary.chmod(0o666 & ~umask)
        with temporary.open("rb") as written:
            os.fsync(written.fileno())
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)
