"""Where compiled kernels are kept: in the user's cache folder, outside the packages, so that these may be
read-only and leave nothing behind when uninstalled."""

import os
import stat
import sys
import tempfile
import time
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

from numba.core import config

__all__ = [
    "LOCKS", "cache_folder", "clear", "forget_old", "note_use", "size_of_cache", "unwritten", "write_whole",
]  # fmt: skip

LOCKS = "locks"
"""Subfolder of the empty files that processes lock."""
_KEPT = 60 * 86400.0
"""[s] after which unused kernels are removed."""
_NOTED = 86400.0  # [s] between updates of a file's date of last use
_unwritten: set[Path] = set()


def cache_folder() -> Path | None:
    """The folder, created if needed: "surefoot" in ``NUMBA_CACHE_DIR`` if that is set, else in the user's
    cache folder; if that is not writable, a private folder in the temporary directory. None if there is
    none: then each process compiles its kernels.
    """
    return _folder(config.CACHE_DIR)  # type: ignore[attr-defined]


@lru_cache(maxsize=8)
def _folder(chosen: str) -> Path | None:
    return next((folder for folder in _candidates(chosen) if _is_ours(folder)), None)


def _candidates(chosen: str) -> list[Path]:
    if chosen:
        return [Path(chosen).absolute() / "surefoot"]
    user = os.getuid() if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
    return [_users_caches() / "surefoot", Path(tempfile.gettempdir()) / f"surefoot-{user}"]


def _users_caches() -> Path:
    """The platform's cache folder."""
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    chosen = Path(os.environ.get("XDG_CACHE_HOME", ""))
    return chosen if chosen.is_absolute() else Path.home() / ".cache"


def _is_ours(folder: Path) -> bool:
    """Whether ``folder`` is writable, and only for this user: its content is executed."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        kept = folder.stat()
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError:
        return False
    if not hasattr(os, "getuid"):
        return True
    return kept.st_uid == os.getuid() and not kept.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def write_whole(file: Path, data: bytes) -> None:
    """Write a file whole or not at all; a full or read-only disk is no reason to fail."""
    try:
        handle, name = tempfile.mkstemp(dir=file.parent, prefix=".", suffix=".part")
        try:
            with os.fdopen(handle, "wb") as part:
                part.write(data)
            os.replace(name, file)
        except OSError:
            os.unlink(name)
            raise
        _unwritten.discard(file)
    except OSError:
        _unwritten.add(file)


def unwritten() -> set[Path]:
    """Files that the present folder lacks because this process could not write them."""
    folder = cache_folder()
    return {file for file in _unwritten if file.parent == folder and not file.exists()}


def note_use(file: Path) -> bool:
    """Update the date of a file, to note that it is still used; returns whether it was not of today."""
    with suppress(OSError):
        if time.time() - file.stat().st_mtime > _NOTED:
            os.utime(file)
            return True
    return False


def forget_old() -> None:
    """Remove kernels unused for 60 days, as those of earlier versions."""
    for file in _kept():
        with suppress(OSError):
            if time.time() - file.stat().st_mtime > _KEPT:
                file.unlink()


def size_of_cache() -> int:
    """[bytes] Size of all cached kernels."""
    return sum(file.stat().st_size for file in _kept())


def clear() -> None:
    """Remove all cached kernels. Running processes are not affected."""
    for file in _kept():
        with suppress(OSError):
            file.unlink()


def _kept() -> list[Path]:
    folder = cache_folder()
    return [file for file in folder.rglob("*") if file.is_file()] if folder is not None else []
