"""Compiling all kernels before they are needed.

`runtime.warmup` compiles them, since only it imports everything that has kernels. Worlds, which it imports,
need them compiled. So it leaves its function here (`prepare_with`), and worlds call it (`prepare_once`).
"""

import hashlib
import logging
import platform
import sys
from collections.abc import Callable
from pathlib import Path

import surefoot

__all__ = ["Preparing", "mark_of_kernels", "prepare_once", "prepare_with"]

_log = logging.getLogger("surefoot")
_preparers: list[tuple[Callable[[], object], Callable[[], bool]]] = []


class Preparing:
    """``going_on``: whether this process is preparing, or helps one that is: what it makes then does not ask
    for it again."""

    going_on = False


def prepare_with(prepare: Callable[[], object], is_prepared: Callable[[], bool]) -> None:
    """Have ``prepare`` called by `prepare_once` unless ``is_prepared``."""
    _preparers[:] = [(prepare, is_prepared)]


def prepare_once() -> None:
    """Compile all kernels if they have not been compiled on this machine as they are now, or what was kept is
    gone. Called by worlds, so that no step of theirs compiles. Where they cannot be kept, as on a full disk,
    it does so once in a process."""
    if Preparing.going_on or not _preparers or mark_of_kernels() is None:
        return
    prepare, is_prepared = _preparers[0]
    if is_prepared():
        return
    from surefoot.compile_notice import TIME
    from surefoot.kernels.folder import unwritten

    if unwritten():
        return

    _log.warning(
        "surefoot: compiling kernels, once on this machine: %s; runtime.prepare() does it ahead of time", TIME
    )
    prepare()


def mark_of_kernels() -> Path | None:
    """The file that says in which files all kernels of the present sources are kept; None without a cache.

    Each version and checkout that shares the folder has one of its own.
    """
    # imported when first asked for: `surefoot --help` needs no compiler
    import llvmlite
    import numba
    from llvmlite.binding import get_host_cpu_name

    from surefoot.kernels.folder import cache_folder
    from surefoot.kernels.sources import digest_of_sources

    folder = cache_folder()
    if folder is None:
        return None
    versions = (surefoot.__version__, sys.implementation.cache_tag, numba.__version__, llvmlite.__version__)
    machine = f"{versions} {digest_of_sources()} {platform.system()} {get_host_cpu_name()}"
    return folder / f"kept-{hashlib.sha256(machine.encode()).hexdigest()[:24]}"
