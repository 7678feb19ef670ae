"""Compile all kernels in several processes, and load them."""

import os
from collections.abc import Callable

from runtime.warmup.sharing import run_shared
from surefoot.compile_notice import TIME
from surefoot.kernels.folder import forget_old, note_use, unwritten, write_whole
from surefoot.kernels.loading import load_kept
from surefoot.preparing import Preparing, mark_of_kernels
from surefoot.progress import Progress

__all__ = ["compile_kernels", "is_compiled", "load_kernels", "prepare"]

_KERNELS = 410
"""Approximate number of kernels."""


def is_compiled() -> bool:
    """Whether all kernels, in their present version, are cached on this machine. Notes that they are used: a
    game loads some only now and then."""
    mark = mark_of_kernels()
    if mark is None:
        return False
    try:
        names = mark.read_text(encoding="utf-8").splitlines()
        if not names or not set(names) <= set(os.listdir(mark.parent)):
            return False
    except (OSError, ValueError):  # none, damaged, or removed meanwhile
        return False
    if note_use(mark):
        for name in names:
            note_use(mark.parent / name)
    return True


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
        files = set[str]()
        if not is_compiled():
            files = run_shared(FIRST_USES, lambda count, what: told(min(count / _KERNELS, 0.99), what))
        import runtime.world.world  # noqa: F401  what a frame runs

        load_kept()
        mark = mark_of_kernels()
        if files and mark is not None and unwritten() <= {mark}:
            write_whole(mark, "\n".join(sorted(files)).encode())
            forget_old()
    finally:
        Preparing.going_on = False
    told(1.0, "all kernels")
