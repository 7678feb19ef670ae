"""Compile all kernels in several processes, and load them."""

import hashlib
import os
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path

import surefoot
from runtime.warmup.sharing import run_shared
from surefoot.compile_notice import TIME
from surefoot.kernels.dependencies import PACKAGES
from surefoot.kernels.folder import forget_old, note_use, unwritten, write_whole
from surefoot.kernels.loading import load_kept
from surefoot.preparing import Preparing, mark_of_kernels
from surefoot.progress import Progress

__all__ = ["compile_kernels", "is_compiled", "is_kept", "load_kernels", "prepare"]

_KERNELS = 410
"""Approximate number of kernels."""
_KERNEL = re.compile(rb"^@(?:allocating_)?kernel\b|\bcfunc\(", re.MULTILINE)


def is_compiled() -> bool:
    """Whether all kernels, in their present version, are cached on this machine. Notes that they are used."""
    return _kept_sources() == _sources()


def is_kept() -> bool:
    """Whether all kernels were compiled once on this machine, perhaps from other sources of this version, and
    none of their files is gone. Notes that they are used: a game loads some only now and then."""
    return _kept_sources() is not None


def _kept_sources() -> str | None:
    """`_sources` of which all kernels are kept; None if they are not, or what says so cannot be read."""
    mark = mark_of_kernels()
    if mark is None:
        return None
    try:
        sources, *names = mark.read_text(encoding="utf-8").splitlines()
        if not names or not set(names) <= set(os.listdir(mark.parent)):
            return None
    except (OSError, ValueError):  # none, damaged, or removed meanwhile
        return None
    if note_use(mark):
        for name in names:
            note_use(mark.parent / name)
    return sources


def prepare(progress: Callable[[float, str], object] | None = None) -> None:
    """Compile, cache and load all kernels, so that nothing compiles later: 1 to 3 minutes on two cores the
    first time, a second or two afterwards. Call it when a program starts or an image is built.

    ``progress(share, what)`` is called as it advances, ``share`` from 0 to 1. It uses as many processes as
    there are cores, if Python can start any.
    """
    _compile(progress or (lambda share, what: None))


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

    if Preparing.going_on:
        return
    Preparing.going_on = True
    try:
        is_new = not is_compiled()
        if is_new:
            run_shared(FIRST_USES, lambda count, what: told(min(count / _KERNELS, 0.99), what))
        import runtime.world.world  # noqa: F401  what a frame runs

        files = load_kept()
        mark = mark_of_kernels()
        if is_new and mark is not None and unwritten() <= {mark}:
            names = sorted({file.name for file in files})
            write_whole(mark, "\n".join([_sources(), *names]).encode())
            forget_old()
    finally:
        Preparing.going_on = False
    told(1.0, "all kernels")


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
