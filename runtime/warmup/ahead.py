"""Compile all kernels in several processes, and load them."""

import hashlib
import logging
import platform
import re
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import llvmlite
import numba
from llvmlite.binding import get_host_cpu_name

import surefoot
from runtime.warmup.sharing import run_shared
from surefoot.compiling import TIME
from surefoot.kernels.dependencies import PACKAGES
from surefoot.kernels.folder import cache_folder, forget_old
from surefoot.kernels.loading import load_kept
from surefoot.progress import Progress

__all__ = ["compile_kernels", "is_compiled", "load_kernels", "prepare", "prepare_once"]

_KERNELS = 410
"""Approximate number of kernels."""
_KERNEL = re.compile(rb"^@(?:allocating_)?kernel\b|\bcfunc\(", re.MULTILINE)
_log = logging.getLogger("surefoot")
_preparing = [False]


def is_compiled() -> bool:
    """Whether all kernels, in their present version, are cached on this machine."""
    mark = _mark()
    return mark is not None and mark.exists() and mark.read_text(encoding="ascii") == _sources()


def prepare(progress: Callable[[float, str], object] | None = None) -> None:
    """Compile, cache and load all kernels, so that nothing compiles later: 1 to 3 minutes on two cores the
    first time, a second or two afterwards. Call it when a program starts or an image is built.

    ``progress(share, what)`` is called as it advances, ``share`` from 0 to 1. It uses as many processes as
    there are cores, if Python can start any.
    """
    _compile(progress or (lambda share, what: None))


def prepare_once() -> None:
    """`prepare` if this version has never been prepared on this machine. Called by worlds, so that no step
    compiles."""
    mark = _mark()
    if not _preparing[0] and mark is not None and not mark.exists():
        _log.warning(
            "surefoot: compiling kernels, once on this machine: %s; runtime.prepare() does it ahead of time",
            TIME,
        )
        prepare()


def leave_it() -> None:
    """Mark this process as one that prepares: its worlds do not."""
    _preparing[0] = True


def compile_kernels(progress: Progress) -> None:
    """`prepare`, shown as a stage of ``progress``."""
    with progress.stage(f"compiling kernels, once: {TIME}") as stage:
        _compile(stage.update)


def load_kernels() -> None:
    """Step one body of each kind, so that the first step of an application takes no longer than others."""
    from runtime.warmup.first_uses import one_of_each

    one_of_each(0.1)


def _compile(told: Callable[[float, str], object]) -> None:
    from runtime.warmup.first_uses import FIRST_USES

    if _preparing[0]:
        return
    _preparing[0] = True
    try:
        if not is_compiled():
            run_shared(FIRST_USES, lambda count, what: told(min(count / _KERNELS, 0.99), what))
            mark = _mark()
            if mark is not None:
                mark.write_text(_sources(), encoding="ascii")
                forget_old()
        import runtime.world.world  # noqa: F401  what a frame runs

        load_kept()
    finally:
        _preparing[0] = False
    told(1.0, "all kernels")


def _mark() -> Path | None:
    """The file that records which sources are fully cached; None without a cache folder."""
    folder = cache_folder()
    versions = (surefoot.__version__, sys.implementation.cache_tag, numba.__version__, llvmlite.__version__)
    machine = f"{versions} {platform.system()} {get_host_cpu_name()}"
    name = f"all-{hashlib.sha256(machine.encode()).hexdigest()[:24]}"
    return None if folder is None else folder / name


@cache
def _sources() -> str:
    """Hex digest of all files with kernels."""
    root, checksum = Path(surefoot.__file__).parents[1], hashlib.sha256()
    for package in PACKAGES:
        for file in sorted((root / package).rglob("*.py")):
            content = file.read_bytes()
            if _KERNEL.search(content):
                checksum.update(f"{file.relative_to(root)} {len(content)}\0".encode())
                checksum.update(content)
    return checksum.hexdigest()
