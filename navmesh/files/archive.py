"""Archives for baked and learned data: a NumPy ``.npz`` with a JSON header, written atomically.

The header says what the file is (``kind``), the version of its format, and whatever its writer adds
(what made it, the digest of what it depends on). Arrays are stored without pickling.
"""

import json
import os
import tokenize
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.files.inputs import refuse_input
from navmesh.files.whole_file import whole_file

__all__ = ["ArchiveError", "check_target", "read_archive", "write_archive"]

_HEADER = "header"
# What NumPy, zipfile and json raise on a file that is cut off, overwritten or not an archive at all.
_DAMAGE = (
    OSError, ValueError, KeyError, TypeError, EOFError, AttributeError, RuntimeError, MemoryError,
    zipfile.BadZipFile, zlib.error, tokenize.TokenError,
)  # fmt: skip


class ArchiveError(NavmeshError):
    """An archive is missing, damaged, of another kind or of another version."""


def check_target(path: str | os.PathLike[str]) -> None:
    """Raises `ArchiveError` if no file can be written to ``path``, `NavmeshError` if it is an input of this
    command: to know before the work for it is done."""
    target = Path(path)
    if not target.parent.is_dir():
        raise ArchiveError(f"{target}: there is no folder {target.parent} to write into")
    if target.is_dir():
        raise ArchiveError(f"{target}: is a folder; name a file")
    if not os.access(target.parent, os.W_OK):
        raise ArchiveError(f"{target}: the folder {target.parent} may not be written to")
    refuse_input(target)


def write_archive(
    path: str | os.PathLike[str],
    kind: str,
    version: int,
    header: Mapping[str, Any],
    arrays: Mapping[str, np.ndarray],
) -> None:
    """Write ``arrays`` under ``header`` to ``path``; the file appears whole or not at all.

    ``header`` must be representable in JSON. ``kind`` and ``version`` are checked by `read_archive`.
    """
    if _HEADER in arrays:
        raise ArchiveError(f"an array may not be called {_HEADER!r}: that name is taken by the header")
    check_target(path)
    text = json.dumps({**header, "kind": kind, "version": version}, sort_keys=True)
    payload: dict[str, Any] = {_HEADER: np.frombuffer(text.encode(), dtype=np.uint8), **arrays}
    with whole_file(path) as temporary, temporary.open("wb") as file:
        np.savez_compressed(file, **payload)


def read_archive(
    path: str | os.PathLike[str], kind: str, version: int
) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Read what `write_archive` wrote: the header and the arrays by name.

    Raises `ArchiveError` when the file is missing, cut off, of another kind, or of another version.
    """
    target = Path(path)
    if not target.is_file():
        raise ArchiveError(f"{target}: no such file; expected a {kind} archive")
    try:
        with np.load(target, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
        header = json.loads(arrays.pop(_HEADER).tobytes().decode())
        found_kind, found_version = header["kind"], header["version"]
    except _DAMAGE as error:
        raise ArchiveError(f"{target}: not a whole {kind} archive (cut off or damaged): {error}") from error
    if found_kind != kind:
        raise ArchiveError(f"{target}: holds a {found_kind!r}, expected a {kind!r}")
    if found_version != version:
        raise ArchiveError(
            f"{target}: {kind} of version {found_version}, this release reads version {version}; make it anew"
        )
    return header, arrays
